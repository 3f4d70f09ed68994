"""What may be missing: each effect drawn with its constitutive form, and put into the impacts.

An effect is a name, a form and numbers; `put` writes it into the rows of a bench. The names of
`EFFECTS` are those of the verdict; `OUTSIDE` holds what no name covers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ....core.arrays import Array, Indices
from . import flow
from . import parameters as at
from .rig import Rig

Numbers = dict[str, float]


@dataclass(frozen=True)
class Effect:
    """One effect: name, form and numbers (SI); `textbook` if the form is the usual one."""

    name: str
    form: str
    numbers: Numbers
    textbook: bool = False


Draw = Callable[[np.random.Generator, Rig, float], Effect]
Put = Callable[[Array, Rig, Effect], None]


@dataclass(frozen=True)
class Kind:
    """How an effect is drawn and put, and the benches that can show it."""

    benches: tuple[str, ...]
    draw: Draw
    put: Put


def _log(rng: np.random.Generator, low: float, high: float) -> float:
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))


def _pick(rng: np.random.Generator, first: str, second: str, textbook: str) -> tuple[str, bool]:
    """Form of the effect; the textbook one, if there is one, in four of ten truths."""
    if textbook and rng.random() < 0.4:
        return textbook, True
    return (first if rng.random() < 0.5 else second), False


Number = float | tuple[float, float] | Callable[[np.random.Generator, Rig], float]
"""A number as it is, log-uniform between two, or drawn in a way of its own."""


def _even(low: float, high: float) -> Number:
    return lambda rng, rig: float(rng.uniform(low, high))


def _in_tips(low: float, high: float) -> Number:
    """Log-uniform, in radii of the middle striker's tip."""
    return lambda rng, rig: (
        float(np.median([s.tip_radius for s in rig.strikers])) * _log(rng, low, high)
    )


def _drawn(
    name: str, forms: str | tuple[str, str, str], numbers: Mapping[str, Mapping[str, Number]]
) -> Draw:
    """Return a draw of the form, or of one of `_pick`'s three, and of its numbers.

    `numbers`: by form; those of all others under an empty name.
    """

    def draw(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
        form, known = (forms, False) if isinstance(forms, str) else _pick(rng, *forms)
        found = {}
        for key, told in numbers.get(form, numbers.get("", {})).items():
            value = _log(rng, *told) if isinstance(told, tuple) else told
            found[key] = value(rng, rig) if callable(value) else value
        return Effect(name, form, found, known)

    return draw


Places = Mapping[int, float | str]


def _placed(places: Places, forms: Mapping[str, Places] | None = None) -> Put:
    """Return what writes into places of the rows: a number as it is, or the effect's by its key.

    `forms`: further places by form.
    """

    def put(p: Array, rig: Rig, effect: Effect) -> None:
        for place, told in {**places, **(forms or {}).get(effect.form, {})}.items():
            p[:, place] = effect.numbers[told] if isinstance(told, str) else told

    return put


# --- flow stress ------------------------------------------------------------------------------


def _rate(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    form, known = _pick(rng, "overstress-logarithm", "zerilli-armstrong", "overstress-power")
    if form == "overstress-logarithm":
        numbers = {"C": _log(rng, 0.008, 0.06), "reference": 1.0}
    elif form == "zerilli-armstrong":
        numbers = {"A": _log(rng, 0.06, 0.5), "m": float(rng.uniform(0.05, 0.08))}
    else:
        q = float(rng.uniform(3.5, 6.0))
        numbers = {"D": 300.0 / _log(rng, 0.10, 0.9) ** q, "q": q}
    return Effect("strain-rate-hardening", form, numbers, known)


def _put_thermal(p: Array, rig: Rig, effect: Effect) -> None:
    rise = rig.temperature - 293.0
    if effect.form == "exponential":
        p[:, at.STRENGTH] *= np.exp(-rise / effect.numbers["T_scale"])
    else:
        melt = rig.target.melting - 293.0
        p[:, at.STRENGTH] *= 1.0 - (np.maximum(rise, 0.0) / melt) ** effect.numbers["m"]


def _put_size(p: Array, rig: Rig, effect: Effect) -> None:
    ratio = effect.numbers["length"] / p[:, at.TIP]
    p[:, at.STRENGTH] *= np.sqrt(1.0 + ratio) if effect.form == "swadener" else 1.0 + ratio**0.8


# --- waves, rod, support ----------------------------------------------------------------------


def _waves(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    if rig.law == "elastic":
        return Effect("half-space-waves", "cone", {"scale": _log(rng, 0.7, 1.5)})
    return Effect("half-space-waves", "thin-plate", {"thickness": rig.told["thickness_m"]}, True)


def _put_waves(p: Array, rig: Rig, effect: Effect) -> None:
    E, nu, rho = rig.target.E, rig.target.nu, rig.target.density
    if effect.form == "cone":
        # dashpot 3.4 r^2 sqrt(rho G)/(1 - nu) beside the stiffness 4 G r/(1 - nu) of a rigid disc
        # (Lysmer and Richart 1966); r cancels
        G = E / (2.0 * (1.0 + nu))
        kappa = 3.4 * math.sqrt(rho * G) * (1.0 - nu) / (16.0 * G * G)
        p[:, at.RADIATION] = effect.numbers["scale"] * kappa
        return
    h = effect.numbers["thickness"]
    bending = E * h**3 / (12.0 * (1.0 - nu * nu))
    p[:, at.PLATE] = 1.0 / (8.0 * math.sqrt(rho * h * bending))


def _beam(p: Array, rig: Rig, effect: Effect) -> None:
    for i, number in enumerate(rig.which):
        body = rig.strikers[number]
        if body.length == 0.0:
            continue
        E, nu, r = body.metal.E, body.metal.nu, body.radius
        area, second = math.pi * r * r, 0.25 * math.pi * r**4
        period = 2.0 * body.length / math.sqrt(E / body.metal.density)
        row = p[i]
        row[at.BEAM] = effect.numbers["elements"]
        row[at.BEAM_EA], row[at.BEAM_EI] = E * area, E * second
        row[at.BEAM_GA] = E / (2.0 * (1.0 + nu)) * area * 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu)
        row[at.BEAM_ROTARY] = p[i, at.MASS] / area / body.length * second
        row[at.BEAM_LOSS] = effect.numbers["loss_time"]
        row[at.FOLLOW] = 3.0 * period if effect.name == "rod-longitudinal-waves" else 2e-3


_BLOCK = 0.1  # [kg]


def _support(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    # a flat of which no thickness is told is a block at least
    mass = max(max(s.mass for s in rig.strikers) * _log(rng, 4.0, 60.0), _BLOCK)
    period = 2e-4 * _log(rng, 0.5, 6.0)
    stiffness = mass * (2.0 * math.pi / period) ** 2
    loss = 2.0 * _log(rng, 0.01, 0.3) * math.sqrt(stiffness * mass)
    numbers = {"mass": mass, "stiffness": stiffness, "damping": loss}
    if rng.random() < 0.5:
        return Effect("support-compliance", "mass-spring-dashpot", numbers, True)
    numbers["gap"] = _log(rng, 5e-6, 40e-6)
    return Effect("support-compliance", "spring-with-play", numbers)


# --- tangential -------------------------------------------------------------------------------


def _elastic_slip(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    nu = rig.target.nu
    ratio = 2.0 * (1.0 - nu) / (2.0 - nu) * float(rng.uniform(0.7, 1.3))
    form = "partial-slip" if family == at.FOUNDATION else "spring-and-slider"
    return Effect("tangential-compliance", form, {"ratio": ratio}, form == "spring-and-slider")


def _plough(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    if rng.random() < 0.4:
        return Effect("ploughing-friction", "spherical-cap", {"factor": _log(rng, 0.5, 4.0)}, True)
    return Effect("ploughing-friction", "power-of-width", {"factor": _log(rng, 0.05, 0.5)})


def _tilt(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    sign = 1.0 if rng.random() < 0.5 else -1.0
    scatter = float(rng.uniform(0.0, 1.0))
    numbers = {
        "angle": sign * math.radians(_log(rng, 1.5, 7.0)), "scatter": math.radians(scatter),
        "seed": float(rng.integers(2**31)),
    }  # fmt: skip
    return Effect("tilt", "offset-and-scatter", numbers)


def _put_tilt(p: Array, rig: Rig, effect: Effect) -> None:
    k = effect.numbers
    scatter = np.random.default_rng(int(k["seed"])).normal(size=len(p)) * k["scatter"]
    p[:, at.THETA] += k["angle"] + scatter


# --- contact losses and surfaces --------------------------------------------------------------


def _damping(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    form, known = _pick(rng, "square-root-of-depth", "square-root-of-depth", "hunt-crossley")
    if rig.bench == "microspheres":  # a time of damping is longer than their contacts
        form, known = "hunt-crossley", True
    if form == "hunt-crossley":
        return Effect("contact-damping", form, {"chi": _log(rng, 0.015, 0.3)}, known)
    return Effect("contact-damping", form, {"time": _log(rng, 2e-7, 6e-6)}, known)


def _put_adhesion(p: Array, rig: Rig, effect: Effect) -> None:
    W = effect.numbers["work"]
    R, E = p[:, at.TIP], p[:, at.MODULUS]
    pull = (1.5 if effect.form == "jkr" else 1.75) * math.pi * W * R
    # work of separation of Johnson, Kendall and Roberts; less in between JKR and DMT
    energy = 7.09 * (W**5 * R**4 / E**2) ** (1.0 / 3.0)
    p[:, at.ADHESION] = pull
    p[:, at.ADHESION_RANGE] = (2.0 if effect.form == "jkr" else 1.5) * energy / pull


def _film(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    numbers = {
        "viscosity": rig.liquid, "thickness": _log(rng, 2e-6, 30e-6),
        "closed": _log(rng, 1e-7, 8e-7), "exit": 0.0 if rng.random() < 0.5 else 0.5,
    }  # fmt: skip
    form = "cavitated-exit" if numbers["exit"] == 0.0 else "partly-cavitated-exit"
    return Effect("squeeze-film", form, numbers)


def _rough(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    tip = float(np.median([s.tip_radius for s in rig.strikers]))
    numbers = {
        "height": _log(rng, 0.3e-6, 3e-6), "force": _log(rng, 0.3, 3.0) * (tip / 1e-3),
        "kept": float(rng.uniform(0.2, 0.9)),
    }  # fmt: skip
    if rng.random() < 0.5:
        return Effect("roughness", "logarithmic-closure", numbers, True)
    return Effect("roughness", "finite-height-closure", numbers)


def _cut(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    tip = rig.strikers[0].tip_radius
    form = "image-of-cut-paraboloid" if family == at.FOUNDATION else "rounded-edge"
    known = family == at.FOUNDATION
    return Effect("truncated-tip", form, {"radius": tip * _log(rng, 0.02, 0.09)}, known)


def _slow(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    if rng.random() < 0.5:
        return Effect("impact-speed-loss", "share", {"loss": _log(rng, 0.015, 0.12)}, True)
    return Effect("impact-speed-loss", "drag", {"per_metre": _log(rng, 0.05, 0.5)})


def _put_slow(p: Array, rig: Rig, effect: Effect) -> None:
    if effect.form == "share":
        p[:, at.NORMAL_SPEED] *= 1.0 - effect.numbers["loss"]
    else:
        height = p[:, at.NORMAL_SPEED] ** 2 / (2.0 * 9.81)
        p[:, at.NORMAL_SPEED] *= np.exp(-effect.numbers["per_metre"] * height)


_METALS = ("rods-normal", "balls-normal")

EFFECTS: dict[str, Kind] = {
    "strain-rate-hardening": Kind((*_METALS, "balls-drops", "balls-heated"), _rate, _placed({}, {
        "overstress-power": {at.RATE_KIND: flow.POWER, at.RATE_A: "D", at.RATE_B: "q"},
        "overstress-logarithm": {
            at.RATE_KIND: flow.LOGARITHM, at.RATE_A: "C", at.RATE_B: "reference"},
        "zerilli-armstrong": {at.RATE_KIND: flow.THERMAL, at.RATE_A: "A", at.RATE_B: "m"},
    })),
    "work-hardening": Kind(
        (*_METALS, "balls-drops", "balls-small", "balls-heated"),
        _drawn("work-hardening", ("voce", "voce", "swift"), {
            "voce": {"rise": (0.15, 1.2), "strain": (0.008, 0.05)},
            "swift": {"n": (0.06, 0.35), "strain": (0.002, 0.008)},
        }),
        _placed({at.HARD_B: "strain"}, {
            "voce": {at.HARD_KIND: flow.VOCE, at.HARD_A: "rise"},
            "swift": {at.HARD_KIND: flow.SWIFT, at.HARD_A: "n"},
        })),
    "thermal-softening": Kind(
        ("balls-heated",),
        _drawn("thermal-softening",
               ("exponential", "exponential", "power-of-homologous-temperature"),
               {"exponential": {"T_scale": (500.0, 3000.0)}, "": {"m": (0.6, 2.5)}}),
        _put_thermal),
    "half-space-waves": Kind(("balls-elastic", "balls-normal", "balls-drops"), _waves, _put_waves),
    "rod-longitudinal-waves": Kind(
        ("rods-normal",),
        _drawn("rod-longitudinal-waves", "bar-elements",
               {"": {"elements": 30.0, "loss_time": (3e-9, 1e-7)}}), _beam),
    "rod-flexural-vibration": Kind(
        ("rods-oblique", "rods-angles"),
        _drawn("rod-flexural-vibration", "beam-elements",
               {"": {"elements": 40.0, "loss_time": (3e-9, 1e-7)}}), _beam),
    "support-compliance": Kind(
        (*_METALS, "balls-heated"), _support,
        _placed({at.SUPPORT_MASS: "mass", at.SUPPORT_STIFFNESS: "stiffness",
                 at.SUPPORT_DAMPING: "damping"}, {"spring-with-play": {at.SUPPORT_GAP: "gap"}})),
    "tangential-compliance": Kind(
        ("balls-oblique",), _elastic_slip, _placed({at.TANGENTIAL_RATIO: "ratio"})),
    "velocity-dependent-friction": Kind(
        ("balls-oblique", "rods-oblique"),
        _drawn("velocity-dependent-friction", ("hyperbolic", "logarithmic", "exponential"), {
            "logarithmic": {"share": (0.06, 0.25), "speed": (0.02, 0.3)},
            "": {"share": (0.3, 2.0), "speed": (0.1, 0.8)},
        }),
        _placed({at.FRICTION_A: "share", at.FRICTION_B: "speed"}, {
            "hyperbolic": {at.FRICTION_KIND: 1.0}, "logarithmic": {at.FRICTION_KIND: 2.0},
            "exponential": {at.FRICTION_KIND: 3.0},
        })),
    "ploughing-friction": Kind(
        ("rods-oblique", "balls-oblique"), _plough,
        _placed({at.PLOUGH: "factor"}, {"spherical-cap": {at.PLOUGH_KIND: 1.0},
                                        "power-of-width": {at.PLOUGH_KIND: 2.0}})),
    "contact-damping": Kind(
        ("balls-elastic", "microspheres", "balls-heated", *_METALS), _damping,
        _placed({}, {"hunt-crossley": {at.DAMP_KIND: 1.0, at.DAMP: "chi"},
                     "square-root-of-depth": {at.DAMP_KIND: 2.0, at.DAMP: "time"}})),
    "adhesion": Kind(
        ("microspheres",),
        _drawn("adhesion", ("maugis", "maugis", "jkr"), {"": {"work": (0.05, 0.6)}}),
        _put_adhesion),
    "squeeze-film": Kind(
        ("balls-normal", "balls-elastic"), _film,
        _placed({at.FILM_VISCOSITY: "viscosity", at.FILM_THICKNESS: "thickness",
                 at.FILM_CLOSED: "closed", at.FILM_EXIT: "exit"})),
    "roughness": Kind(
        ("balls-small",), _rough,
        _placed({at.ROUGH: "height", at.ROUGH_FORCE: "force", at.ROUGH_LOSS: "kept"},
                {"finite-height-closure": {at.ROUGH_KIND: 1.0}})),
    "truncated-tip": Kind(("rods-normal",), _cut, _placed({at.FLAT: "radius"})),
    "hardened-layer": Kind(
        (*_METALS, "balls-small", "balls-heated"),
        _drawn("hardened-layer", ("plateau", "plateau", "exponential"),
               {"": {"rise": (0.2, 1.8), "thickness": _in_tips(0.015, 0.08)}}),
        _placed({at.LAYER_A: "rise", at.LAYER_B: "thickness"},
                {"plateau": {at.LAYER_KIND: flow.PLATEAU},
                 "exponential": {at.LAYER_KIND: flow.EXPONENTIAL}})),
    "size-effect": Kind(
        ("balls-small",),
        _drawn("size-effect", ("power", "power", "swadener"), {"": {"length": (15e-6, 300e-6)}}),
        _put_size),
    "impact-speed-loss": Kind(_METALS, _slow, _put_slow),
    "tilt": Kind(("rods-oblique", "rods-angles"), _tilt, _put_tilt),
}  # fmt: skip
"""The names of the verdict, in its order."""


# --- outside the library ----------------------------------------------------------------------


def _order(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    numbers = {"rise": float(rng.choice([-1, 1])) * _log(rng, 0.15, 0.5), "seed": 0.0}
    numbers["seed"] = float(rng.integers(2**31))
    return Effect("drift-with-order", "linear", numbers)


def order_of(rig: Rig, seed: float) -> Indices:
    """Order in which the trials were made, a shuffle, shape (n,)."""
    return np.random.default_rng(int(seed)).permutation(len(rig))


def _put_order(p: Array, rig: Rig, effect: Effect) -> None:
    place = order_of(rig, effect.numbers["seed"]) / max(len(rig) - 1, 1)
    p[:, at.STRENGTH] *= 1.0 + effect.numbers["rise"] * (place - 0.5)


def _threshold(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    v = np.unique(rig.speed)
    numbers = {"speed": float(v[len(v) // 2] * 0.97), "factor": float(rng.uniform(0.5, 0.75))}
    return Effect("speed-threshold", "strength-drops", numbers)


def _put_threshold(p: Array, rig: Rig, effect: Effect) -> None:
    k = effect.numbers
    p[:, at.STRENGTH] *= np.where(p[:, at.NORMAL_SPEED] > k["speed"], k["factor"], 1.0)


OUTSIDE: dict[str, Kind] = {
    "strain-softening": Kind(
        _METALS,
        _drawn("strain-softening", "saturating",
               {"": {"fall": _even(0.25, 0.55), "strain": (0.006, 0.02)}}),
        _placed({at.HARD_KIND: flow.SOFTENING, at.HARD_A: "fall", at.HARD_B: "strain"})),
    "crushed-layer": Kind(
        (*_METALS, "balls-small"),
        _drawn("crushed-layer", "gaussian",
               {"": {"fall": _even(0.35, 0.75), "thickness": _in_tips(0.02, 0.08)}}),
        _placed({at.LAYER_KIND: flow.CRUSHED, at.LAYER_A: "fall", at.LAYER_B: "thickness"})),
    "negative-rate-sensitivity": Kind(
        _METALS, _drawn("negative-rate-sensitivity", "logarithm", {"": {"C": (0.02, 0.08)}}),
        _placed({at.RATE_KIND: flow.FALLING, at.RATE_A: "C", at.RATE_B: 1.0})),
    "oscillating-strength": Kind(
        (*_METALS, "balls-small"),
        _drawn("oscillating-strength", "sine-of-width",
               {"": {"share": _even(0.12, 0.35), "length": _in_tips(0.04, 0.12)}}),
        _placed({at.WAVE_A: "share", at.WAVE_B: "length"})),
    "drift-with-order": Kind((*_METALS, "balls-oblique", "balls-heated"), _order, _put_order),
    "speed-threshold": Kind((*_METALS, "balls-small"), _threshold, _put_threshold),
}  # fmt: skip
"""Effects that no name of the verdict covers."""
