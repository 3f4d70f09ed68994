"""What the metal's rate and hardening would do to a blow whose file says nothing of them.

The constants are those of the metal that a body names, else of others of its kind, else the least
and the most of the kind in the materials table that comes nearest in modulus and strength.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple

from ...core.errors import InputError
from ...core.inputs.materials import Entry, materials
from ...core.rig import BodyTable, value_of
from ...models.choose import follows_flow, past_curves, strains_under
from ...models.hardening import REPRESENTATIVE
from ..mechanisms.around import weaker_table
from ..mechanisms.strength.flow_stress import RATE
from ..mechanisms.strength.strain_rate_hardening import REFERENCE_RATE
from ..result import Impact
from ..scene import Scene
from .band import last_blow
from .effect import effect
from .onset import first_yield_speed

if TYPE_CHECKING:
    from ..files.setup import Setup


class Lack(NamedTuple):
    """What a file does not say, by how it would change the blow."""

    whose: str  # metal whose constants stand for the file's, or what would be
    ends: tuple[Impact, ...]  # the blow with the least and the most of it
    state: str  # what a file says of it

    def moved(self, name: str, found: Impact) -> tuple[float, float]:
        """Return how far one number goes up and down, 0 where it does not."""
        by = [float(getattr(end, name)) - float(getattr(found, name)) for end in self.ends]
        return max(0.0, *by), max(0.0, *(-x for x in by))

    def told(self, found: Impact) -> str:
        """Say the change, and what to state in its place."""
        changes = " to ".join(effect(end, found) for end in self.ends)
        return f"{self.whose}: {changes}; state {self.state}"


def lacking(setup: Setup, scene: Scene, found: Impact) -> dict[str, Lack]:
    """Return what rate and hardening would change of a blow whose file says nothing of them."""
    radius = float(scene.law.contact_radius(scene.pair, found.peak_depth_m))
    if not (scene.approach.speed > first_yield_speed(scene) and radius > 0.0):
        return {}
    body = setup.file.bodies[weaker_table(setup.file, setup.file.striker)]
    said = setup.content.get("mechanisms", {})
    follows = follows_flow(scene.law) and not scene.pair.perfectly_plastic
    wanted = {
        "rate": ("strain-rate-hardening", "mechanisms.strain-rate-hardening (false: none)"),
        **({} if follows else {"hardening": ("work-hardening", "a flow curve or hardening")}),
    }
    lacks, named = dict[str, Lack](), materials().get(body.material)
    for what, (mechanism, state) in wanted.items():
        if mechanism in said:
            continue
        # by the metal's own constants, or the least and the most of its class
        own = named is not None and what in named.laws
        chosen = [named] if named is not None and own else _class_of(body, what)
        if not chosen:
            continue
        S, strain = None if own else value_of(body.strength), REPRESENTATIVE * radius / scene.pair.R
        numbers = (_numbers(e, what, S, strain) for e in chosen)
        sizes = sorted(numbers, key=lambda one: next(iter(one.values())))
        ends = [sizes[0]] if sizes[0] == sizes[-1] else [sizes[0], sizes[-1]]
        try:
            with_it = [setup.with_mechanism(mechanism, one) for one in ends]
            blows = tuple(last_blow(one, scene.law) for one in with_it)
        except InputError:  # the table of one pair knows no stronger one
            continue
        kind = chosen[0].kind
        same = named is not None and named.kind == kind
        others = "others of its kind" if same else "the nearest in the table"
        whose = body.material if own else f"{others} ({kind}, {len(sizes)})"
        lacks[what] = Lack(f"with that of {whose}", blows, state)
    return lacks


def flow_checks(
    setup: Setup, scene: Scene, found: Impact, lacks: Mapping[str, Lack]
) -> Iterator[str]:
    """Yield the strain rate, and what rate and hardening would change where none is stated."""
    radius = float(scene.law.contact_radius(scene.pair, found.peak_depth_m))
    yields = found.residual_m > 0.0 and scene.approach.speed > first_yield_speed(scene)
    if not (yields and radius > 0.0):
        return
    if follows_flow(scene.law):
        left = found.residual_sphere_m, found.residual_flat_m
        yield from past_curves(scene.pair, strains_under(scene.pair, radius, left))
    rate = f"strain rate about {RATE * scene.approach.speed / radius:.2g} 1/s"
    if "strain-rate-hardening" in setup.content.get("mechanisms", {}):
        yield rate
    else:
        told = f"; {lacks['rate'].told(found)}" if "rate" in lacks else ""
        yield (
            f"{rate}: a strength measured slowly lacks what the metal's rate adds up to there{told}"
        )
    if "hardening" in lacks:
        yield f"no hardening is stated; {lacks['hardening'].told(found)}"


def _class_of(body: BodyTable, what: str) -> list[Entry]:
    """Entries of the body's kind, else that nearest in modulus and strength; none but metals."""
    E, S = value_of(body.E_Pa), value_of(body.strength)
    known = [e for e in materials().values() if what in e.laws and "Sy_Pa" in e.numbers]
    named = materials().get(body.material)
    alike = [e for e in known if named is not None and e.kind == named.kind]
    if alike:
        return alike
    moduli = [e.numbers["E_Pa"]["value"] for e in known]
    if not min(moduli) <= E <= max(moduli):
        return []

    def apart(e: Entry) -> float:
        numbers = e.numbers["E_Pa"]["value"] / E, e.numbers["Sy_Pa"]["value"] / S
        return math.hypot(*map(math.log, numbers))

    nearest = min(known, key=apart)
    return [e for e in known if e.kind == nearest.kind]


def _numbers(entry: Entry, what: str, strength: float | None, strain: float) -> Mapping[str, float]:
    """An entry's constants as those of the mechanism, of another strength if one is given.

    A stronger state of a metal stands further along its curve, as cold work has left it: what the
    curve rises from there over the strain of the dent is what the ratio gives.
    """
    law = entry.laws[what]
    if what == "hardening":
        S, n = entry.numbers["Sy_Pa"]["value"], law["n"]
        before = max((strength or S) - S, 0.0) / law["B_Pa"]
        rise = ((before ** (1.0 / n) + strain) ** n - before) / strain**n
        return {"hardening_ratio": rise * law["B_Pa"] / (strength or S), "hardening_exponent": n}
    if law["law"] == "cowper-symonds":
        n = 1.0 / law["q"]
        return {"rise_at_1000_per_s": (REFERENCE_RATE / law["D_1_s"]) ** n, "rate_exponent": n}
    # a logarithm has at this rate the slope of a power of 1/ln(r/r_0)
    turns = math.log(REFERENCE_RATE / law["rate_0_1_s"])
    return {"rise_at_1000_per_s": law["C"] * turns, "rate_exponent": 1.0 / turns}
