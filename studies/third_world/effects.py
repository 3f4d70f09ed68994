"""What may be missing: each effect drawn in a published form, and put into the blows."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import Array, Indices
from .benches import Rig
from .physics import Physics

Numbers = dict[str, float]


@dataclass(frozen=True)
class Effect:
    """Name, form and numbers (SI) of what acts."""

    name: str
    form: str
    numbers: Numbers


@dataclass(frozen=True)
class Kind:
    """The rigs that can show an effect, its draw, and how it acts."""

    benches: tuple[str, ...]
    draw: Callable[[np.random.Generator, Rig], Effect]
    put: Callable[[Physics, Effect], None]


def _log(rng: np.random.Generator, low: float, high: float) -> float:
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))


Draw = Callable[[np.random.Generator, Rig], Effect]


def _drawn(name: str, forms: tuple[str, ...], **ranges: tuple[float, float]) -> Draw:
    """Return a draw of one of the forms, its numbers log-uniform."""

    def draw(rng: np.random.Generator, rig: Rig) -> Effect:
        numbers = {k: _log(rng, *ends) for k, ends in ranges.items()}
        return Effect(name, str(rng.choice(forms)), numbers)

    return draw


def tip_of(rig: Rig) -> float:
    """Middle radius of the strikers' tips [m]."""
    return float(np.median([b.tip_radius for b in rig.strikers]))


def _of_tips(name: str, forms: tuple[str, ...], length: str, ends: tuple[float, float],
             **ranges: tuple[float, float]) -> Draw:  # fmt: skip
    """The same with a length that is drawn in radii of the tip."""

    def draw(rng: np.random.Generator, rig: Rig) -> Effect:
        one = _drawn(name, forms, **ranges)(rng, rig)
        return replace(one, numbers=one.numbers | {length: tip_of(rig) * _log(rng, *ends)})

    return draw


# --- strength ---------------------------------------------------------------------------------


def _put_rate(p: Physics, effect: Effect) -> None:
    k, still = effect.numbers, p.speed

    def rate(a: Array, v: Array) -> Array:
        # a dent's mean rate, v/a times Tabor's 0.2 of a strain (Tirupataiah and Sundararajan,
        # J. Mech. Phys. Solids 39 (1991) 243); as it slows down, or one of the whole blow
        at = 0.4 * (v if effect.form != "mean-of-blow" else np.where(v > 0.0, 0.7 * still, 0.0)) / a
        if effect.form == "cowper-symonds":
            return 1.0 + k["rise"] * (at / 1e3) ** 0.2
        return 1.0 + k["rise"] * np.log1p(at) / math.log(1e3)

    p.strength.append(rate)


def _put_hardening(p: Physics, effect: Effect) -> None:
    k, R = effect.numbers, p.R
    # strain of a dent 0.2 a/R (Tabor); a stress that rises as Ludwik's or Swift's
    if effect.form == "swift":
        p.strength.append(lambda a, v: (1.0 + 0.2 * a / R / k["strain"]) ** k["n"])
    else:
        p.strength.append(lambda a, v: 1.0 + k["n"] * 6.0 * (0.2 * a / R) ** 0.5)


def _put_heat(p: Physics, effect: Effect) -> None:
    above = p.rig.temperature - 293.0
    if effect.form == "johnson-cook":
        share = above / (p.rig.flat.melting - 293.0)
        p.Y *= 1.0 - np.maximum(share, 0.0) ** (0.6 + effect.numbers["pace"])
    else:
        p.Y *= 1.0 / (1.0 + effect.numbers["pace"] * (above / 500.0) ** 2)


def _put_layer(p: Physics, effect: Effect) -> None:
    k = effect.numbers
    # a dent feels some of its radius deep (Jonsson and Hogmark, Thin Solid Films 114 (1984) 257)
    power = 1.0 if effect.form == "gradual" else 2.0
    p.strength.append(lambda a, v: 1.0 + k["rise"] / (1.0 + (a / k["thickness"]) ** power))


def _put_size(p: Physics, effect: Effect) -> None:
    ratio = effect.numbers["length"] / p.R
    # Swadener, George and Pharr, J. Mech. Phys. Solids 50 (2002) 681
    p.Y *= np.sqrt(1.0 + ratio) if effect.form == "swadener" else 1.0 + 0.7 * ratio**0.6


# --- bodies and waves -------------------------------------------------------------------------


def _put_waves(p: Physics, effect: Effect) -> None:
    flat = p.rig.flat
    if effect.form == "plate":  # Zener, Phys. Rev. 59 (1941) 669
        h = effect.numbers["thickness"]
        bending = flat.E * h**3 / (12.0 * (1.0 - flat.nu**2))
        p.plate = 1.0 / (8.0 * math.sqrt(flat.density * h * bending))
        return
    # an embedded disc's dashpot (Lysmer and Richart, J. Soil Mech. 92 (1966) 65), for its share of
    # the approach
    G = flat.E / (2.0 * (1.0 + flat.nu))
    share = float(p.E[0]) * (1.0 - flat.nu**2) / flat.E
    p.dashpot = 3.4 * math.sqrt(flat.density * G) / (1.0 - flat.nu) * share**2


def _waves(rng: np.random.Generator, rig: Rig) -> Effect:
    if rig.bench == "elastic":
        return Effect("half-space-waves", "dashpot", {})
    return Effect("half-space-waves", "plate", {"thickness": rig.told["thickness_m"]})


def _put_flexible(p: Physics, effect: Effect) -> None:
    p.flexible, p.loss = True, effect.numbers["loss_time"]


def _put_support(p: Physics, effect: Effect) -> None:
    k = effect.numbers
    mass = max(k["masses"] * float(np.max(p.mass)), 0.1)
    stiffness = mass * (2.0 * math.pi / k["period"]) ** 2
    p.support = (mass, stiffness, 2.0 * k["damping"] * math.sqrt(stiffness * mass))


# --- friction and approach --------------------------------------------------------------------


def _put_slip(p: Physics, effect: Effect) -> None:
    p.slip = effect.numbers["share"]


def _put_rub(p: Physics, effect: Effect) -> None:
    k = effect.numbers
    if effect.form == "stribeck":  # Stribeck, VDI-Z. 46 (1902) 1341, in an exponential
        p.rub.append(lambda v, a: 1.0 + k["rise"] * np.exp(-v / k["speed"]))
    else:
        fall = 0.15 * k["rise"]
        p.rub.append(lambda v, a: np.maximum(1.0 - fall * np.log1p(v / k["speed"]), 0.1))


def _put_plough(p: Physics, effect: Effect) -> None:
    # Goddard and Wilman, Wear 5 (1962) 114: 4 a/(3 pi R); or the part of a cap's front, a/R
    slope = 4.0 / (3.0 * math.pi) if effect.form == "goddard-wilman" else 0.6
    p.plough.append(lambda v, a: effect.numbers["factor"] * slope * a / p.R)


def _tilt(rng: np.random.Generator, rig: Rig) -> Effect:
    sign = float(rng.choice([-1.0, 1.0]))
    return Effect("tilt", "offset", {"angle": sign * math.radians(_log(rng, 1.5, 6.0))})


def _put_tilt(p: Physics, effect: Effect) -> None:
    p.angle = p.angle + effect.numbers["angle"]


def _put_slow(p: Physics, effect: Effect) -> None:
    loss = effect.numbers["loss"]
    if effect.form == "guide-force":  # of one size for all strikers
        p.speed = p.speed * np.sqrt(1.0 - np.minimum(loss * np.min(p.mass) / p.mass * 4.0, 0.9))
    else:
        p.speed = p.speed * (1.0 - loss)


# --- contact ----------------------------------------------------------------------------------


def _damping(rng: np.random.Generator, rig: Rig) -> Effect:
    # Kuwabara and Kono, Jpn. J. Appl. Phys. 26 (1987) 1230; Tsuji, Tanaka and Ishida, Powder
    # Technol. 71 (1992) 239
    if rig.bench != "beads" and rng.random() < 0.5:  # that time is longer than their contacts
        return Effect("contact-damping", "kuwabara-kono", {"time": _log(rng, 3e-7, 5e-6)})
    return Effect("contact-damping", "tsuji", {"alpha": _log(rng, 0.02, 0.25)})


def _put_damping(p: Physics, effect: Effect) -> None:
    p.damper = (effect.form, next(iter(effect.numbers.values())))


def _put_adhesion(p: Physics, effect: Effect) -> None:
    W = effect.numbers["work"]  # Thornton and Ning, Powder Technol. 99 (1998) 154
    p.adhesion = 7.09 * (W**5 * p.R**4 / p.E**2) ** (1.0 / 3.0)


def _put_film(p: Physics, effect: Effect) -> None:
    k = effect.numbers  # Davis, Serayssol and Hinch, J. Fluid Mech. 163 (1986) 479
    drag = 6.0 * math.pi * k["viscosity"] * p.R**2 / p.mass
    p.film = (drag * math.log(k["thickness"] / k["closest"]), k["exit"])


def _film(rng: np.random.Generator, rig: Rig) -> Effect:
    one = _drawn("squeeze-film", ("lubrication",), thickness=(5e-6, 4e-5), closest=(2e-7, 8e-7),
                 exit=(0.05, 0.5))(rng, rig)  # fmt: skip
    return replace(one, numbers=one.numbers | {"viscosity": rig.fluid})


def _put_rough(p: Physics, effect: Effect) -> None:
    k = effect.numbers
    p.layer = (k["height"], k["bears"], k["kept"])


def _put_cut(p: Physics, effect: Effect) -> None:
    p.flat = effect.numbers["radius"]


_METALS = ("balls", "rods", "pressed")

EFFECTS: dict[str, Kind] = {
    "strain-rate-hardening": Kind(
        ("balls", "drops", "pressed", "heated", "plateau"),
        _drawn("strain-rate-hardening", ("johnson-cook", "cowper-symonds", "mean-of-blow"),
               rise=(0.08, 0.45)), _put_rate),
    "work-hardening": Kind(
        (*_METALS, "drops", "small", "heated"),
        _drawn("work-hardening", ("swift", "square-root"), n=(0.08, 0.35), strain=(0.002, 0.008)),
        _put_hardening),
    "thermal-softening": Kind(
        ("heated",),
        _drawn("thermal-softening", ("johnson-cook", "lorentz"), pace=(0.1, 1.5)), _put_heat),
    "half-space-waves": Kind(("elastic", "balls", "drops"), _waves, _put_waves),
    "rod-longitudinal-waves": Kind(
        ("rods",),
        _drawn("rod-longitudinal-waves", ("masses-and-springs",), loss_time=(5e-9, 1e-7)),
        _put_flexible),
    "rod-flexural-vibration": Kind(
        ("rods-aslant",),
        _drawn("rod-flexural-vibration", ("differences",), loss_time=(5e-9, 1e-7)),
        _put_flexible),
    "support-compliance": Kind(
        (*_METALS, "heated", "plateau"),
        _drawn("support-compliance", ("mass-and-spring",), masses=(3.0, 40.0), period=(1e-4, 1e-3),
               damping=(0.01, 0.3)), _put_support),
    "tangential-compliance": Kind(
        ("balls-aslant",),
        _drawn("tangential-compliance", ("mindlin-increments",), share=(0.7, 1.3)),
        _put_slip),
    "velocity-dependent-friction": Kind(
        ("balls-aslant", "rods-aslant"),
        _drawn("velocity-dependent-friction", ("stribeck", "logarithm"), rise=(0.3, 1.8),
               speed=(0.1, 0.8)), _put_rub),
    "ploughing-friction": Kind(
        ("rods-aslant", "balls-aslant"),
        _drawn("ploughing-friction", ("goddard-wilman", "front"), factor=(0.5, 3.0)),
        _put_plough),
    "contact-damping": Kind(
        ("elastic", "balls", "rods", "beads", "heated", "plateau"), _damping, _put_damping),
    "adhesion": Kind(
        ("beads",), _drawn("adhesion", ("jkr-energy",), work=(0.05, 0.6)), _put_adhesion),
    "squeeze-film": Kind(("balls", "elastic"), _film, _put_film),
    "roughness": Kind(
        ("small",),
        _drawn("roughness", ("exponential-heights",), height=(0.4e-6, 3e-6), bears=(0.1, 0.5),
               kept=(0.3, 0.9)), _put_rough),
    "truncated-tip": Kind(
        ("rods",), _of_tips("truncated-tip", ("area-function",), "radius", (0.02, 0.09)), _put_cut),
    "hardened-layer": Kind(
        (*_METALS, "small", "heated", "plateau"),
        _of_tips("hardened-layer", ("gradual", "sharp"), "thickness", (0.05, 0.2), rise=(0.3, 1.5)),
        _put_layer),
    "size-effect": Kind(
        ("small",), _drawn("size-effect", ("swadener", "power"), length=(3e-5, 3e-4)), _put_size),
    "impact-speed-loss": Kind(
        ("balls", "rods", "drops"),
        _drawn("impact-speed-loss", ("share", "guide-force"), loss=(0.015, 0.1)), _put_slow),
    "tilt": Kind(("rods-aslant",), _tilt, _put_tilt),
}  # fmt: skip
"""By the names of a verdict."""


# --- without a name ---------------------------------------------------------------------------


def _scattered(p: Physics, amount: float, seed: float, groups: Indices) -> None:
    apart = np.linspace(-1.0, 1.0, int(groups.max()) + 1)
    p.Y *= np.exp(amount * np.random.default_rng(int(seed)).permutation(apart)[groups])


def _seeded(name: str, form: str, **ranges: tuple[float, float]) -> Draw:
    def draw(rng: np.random.Generator, rig: Rig) -> Effect:
        one = _drawn(name, (form,), **ranges)(rng, rig)
        return replace(one, numbers=one.numbers | {"seed": float(rng.integers(2**31))})

    return draw


def _put_drift(p: Physics, effect: Effect) -> None:
    n = len(p.R)
    order = np.random.default_rng(int(effect.numbers["seed"])).permutation(n)
    p.Y *= 1.0 + effect.numbers["rise"] * (order / max(n - 1, 1) - 0.5)


def _put_collapse(p: Physics, effect: Effect) -> None:
    k = effect.numbers

    def gives_way(a: Array, v: Array) -> Array:
        return 1.0 - k["fall"] / (1.0 + np.exp(-(a / p.R / k["at"] - 1.0) * 20.0))

    p.strength.append(gives_way)


def _put_bars(p: Physics, effect: Effect) -> None:
    _scattered(p, effect.numbers["spread"], effect.numbers["seed"], p.rig.which)


def _put_speeds(p: Physics, effect: Effect) -> None:
    groups = np.unique(p.rig.speed, return_inverse=True)[1]
    _scattered(p, effect.numbers["spread"], effect.numbers["seed"], groups)


OUTSIDE: dict[str, Kind] = {
    "drift-with-order": Kind(("balls", "rods"), _seeded("drift-with-order", "linear",
                             rise=(0.25, 0.6)), _put_drift),
    "collapse": Kind(("balls", "rods", "drops"), _drawn("collapse", ("pressure-falls",),
                     fall=(0.3, 0.6), at=(0.08, 0.16)), _put_collapse),
    "other-bar-by-striker": Kind(("balls", "small"), _seeded("other-bar-by-striker", "scatter",
                                 spread=(0.2, 0.5)), _put_bars),
    "other-bar-by-speed": Kind(("balls", "rods"), _seeded("other-bar-by-speed", "scatter",
                               spread=(0.15, 0.4)), _put_speeds),
}  # fmt: skip
"""What no name of a verdict covers: strength that drifts, gives way, or is of another bar's."""
