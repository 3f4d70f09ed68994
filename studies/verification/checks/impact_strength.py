"""What hardening and strain rate make of an impact: finite elements beside the diagnosis.

The diagnosis takes both as a relative strength over depth, by the strains under the contact and
the rate 0.4 v/a. Here the same flow laws act in every point of the metal: a ball is pressed as deep
as its energy goes, with the clock of its speed, and unloaded. The rows of the proof's two
simulations stand beside them; they share nothing with the diagnosis, so this is where both meet a
third.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from .... import fem
from ....campaigns.case import Case
from ....core.arrays import Array
from ....core.flow import Flow, Rate, swift, voce
from ....core.material import Material, Pair
from ....dynamics import Approach, Scene, Striker, scene_of, strike
from ....dynamics.mechanisms import MECHANISMS, Surroundings
from ....dynamics.mechanisms.base import attached
from ....models import LAWS
from ...concealed import Metal as ProofMetal
from ...concealed import Striker as ProofStriker
from ...proof.generators.effects import Effect
from ...proof.generators.parameters import CAVITY, FOUNDATION
from ...proof.generators.rig import COLUMNS, NUISANCES, Rig
from ...proof.generators.simulate import results_of, rows_of
from ..bench import Bench
from ..result import Cell, Measurement, Result, Table

_BALL = Material(210e9, 0.3, 1e11, density=7800.0)
_FLAT = Material(70e9, 0.33, 300e6, density=2700.0)
_SPEEDS = (0.67, 1.7, 4.5)
_LARGE, _SMALL = 8e-3, 2e-3
_SLOWEST = 0.05  # of the approach speed: where the clock ends
_FORM = 15.0  # %, what the diagnosis takes a form to be off
_DEPTHS = 50
_SPENT, _PRESSES = 0.02, 4  # of the energy, within which a press is turned where the ball is
_POWER = 2.2  # of the depth, as which the work rises
_SEEN = ("restitution", "peak_force_N", "residual_flat_m")
_COLUMNS = ("restitution", "peak_force_N", "permanent_depth_m")
"""What is compared: of an impact of the tool, and of one of the proof."""


class Metal(NamedTuple):
    """A flow law: of the finite elements, of the proof, and the mechanism that stands for it."""

    name: str
    flow: Flow
    proof: Effect
    mechanism: str
    constants: Callable[[Array], dict[str, float]]
    start: tuple[float, ...]


def _rate_of(exponent: float) -> Callable[[Array], dict[str, float]]:
    """The law's exponent; the rise is fitted."""
    return lambda x: {"rise_at_1000_per_s": float(np.exp(x[0])), "rate_exponent": exponent}


def _hardening_of(x: Array) -> dict[str, float]:
    return {"hardening_ratio": float(np.exp(x[0])), "hardening_exponent": float(x[1])}


def _cowper_symonds(reference: float, q: float) -> Metal:
    rise = (1000.0 / reference) ** (1.0 / q)
    return Metal(
        f"Cowper-Symonds {reference:g} 1/s, {q:g}: {rise:.3f} at 1000 1/s",
        Flow(rate=Rate("cowper-symonds", reference, q)),
        Effect("strain-rate-hardening", "overstress-power", {"D": reference, "q": q}),
        "strain-rate-hardening", _rate_of(1.0 / q), (math.log(rise),),
    )  # fmt: skip


def _johnson_cook(c: float) -> Metal:
    decades = math.log(1000.0)  # a power that touches the logarithm at 1000 1/s
    return Metal(
        f"Johnson-Cook {c:g} from 1 1/s: {c * decades:.3f} at 1000 1/s",
        Flow(rate=Rate("johnson-cook", 1.0, c)),
        Effect("strain-rate-hardening", "overstress-logarithm", {"C": c, "reference": 1.0}),
        "strain-rate-hardening", _rate_of(1.0 / decades),
        (math.log(c * decades),),
    )  # fmt: skip


_RATES = (_cowper_symonds(6500.0, 4.0), _cowper_symonds(1108.0, 5.94), _johnson_cook(0.03))
_HARDENING = (
    Metal("Voce, Q/Sy 0.5, b 50", Flow(voce(Sy=_FLAT.Sy, Q=0.5 * _FLAT.Sy, b=50.0)),
          Effect("work-hardening", "voce", {"rise": 0.5, "strain": 0.02}),
          "work-hardening", _hardening_of, (0.0, 0.4)),
    Metal("Swift, n 0.15", Flow(swift(Sy=_FLAT.Sy, K=_FLAT.Sy / 0.004**0.15, n=0.15)),
          Effect("work-hardening", "swift", {"n": 0.15, "strain": 0.004}),
          "work-hardening", _hardening_of, (0.0, 0.4)),
)  # fmt: skip


class Compared(NamedTuple):
    """What the metals show: rows of the table, and what is measured of them.

    - `rows`: of the table.
    - `off`: mechanism to what its form leaves, over the rms of each effect, (n, 3) a metal.
    - `own`: the same with the law's own rise and nothing fitted, a rate.
    - `proof`: effect on the restitution in the proof's two simulations over that here.
    """

    rows: list[tuple[Cell, ...]]
    off: dict[str, list[Array]]
    own: list[Array]
    proof: list[float]


def run(bench: Bench) -> Result:
    """Press every metal, fit the diagnosis's form to it, and put the proof's beside both."""
    found = Compared([], {"work-hardening": [], "strain-rate-hardening": []}, [], [])
    for metal in (*_RATES, *_HARDENING):
        _compare(bench, metal, found)
    rows, off, own, proof = found
    return Result(
        title="What hardening and rate make of an impact",
        about=(
            "A steel ball of 8 and 2 mm on a metal of E 70 GPa and yield strength 300 MPa, level "
            "`quick`: pressed at the speeds of an impact to where its energy is spent, then "
            "unloaded. Change against the metal without rate and hardening, in restitution, peak "
            "force and dent."
        ),
        measurements=(
            Measurement("form of the strain rate, rms over its effect",
                        100.0 * _rms(off["strain-rate-hardening"]), "%", None, _FORM,
                        "what the diagnosis assumes"),
            Measurement("form of hardening, rms over its effect",
                        100.0 * _rms(off["work-hardening"]), "%", None, _FORM,
                        "what the diagnosis assumes"),
            Measurement("the strain rate with the law's own rise, nothing fitted",
                        100.0 * _rms(own), "%", None, _FORM, "what the diagnosis assumes"),
            Measurement("the proof's effect on the restitution over this one, least", min(proof),
                        "", 0.5, 2.0, "another law, the same physics"),
            Measurement("the same, largest", max(proof), "", 0.5, 2.0,
                        "another law, the same physics"),
        ),
        tables=(
            Table(
                "Change of restitution / peak force / dent, %",
                (
                    "metal", "ball", "finite elements", "diagnosis", "proof, cavity",
                    "proof, springs",
                ),
                tuple(rows),
            ),
        ),
        notes=(
            "The exponent of the rate is the law's own; the rise and the two numbers of hardening "
            "are fitted, once a metal.",
        ),
    )  # fmt: skip


def _compare(bench: Bench, metal: Metal, found: Compared) -> None:
    """Append what one metal shows."""
    sizes = (_LARGE, _SMALL) if metal in _RATES else (_LARGE,)
    blows = [(R, v) for R in sizes for v in _SPEEDS]
    solid = np.array([_change(bench, metal, R, v) for R, v in blows])
    fitted, form = _fitted(metal, blows, solid)
    found.off[metal.mechanism].append((form - solid) / _typical(solid))
    if metal in _RATES:
        own = metal.constants(np.array(metal.start))
        said = np.array([_tool_change(metal.mechanism, own, *b) for b in blows])
        found.own.append((said - solid) / _typical(solid))
    for (R, v), change, said in zip(blows, solid, form, strict=True):
        cavity, row = (_proof_change(metal.proof, R, v, f) for f in (CAVITY, FOUNDATION))
        found.proof.extend([cavity[0] / change[0], row[0] / change[0]])
        told = map(_percents, (change, said, cavity, row))
        found.rows.append((metal.name, f"{1e3 * R:g} mm, {v:g} m/s", *told))
    told_constants = ", ".join(f"{k} {v:.3g}" for k, v in fitted.items())
    found.rows.append((metal.name, "constants of the diagnosis", "", told_constants, "", ""))


def _change(bench: Bench, metal: Metal, R: float, speed: float) -> Array:
    """Logarithmic change of what is seen, by finite elements."""
    plain = _impact(bench, None, R, speed)
    return np.log(_impact(bench, metal, R, speed) / plain)


def _impact(bench: Bench, metal: Metal | None, R: float, speed: float) -> Array:
    """Restitution, peak force and dent of a ball, the press turned where its energy is spent."""
    flat = _FLAT.with_(flow=metal.flow) if metal else _FLAT
    pair, energy = Pair(_BALL, flat, R), 0.5 * _mass(R) * speed**2
    name = f"impact-{metal.name.split(':')[0] if metal else 'plain'}-{R:g}-{speed:g}"
    depth = strike(_scene(R, speed)).peak_depth_m / R
    for _ in range(_PRESSES):
        clocked = metal is not None and metal.flow.rate is not None
        problem = fem.ContactProblem(
            pair, fem.geometric_depths(1e-2 * depth, depth, _DEPTHS), unload_from=(depth,),
            speeds=clock(depth, speed) if clocked else (),
        )  # fmt: skip
        solved = bench.solve(Case(name, problem, fem.Accuracy.quick()))
        delta, force = (np.append(0.0, solved[k]) for k in ("delta", "force"))
        spent = float(np.trapezoid(force, delta))
        if abs(spent / energy - 1.0) < _SPENT:
            break
        depth *= (energy / spent) ** (1.0 / _POWER)
    turned = solved.unloadings[0]
    back = -float(np.trapezoid(turned.curve["force"], turned.curve["delta"]))
    return np.array([math.sqrt(back / spent), float(np.max(force)), turned.residual_flat])


def clock(depth: float, speed: float) -> tuple[tuple[float, float], ...]:
    """Speed by depth of a ball that slows down as a spring's load does."""
    x = np.linspace(0.0, 1.0, 12)
    slowing = np.sqrt(np.maximum(1.0 - x**2, _SLOWEST**2))
    return tuple((float(a * depth), float(speed * b)) for a, b in zip(x, slowing, strict=True))


def _fitted(
    metal: Metal, blows: Sequence[tuple[float, float]], solid: Array
) -> tuple[dict[str, float], Array]:
    """Constants of the mechanism nearest to the finite elements, and its changes (n, 3)."""
    scale = _typical(solid)

    def changes(x: Array) -> Array:
        return np.array([_tool_change(metal.mechanism, metal.constants(x), *b) for b in blows])

    def miss(x: Array) -> Array:
        return np.asarray(((changes(x) - solid) / scale).ravel())

    found = least_squares(miss, metal.start, diff_step=0.02)
    return metal.constants(found.x), changes(found.x)


def _tool_change(name: str, constants: dict[str, float], R: float, speed: float) -> Array:
    mechanism = next(m for m in MECHANISMS if m.name == name)
    plain = _scene(R, speed)
    there = attached((mechanism,), plain, {name: constants}, Surroundings())
    one, other = ([getattr(strike(s), k) for k in _SEEN] for s in (there, plain))
    return np.asarray(np.log(np.array(one) / np.array(other)))


def _proof_change(effect: Effect, R: float, speed: float, family: float) -> Array:
    steel, soft = (
        ProofMetal(name, m.E, m.nu, m.Sy, float(m.density))
        for name, m in (("ball", _BALL), ("flat", _FLAT))
    )
    one = np.ones(1)
    rig = Rig(
        "balls-normal", soft, (ProofStriker("ball", steel, R, R),), np.zeros(1, dtype=np.intp),
        0.5 * math.pi * one, speed * one, 0.0 * one, 293.0 * one, 0.0,
        dict.fromkeys(NUISANCES, 0.0), {},
    )  # fmt: skip
    there, plain = (
        results_of(rows_of(rig, effects, family=family, z={}, steps=4000))[0]
        for effects in ((effect,), ())
    )
    places = [COLUMNS[name] for name in _COLUMNS]
    return np.asarray(np.log(there[places] / plain[places]))


def _scene(R: float, speed: float) -> Scene:
    striker = Striker(mass=_mass(R), tip_radius=R)
    return scene_of(
        LAWS["fitted"], sphere=_BALL, flat=_FLAT, striker=striker, approach=Approach(speed)
    )


def _mass(R: float) -> float:
    return float(_BALL.density) * 4.0 / 3.0 * math.pi * R**3


def _typical(change: Array) -> Array:
    """Rms of each column: a form's error is a share of its effect."""
    return np.asarray(np.sqrt(np.mean(change**2, axis=0)))


def _rms(parts: Sequence[Array]) -> float:
    return float(np.sqrt(np.mean(np.concatenate([p.ravel() for p in parts]) ** 2)))


def _percents(change: Array) -> str:
    return " / ".join(f"{100.0 * math.expm1(x):+.1f}" for x in change)
