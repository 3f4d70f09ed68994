"""What may be missing: each effect drawn with its constitutive form, and put into the impacts.

An effect is a name, a form and numbers; `put` writes it into the rows of a bench. The names of
`EFFECTS` are those of the verdict; `OUTSIDE` holds what no name covers.
"""

from __future__ import annotations

import math
from collections.abc import Callable
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


@dataclass(frozen=True)
class Kind:
    """How an effect is drawn and put, and the benches that can show it."""

    benches: tuple[str, ...]
    draw: Callable[[np.random.Generator, Rig, float], Effect]
    put: Callable[[Array, Rig, Effect], None]


def _log(rng: np.random.Generator, low: float, high: float) -> float:
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))


def _pick(rng: np.random.Generator, first: str, second: str, textbook: str) -> tuple[str, bool]:
    """Form of the effect; the textbook one, if there is one, in four of ten truths."""
    if textbook and rng.random() < 0.4:
        return textbook, True
    return (first if rng.random() < 0.5 else second), False


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


def _put_rate(p: Array, rig: Rig, effect: Effect) -> None:
    k = effect.numbers
    if effect.form == "overstress-power":
        kind, a, b = flow.POWER, k["D"], k["q"]
    elif effect.form == "overstress-logarithm":
        kind, a, b = flow.LOGARITHM, k["C"], k["reference"]
    else:
        kind, a, b = flow.THERMAL, k["A"], k["m"]
    p[:, at.RATE_KIND], p[:, at.RATE_A], p[:, at.RATE_B] = kind, a, b


def _hardening(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    form, known = _pick(rng, "voce", "voce", "swift")
    if form == "voce":
        numbers = {"rise": _log(rng, 0.15, 1.2), "strain": _log(rng, 0.008, 0.05)}
    else:
        numbers = {"n": _log(rng, 0.06, 0.35), "strain": _log(rng, 0.002, 0.008)}
    return Effect("work-hardening", form, numbers, known)


def _put_hardening(p: Array, rig: Rig, effect: Effect) -> None:
    k = effect.numbers
    voce = effect.form == "voce"
    p[:, at.HARD_KIND] = flow.VOCE if voce else flow.SWIFT
    p[:, at.HARD_A] = k["rise"] if voce else k["n"]
    p[:, at.HARD_B] = k["strain"]


def _thermal(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    form, known = _pick(rng, "exponential", "exponential", "power-of-homologous-temperature")
    if form == "exponential":
        return Effect("thermal-softening", form, {"T_scale": _log(rng, 500.0, 3000.0)}, known)
    return Effect("thermal-softening", form, {"m": _log(rng, 0.6, 2.5)}, known)


def _put_thermal(p: Array, rig: Rig, effect: Effect) -> None:
    rise = rig.temperature - 293.0
    if effect.form == "exponential":
        p[:, at.STRENGTH] *= np.exp(-rise / effect.numbers["T_scale"])
    else:
        melt = rig.target.melting - 293.0
        p[:, at.STRENGTH] *= 1.0 - (np.maximum(rise, 0.0) / melt) ** effect.numbers["m"]


def _layer(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    form, known = _pick(rng, "plateau", "plateau", "exponential")
    depth = float(np.median([s.tip_radius for s in rig.strikers]))
    numbers = {"rise": _log(rng, 0.2, 1.8), "thickness": depth * _log(rng, 0.015, 0.08)}
    return Effect("hardened-layer", form, numbers, known)


def _put_layer(p: Array, rig: Rig, effect: Effect) -> None:
    p[:, at.LAYER_KIND] = flow.PLATEAU if effect.form == "plateau" else flow.EXPONENTIAL
    p[:, at.LAYER_A] = effect.numbers["rise"]
    p[:, at.LAYER_B] = effect.numbers["thickness"]


def _size(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    form, known = _pick(rng, "power", "power", "swadener")
    return Effect("size-effect", form, {"length": _log(rng, 15e-6, 300e-6)}, known)


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


def _axial(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    numbers = {"elements": 30.0, "loss_time": _log(rng, 3e-9, 1e-7)}
    return Effect("rod-longitudinal-waves", "bar-elements", numbers)


def _flexural(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    numbers = {"elements": 40.0, "loss_time": _log(rng, 3e-9, 1e-7)}
    return Effect("rod-flexural-vibration", "beam-elements", numbers)


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


def _put_support(p: Array, rig: Rig, effect: Effect) -> None:
    k = effect.numbers
    p[:, at.SUPPORT_MASS], p[:, at.SUPPORT_STIFFNESS] = k["mass"], k["stiffness"]
    p[:, at.SUPPORT_DAMPING] = k["damping"]
    p[:, at.SUPPORT_GAP] = k.get("gap", 0.0)


# --- tangential -------------------------------------------------------------------------------


def _elastic_slip(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    nu = rig.target.nu
    ratio = 2.0 * (1.0 - nu) / (2.0 - nu) * float(rng.uniform(0.7, 1.3))
    form = "partial-slip" if family == at.FOUNDATION else "spring-and-slider"
    return Effect("tangential-compliance", form, {"ratio": ratio}, form == "spring-and-slider")


def _put_elastic_slip(p: Array, rig: Rig, effect: Effect) -> None:
    p[:, at.TANGENTIAL_RATIO] = effect.numbers["ratio"]


def _speed_friction(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    form, known = _pick(rng, "hyperbolic", "logarithmic", "exponential")
    if form == "logarithmic":
        numbers = {"share": _log(rng, 0.06, 0.25), "speed": _log(rng, 0.02, 0.3)}
    else:
        numbers = {"share": _log(rng, 0.3, 2.0), "speed": _log(rng, 0.1, 0.8)}
    return Effect("velocity-dependent-friction", form, numbers, known)


def _put_speed_friction(p: Array, rig: Rig, effect: Effect) -> None:
    kinds = {"hyperbolic": 1.0, "logarithmic": 2.0, "exponential": 3.0}
    p[:, at.FRICTION_KIND] = kinds[effect.form]
    p[:, at.FRICTION_A], p[:, at.FRICTION_B] = effect.numbers["share"], effect.numbers["speed"]


def _plough(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    if rng.random() < 0.4:
        return Effect("ploughing-friction", "spherical-cap", {"factor": _log(rng, 0.5, 4.0)}, True)
    return Effect("ploughing-friction", "power-of-width", {"factor": _log(rng, 0.05, 0.5)})


def _put_plough(p: Array, rig: Rig, effect: Effect) -> None:
    p[:, at.PLOUGH_KIND] = 1.0 if effect.form == "spherical-cap" else 2.0
    p[:, at.PLOUGH] = effect.numbers["factor"]


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


def _put_damping(p: Array, rig: Rig, effect: Effect) -> None:
    known = effect.form == "hunt-crossley"
    p[:, at.DAMP_KIND] = 1.0 if known else 2.0
    p[:, at.DAMP] = effect.numbers["chi" if known else "time"]


def _adhesion(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    form, known = _pick(rng, "maugis", "maugis", "jkr")
    return Effect("adhesion", form, {"work": _log(rng, 0.05, 0.6)}, known)


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


def _put_film(p: Array, rig: Rig, effect: Effect) -> None:
    k = effect.numbers
    p[:, at.FILM_VISCOSITY], p[:, at.FILM_THICKNESS] = k["viscosity"], k["thickness"]
    p[:, at.FILM_CLOSED], p[:, at.FILM_EXIT] = k["closed"], k["exit"]


def _rough(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    tip = float(np.median([s.tip_radius for s in rig.strikers]))
    numbers = {
        "height": _log(rng, 0.3e-6, 3e-6), "force": _log(rng, 0.3, 3.0) * (tip / 1e-3),
        "kept": float(rng.uniform(0.2, 0.9)),
    }  # fmt: skip
    if rng.random() < 0.5:
        return Effect("roughness", "logarithmic-closure", numbers, True)
    return Effect("roughness", "finite-height-closure", numbers)


def _put_rough(p: Array, rig: Rig, effect: Effect) -> None:
    k = effect.numbers
    p[:, at.ROUGH_KIND] = float(effect.form == "finite-height-closure")
    p[:, at.ROUGH], p[:, at.ROUGH_FORCE], p[:, at.ROUGH_LOSS] = k["height"], k["force"], k["kept"]


def _cut(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    tip = rig.strikers[0].tip_radius
    form = "image-of-cut-paraboloid" if family == at.FOUNDATION else "rounded-edge"
    known = family == at.FOUNDATION
    return Effect("truncated-tip", form, {"radius": tip * _log(rng, 0.02, 0.09)}, known)


def _put_cut(p: Array, rig: Rig, effect: Effect) -> None:
    p[:, at.FLAT] = effect.numbers["radius"]


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
    "strain-rate-hardening": Kind((*_METALS, "balls-drops", "balls-heated"), _rate, _put_rate),
    "work-hardening": Kind(
        (*_METALS, "balls-drops", "balls-small", "balls-heated"), _hardening, _put_hardening
    ),
    "thermal-softening": Kind(("balls-heated",), _thermal, _put_thermal),
    "half-space-waves": Kind(("balls-elastic", "balls-normal", "balls-drops"), _waves, _put_waves),
    "rod-longitudinal-waves": Kind(("rods-normal",), _axial, _beam),
    "rod-flexural-vibration": Kind(("rods-oblique", "rods-angles"), _flexural, _beam),
    "support-compliance": Kind((*_METALS, "balls-heated"), _support, _put_support),
    "tangential-compliance": Kind(("balls-oblique",), _elastic_slip, _put_elastic_slip),
    "velocity-dependent-friction": Kind(
        ("balls-oblique", "rods-oblique"), _speed_friction, _put_speed_friction
    ),
    "ploughing-friction": Kind(("rods-oblique", "balls-oblique"), _plough, _put_plough),
    "contact-damping": Kind(
        ("balls-elastic", "microspheres", "balls-heated", *_METALS), _damping, _put_damping
    ),
    "adhesion": Kind(("microspheres",), _adhesion, _put_adhesion),
    "squeeze-film": Kind(("balls-normal", "balls-elastic"), _film, _put_film),
    "roughness": Kind(("balls-small",), _rough, _put_rough),
    "truncated-tip": Kind(("rods-normal",), _cut, _put_cut),
    "hardened-layer": Kind((*_METALS, "balls-small", "balls-heated"), _layer, _put_layer),
    "size-effect": Kind(("balls-small",), _size, _put_size),
    "impact-speed-loss": Kind(_METALS, _slow, _put_slow),
    "tilt": Kind(("rods-oblique", "rods-angles"), _tilt, _put_tilt),
}
"""The names of the verdict, in its order."""


# --- outside the library ----------------------------------------------------------------------


def _softening(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    numbers = {"fall": float(rng.uniform(0.25, 0.55)), "strain": _log(rng, 0.006, 0.02)}
    return Effect("strain-softening", "saturating", numbers)


def _put_softening(p: Array, rig: Rig, effect: Effect) -> None:
    k = effect.numbers
    p[:, at.HARD_KIND], p[:, at.HARD_A], p[:, at.HARD_B] = flow.SOFTENING, k["fall"], k["strain"]


def _crushed(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    tip = float(np.median([s.tip_radius for s in rig.strikers]))
    numbers = {"fall": float(rng.uniform(0.35, 0.75)), "thickness": tip * _log(rng, 0.02, 0.08)}
    return Effect("crushed-layer", "gaussian", numbers)


def _put_crushed(p: Array, rig: Rig, effect: Effect) -> None:
    k = effect.numbers
    p[:, at.LAYER_KIND], p[:, at.LAYER_A], p[:, at.LAYER_B] = (
        flow.CRUSHED,
        k["fall"],
        k["thickness"],
    )


def _falling(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    return Effect("negative-rate-sensitivity", "logarithm", {"C": _log(rng, 0.02, 0.08)})


def _put_falling(p: Array, rig: Rig, effect: Effect) -> None:
    p[:, at.RATE_KIND], p[:, at.RATE_A], p[:, at.RATE_B] = flow.FALLING, effect.numbers["C"], 1.0


def _oscillating(rng: np.random.Generator, rig: Rig, family: float) -> Effect:
    tip = float(np.median([s.tip_radius for s in rig.strikers]))
    numbers = {"share": float(rng.uniform(0.12, 0.35)), "length": tip * _log(rng, 0.04, 0.12)}
    return Effect("oscillating-strength", "sine-of-width", numbers)


def _put_oscillating(p: Array, rig: Rig, effect: Effect) -> None:
    p[:, at.WAVE_A], p[:, at.WAVE_B] = effect.numbers["share"], effect.numbers["length"]


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
    "strain-softening": Kind(_METALS, _softening, _put_softening),
    "crushed-layer": Kind((*_METALS, "balls-small"), _crushed, _put_crushed),
    "negative-rate-sensitivity": Kind(_METALS, _falling, _put_falling),
    "oscillating-strength": Kind((*_METALS, "balls-small"), _oscillating, _put_oscillating),
    "drift-with-order": Kind((*_METALS, "balls-oblique", "balls-heated"), _order, _put_order),
    "speed-threshold": Kind((*_METALS, "balls-small"), _threshold, _put_threshold),
}
"""Effects that no name of the verdict covers."""
