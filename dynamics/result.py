"""What an impact ends in: observables, balances, and how the computation ended."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from ..core.arrays import Array
from ..core.errors import COMPLETED, Ending, Outcome
from .stepping import layout as at
from .stepping.layout import (
    CONTACT_BUDGET,
    COUNTS,
    DONE,
    FLIGHT_BUDGET,
    OBSERVABLES,
    RESTS,
    STEP_BUDGET,
)
from .surface import Spot

_OF_A_PARTING = (
    at.O_KINETIC, at.O_ENERGETIC, at.O_TANGENTIAL, at.O_TIME, at.O_TOUCHING, at.O_PN, at.O_PT,
    at.O_RATIO, at.O_CLEAR, at.O_LEAVING,
)  # fmt: skip

_ENDINGS = {
    DONE: COMPLETED,
    STEP_BUDGET: Outcome(
        Ending.STEP_LIMIT,
        "the impact did not end within the step budget.",
        "Raise max_steps of [impact].",
    ),
    CONTACT_BUDGET: Outcome(
        Ending.STEP_LIMIT,
        "the tip was still re-contacting after the allowed number of contacts.",
        "Raise max_contacts or lower flight_s of [impact].",
    ),
    FLIGHT_BUDGET: Outcome(
        Ending.STEP_LIMIT,
        "the tip was still hovering near the flat after the allowed number of looks at it.",
        "Lower flight_s: how long a tip is followed after it parts.",
    ),
}
_NOT_FINITE = Outcome(
    Ending.NOT_CONVERGED,
    "the step size fell to nothing.",
    "Check the inputs; the law may jump or be undefined at this depth.",
)


@dataclass(frozen=True, slots=True)
class Impact:
    """Observables of one impact; SI units, named in each field.

    Depths are positive. `restitution` is kinematic: rebound over approach normal velocity of the
    contact point, of the rigid-body motion. `kinetic_restitution` is P_r / P_c,
    `energetic_restitution` sqrt(W_r / W_c), `tangential_restitution` the ratio of tangential
    velocities (nan without any at touch). `sliding_length_m` follows the material point that
    touches (Eq. 5.9), `scar_travel_m` the place of contact on the flat; both are largest minus
    smallest while in contact. `scar_length_m` and `scar_width_m` (at the deepest place) are those
    of what all touches left, as the scene's instrument ends them; `scar_excess_m` is their
    difference, the thesis's L_s (5.2). `contact_time_s` runs from first touch to last separation,
    `touching_time_s` leaves out the flights between. `clearance_m` and `clearance_rate_m_s` say
    how far above the remembered surface the tip is at its last separation, and how fast it leaves.
    `stuck` says whether friction held the tip for some time. A tip whose weight
    or whose plate does not let it part rests: its restitution is 0, and what a parting would end is
    nan. An impact that did not end has no numbers: all are nan.

    The energy: `kinetic_before_J` and `gravity_work_J` come in; `kinetic_after_J`,
    `modal_stored_J` and `support_stored_J` are still there; lost are `plastic_work_J`,
    `damping_work_J` and `radiated_J` (together `contact_work_J`, all that the contact kept: it
    stores nothing once it has parted), `friction_work_J`, `structural_loss_J` (with the ringing
    `modal_energy_J`) and `support_loss_J` (with what is stored `support_energy_J`).
    `energy_residual` is what is left over, over the kinetic energy of the approach;
    `momentum_residual` the unbalanced momentum over m v, `angular_residual` the unbalanced angular
    momentum over m v and the radius of gyration.
    """

    restitution: float
    kinetic_restitution: float
    energetic_restitution: float
    tangential_restitution: float
    residual_sphere_m: float
    residual_flat_m: float
    peak_depth_m: float
    contact_time_s: float
    touching_time_s: float
    loading_time_s: float
    peak_force_N: float
    rebound_spin_rad_s: float
    sliding_length_m: float
    scar_travel_m: float
    scar_length_m: float
    scar_width_m: float
    scar_excess_m: float
    friction_impulse_ratio: float
    normal_impulse_Ns: float
    tangential_impulse_Ns: float
    contact_work_J: float
    friction_work_J: float
    modal_energy_J: float
    support_energy_J: float
    rebound_speed_m_s: float
    tangential_rebound_m_s: float
    energy_residual: float
    momentum_residual: float
    tip_rebound_m_s: float
    kinetic_before_J: float
    kinetic_after_J: float
    gravity_work_J: float
    plastic_work_J: float
    damping_work_J: float
    radiated_J: float
    modal_stored_J: float
    structural_loss_J: float
    support_stored_J: float
    support_loss_J: float
    angular_residual: float
    clearance_m: float
    clearance_rate_m_s: float
    contacts: int
    stuck: bool
    spot: Spot
    outcome: Outcome

    @property
    def residual_m(self) -> float:
        """Residual depth of both bodies together [m]."""
        return self.residual_sphere_m + self.residual_flat_m

    @property
    def mean_force_N(self) -> float:
        """Normal impulse over the time in contact [N]; nan before the first parting."""
        if self.touching_time_s == 0.0:
            return math.nan
        return self.normal_impulse_Ns / self.touching_time_s

    @property
    def return_time_s(self) -> float:
        """Time until the tip is back at the undisturbed surface: contact + residual / rebound [s].

        The instant that the thesis's simulated durations belong to (Tables 5.2-5.4).
        """
        return self.contact_time_s + self.residual_m / self.tip_rebound_m_s

    @property
    def observables(self) -> dict[str, float]:
        """All numeric observables by name."""
        return {name: float(getattr(self, name)) for name in OBSERVABLES}


def leave_resting(rows: Array) -> None:
    """End the impacts whose tip rests, held by its weight or on an endless plate that sinks.

    `rows` (n, N_OUT) of the compiled integrator are changed in place.
    """
    rests = rows[:, at.FIRST_COUNT] == RESTS
    for column in _OF_A_PARTING:
        rows[rests, column] = math.nan
    for column in (at.O_E, at.O_VY, at.O_TIP):
        rows[rests, column] = 0.0
    rows[rests, at.FIRST_COUNT] = DONE


def impact_of(row: Array, spot: Array) -> Impact:
    """Return the `Impact` of one output row and spot of the compiled integrator."""
    values = dict(zip(OBSERVABLES + COUNTS, (float(x) for x in row), strict=True))
    ending = values.pop("ending")
    outcome = _NOT_FINITE if math.isnan(ending) else _ENDINGS.get(int(ending), _NOT_FINITE)
    kept = {f.name for f in fields(Impact)} & set(OBSERVABLES)
    return Impact(
        **{name: values[name] if outcome.completed else math.nan for name in kept},
        contacts=int(values["contacts"]),
        stuck=values["stuck"] > 0.0,
        spot=Spot.of(spot),
        outcome=outcome,
    )
