"""A sweep ends, whatever bodies, support and angle; all: tools/benchmarks/bench_sweeps.py."""

import itertools
import math
from typing import Any

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.dynamics import strike, tabulated
from dentscope.dynamics.files.setup import DEFAULT_LAWS
from dentscope.dynamics.tabulated.cells import MOST_CELLS, cells_of
from dentscope.dynamics.tabulated.energy_route import NAMES, energy_impacts
from dentscope.dynamics.tabulated.energy_table import energy_table
from dentscope.models import LAWS
from made_blows import ball_setup

_STEEL = {"E_Pa": 2.0e11, "nu": 0.3, "density_kg_m3": 7800.0}
_RIGID = {"rigid": True, "density_kg_m3": 7800.0}


def _of(strength: float, nu: float = 0.3) -> dict[str, Any]:
    return {**_STEEL, "nu": nu, "Sy_Pa": strength}


BODIES = {
    "weaker ball": (_of(1.0e9, 0.32), _of(5.0e9)),
    "weaker flat": (_of(5.0e9), _of(1.0e9)),
    "equal": (_of(1.0e9), _of(1.0e9)),
    "near-equal": (_of(1.0e9), _of(1.05e9)),
    "rigid flat": (_of(1.0e9, 0.32), _RIGID),
    "rigid ball": (_RIGID, _of(1.0e9)),
    "elastic": (_STEEL, _STEEL),
}
SUPPORTS = ("rigid", "plate", "half-space", "sprung")
ANGLES = (90.0, 45.0)
SPEEDS = (1.0, 2.0, 600.0)
"""The last one presses metals in so far that no published law is meant for it."""

CASES = [
    case for case in itertools.product(BODIES, SUPPORTS, ANGLES)
    # what does not deform carries no waves
    if case[0] != "rigid flat" or case[1] not in ("plate", "half-space")
]  # fmt: skip


def setup_for(bodies: str, support: str, angle: float, laws: tuple[str, ...] = DEFAULT_LAWS) -> Any:
    ball, flat = BODIES[bodies]
    more = {
        "plate": {"thickness_m": 0.02},
        "sprung": {"support_mass_kg": 0.5, "support_stiffness_N_m": 1e6},
    }.get(support, {})
    rubs = {"friction": {"coefficient": 0.1}} if angle < 90.0 else {}
    return ball_setup(
        target={**flat, **more}, ball=ball, radius=0.01, gravity_m_s2=9.81, **rubs,
        impact={"support": support, "angle_deg": angle, "laws": list(laws)},
        sweep={"impact_speed_m_s": list(SPEEDS)},
    )  # fmt: skip


# every second combination, so that each body, support and angle is among them
@pytest.mark.parametrize(("bodies", "support", "angle"), CASES[::2] + CASES[1::6])
def test_a_sweep_ends(bodies: str, support: str, angle: float) -> None:
    setup = setup_for(bodies, support, angle)
    for name in setup.laws:
        found = setup.swept(LAWS[name])
        completed = found["outcome"] == "completed"
        assert completed[:2].all()
        for column in ("restitution", "peak_force_N", "contact_time_s"):
            assert np.isfinite(found[column][completed]).all()
        single = strike(setup.scene(LAWS[name]), setup.settings)
        assert found["restitution"][0] == pytest.approx(single.restitution, abs=2e-5)


_SOFT = _of(3e8)
SWEEPS: dict[str, tuple[dict[str, Any], dict[str, Any], dict[str, Any], dict[str, Any]]] = {
    "heights": (
        _SOFT, _of(5e9), {"drop_height_m": 0.1}, {"drop_height_m": [1e-3, 0.1, 150.0]},
    ),
    "masses": (_SOFT, _of(5e9), {}, {"mass_kg": [1e-9, 1e-3, 10.0]}),
    "grazing": (_SOFT, _of(5e9), {"angle_deg": 5.0}, {"angle_deg": [0.1, 5.0, 89.9]}),
    "friction": (_SOFT, _of(5e9), {"angle_deg": 30.0}, {"friction": [0.0, 0.3, 10.0]}),
    "repeats": (_SOFT, _of(5e9), {"repeats": 5}, {"impact_speed_m_s": [0.01, 1.0]}),
    "a hardness": (
        _SOFT, {**_STEEL, "hardness_Pa": 6e9}, {},
        {"impact_speed_m_s": {"from": 1e-4, "to": 100.0, "count": 20, "spacing": "log"}},
    ),
    "a ball that hardens": (
        {**_SOFT, "hardening": {"law": "ludwik", "K_Pa": 5e8, "n": 0.4}}, _STEEL,
        {"laws": ["hardening", *DEFAULT_LAWS]}, {"impact_speed_m_s": [0.01, 1.0, 30.0]},
    ),
    "rubber": (
        {**_SOFT, "E_Pa": 1e6, "nu": 0.499, "Sy_Pa": 1e5, "density_kg_m3": 1000.0}, _of(5e9), {},
        {"impact_speed_m_s": [0.01, 1.0, 10.0]},
    ),
    "a tip with a flat": (
        {**_SOFT, "tip_flat_radius_m": 5e-4}, _of(5e9), {},
        {"impact_speed_m_s": [0.01, 1.0, 30.0]},
    ),
    "a second ball": (
        _SOFT, {**_of(5e9), "shape": "sphere", "radius_m": 1e-3}, {},
        {"impact_speed_m_s": [0.01, 1.0, 3.0]},
    ),
}  # fmt: skip


@pytest.mark.parametrize(("ball", "flat", "blow", "swept"), SWEEPS.values(), ids=SWEEPS)
def test_a_sweep_of_anything_ends(ball, flat, blow, swept):
    falls = "drop_height_m" in blow
    setup = ball_setup(
        target=flat, ball=ball, speed=0.0 if falls else 1.0, gravity_m_s2=9.81 if falls else 0.0,
        friction={"coefficient": 0.1}, impact={"laws": list(DEFAULT_LAWS), **blow}, sweep=swept,
    )  # fmt: skip
    for name in setup.laws:
        found = setup.swept(LAWS[name])
        assert (found["outcome"] == "completed").all()
        e = found["restitution"]
        assert np.isfinite(e).all()
        upright = found["angle_deg"] == 90.0
        assert (e[upright] <= 1.0 + 1e-4).all()
        assert (e > 0.0).all()
        assert (found["kinetic_after_J"] <= found["kinetic_before_J"] * (1.0 + 1e-4)).all()


def test_a_ball_softer_than_a_rigid_flat_by_ghaednia() -> None:
    # single impacts, integrated in steps
    found = setup_for("rigid flat", "rigid", 90.0).swept(LAWS["ghaednia"])
    assert found["restitution"][:2] == pytest.approx([0.4903, 0.4578], abs=1e-4)
    assert list(found["route"]) == ["work", "work", "steps"]


def test_a_law_that_jumps_is_tabled_up_to_there() -> None:
    law, scene = LAWS["ghaednia"], setup_for("rigid flat", "rigid", 90.0).scene(LAWS["ghaednia"])
    table = energy_table(law, scene.pair)
    assert not table.outcome.completed
    assert table.count < MOST_CELLS
    assert (~np.isfinite(table.vector)).sum() == 1  # behind the last cell
    answered = np.isfinite(
        energy_impacts(
            law, scene.pair, np.full(3, scene.striker.mass), np.array(SPEEDS), gravity=9.81
        )[:, NAMES.index("restitution")]
    )
    assert answered.tolist() == [True, True, False]
    with pytest.raises(InputError, match="ghaednia cannot be tabulated: the table ends at"):
        tabulated(law).table(scene.pair)


@pytest.mark.parametrize(
    ("rest", "end"),
    [
        (lambda x: np.sin(1e9 * x), 0.5),  # finer than any cell
        (lambda x: np.full_like(x, np.nan), 0.5),
        (lambda x: np.random.default_rng(1).normal(size=x.shape), 0.5),
        (lambda x: 1.0 / (0.75 - x), 0.75),
    ],
)
def test_cells_end_before_what_they_cannot_hold(rest: Any, end: float) -> None:
    asked = 0

    def function(x: Any) -> Any:
        nonlocal asked
        asked += len(x)
        return np.where(x < 0.5, x**2, rest(x))[:, None]

    table = cells_of(function, 0.0, 1.0, tolerance=1e-9)
    assert table.high == pytest.approx(end, abs=0.05)
    assert not table.outcome.completed
    assert table.outcome.advice
    assert asked < 14 * (MOST_CELLS + 256)
    assert (~np.isfinite(table.vector)).sum() == 1  # behind the last cell


def test_nothing_is_tabled_of_a_function_that_is_no_number() -> None:
    table = cells_of(lambda x: np.full((len(x), 2), math.nan), 0.0, 1.0, tolerance=1e-9)
    assert (table.count, table.high) == (0, 0.0)
    assert not table.outcome.completed


def test_a_dent_wider_than_any_scan_ends() -> None:
    # 23 g behind a tip of 16 nm at 5 km/s: the law's contact radius outgrows every number
    flat = {"E_Pa": 1472.1941916177072, "nu": 8.559266787331163e-7,
            "hardness_Pa": 2099.288698399014}  # fmt: skip
    ball = {"tip_flat_radius_m": 1.767634043089143e-14, "mass_kg": 0.022639303675060042,
            "E_Pa": 19920.697094265295, "nu": 4.1039944612038056e-7, "Sy_Pa": 1000.0}  # fmt: skip
    setup = ball_setup(target=flat, ball=ball, radius=1.5984525113821708e-8, law="ghaednia",
                       speed=5433.689379843022, gravity_m_s2=9.81)  # fmt: skip
    found = strike(setup.scene(LAWS["ghaednia"]), setup.settings)
    assert found.peak_depth_m > 1.0
