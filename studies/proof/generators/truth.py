"""What a set conceals: drawn from a seed, never shown to the diagnosing process."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ....core.arrays import Array
from .benches import BENCHES
from .effects import EFFECTS, OUTSIDE, Effect
from .metals import draw_metal
from .parameters import CAVITY, FOUNDATION
from .rig import NUISANCES, Rig
from .simulate import Visibility, beyond_library, size_of

HEIGHTS = 0.3
"""Share of the rigs with normal impacts whose sheet states heights in place of speeds."""

DECOYS = 0.5
"""Share of the rigs where a liquid, or a thin plate, could act whose sheet states one."""

BLOCK = 0.15
"""Thickness of a flat that is told to be a block [m]."""

_LIQUID, _THIN = (0.05, 1.0), (4e-3, 20e-3)
"""Viscosity of a liquid [Pa s] and thickness of a plate [m] that a sheet states: from, to."""

SEEN, ENORMOUS = 4.0, 80.0
"""Sizes between which a drawn effect is kept at once; else the nearest of several draws."""

BEYOND = 10.0
"""Size of what nothing else imitates, from which an effect is kept at once: outside the library of
what that leaves, in a pair of what the other effect's numbers leave."""

PLANTED = ("mass-error", "strength-error")
"""Kinds of case in which a stated value is wrong by more than its tolerance allows."""

_RIGS, _DRAWS = 2, 4
"""How many rigs are tried, and draws of an effect on each: few rigs, since a rig that was chosen
for what acts on it says what acts."""

_SAME_SEAM = ({"half-space-waves", "support-compliance"}, {"work-hardening", "hardened-layer"})


@dataclass(frozen=True)
class Instrument:
    """Shape of the noise, share of outliers and of missing cells, seed."""

    shape: str
    outliers: float
    missing: float
    seed: int


@dataclass(frozen=True)
class Truth:
    """One concealed case.

    - `kind`: `null`, `single`, `pair` or `outside`.
    - `rig`: the bench.
    - `effects`: what acts; empty for a null.
    - `sizes`: size of each effect, less what the numbers of others imitate; outside the library,
      less what that imitates.
    - `family`: base law: `cavity` or `foundation`.
    - `z`: nuisances in stated standard deviations.
    - `instrument`: the instrument.
    - `more`: further facts for the record.
    """

    kind: str
    rig: Rig
    effects: tuple[Effect, ...]
    sizes: tuple[float, ...]
    family: str
    z: dict[str, float]
    instrument: Instrument
    more: dict[str, Any] = field(default_factory=dict)

    @property
    def mechanisms(self) -> tuple[str, ...]:
        """Names that a right verdict has; empty for a null and outside the library."""
        return tuple(e.name for e in self.effects if e.name in EFFECTS)

    def record(self) -> dict[str, Any]:
        """As plain values for the truth file."""
        return {
            "kind": self.kind,
            "mechanisms": list(self.mechanisms),
            "effects": [
                {"name": e.name, "form": e.form, "textbook": e.textbook, "numbers": e.numbers}
                for e in self.effects
            ],
            "sizes": list(self.sizes),
            "bench": self.rig.bench,
            "family": self.family,
            "nuisances": self.z,
            "strikers": [s.name for s in self.rig.strikers],
            "speeds": [float(np.min(self.rig.speed)), float(np.max(self.rig.speed))],
            "angles": [float(np.min(self.rig.angle)), float(np.max(self.rig.angle))],
            "instrument": {
                "shape": self.instrument.shape,
                "outliers": self.instrument.outliers,
                "missing": self.instrument.missing,
                "seed": self.instrument.seed,
            },
            **self.more,
        }


FAMILIES = {"cavity": CAVITY, "foundation": FOUNDATION}
"""The two families and the value of their base law."""


def draw(rng: np.random.Generator, kind: str, *, name: str = "") -> Truth:
    """Draw one case of a family.

    - `rng`: source of everything that is drawn.
    - `kind`: `null`, `single`, `pair` or `outside`.
    - `name`: the mechanism of a single, or the effect outside the library; drawn if empty.
    """
    family = str(rng.choice(list(FAMILIES)))
    z = draw_nuisances(rng) if rng.random() < 0.5 else {}
    instrument = draw_instrument(rng)
    if kind in PLANTED:
        return _planted(rng, kind, family, instrument)
    make = _maker(rng, family, z)
    if kind == "null":
        other = EFFECTS[str(rng.choice(list(EFFECTS)))]
        rig = make(str(rng.choice(other.benches)), ())
        return Truth(kind, rig, (), (), family, z, instrument, {**rig.metal_told})
    if kind == "pair":
        rig, effects, sizes = _pair(rng, family, z, make)
        seen = Visibility.of(rig, family=FAMILIES[family], z=z)
    else:
        rig, effects, sizes, seen = _single(rng, name, kind, family, z, make)
    # where its effects would be seen first
    more = {**rig.metal_told, "places": seen.places(seen.change(effects))}
    return Truth(kind, rig, effects, sizes, family, z, instrument, more)


def upright(rig: Rig) -> bool:
    """Whether every impact is normal."""
    return bool(np.all(rig.angle > 0.5 * np.pi - 1e-9)) and not np.any(rig.tangential)


Maker = Callable[[str, tuple[str, ...]], Rig]


def _maker(rng: np.random.Generator, family: str, z: dict[str, float]) -> Maker:
    """Return what draws a bench; half of all sets are of metals that are off perfect plasticity."""
    off = bool(rng.random() < 0.5)

    def make(bench: str, names: tuple[str, ...]) -> Rig:
        rig = told(rng, BENCHES[bench](rng), names)
        return draw_metal(rng, rig, family=FAMILIES[family], z=z) if off else rig

    return make


def told(rng: np.random.Generator, rig: Rig, names: tuple[str, ...]) -> Rig:
    """The bench with what its sheet tells beside bodies and trials, whatever acts there.

    A film is named only where a liquid is told, a plate's waves where a thickness is, what an
    approach loses where heights are; where these do not act, a sheet tells them all the same: the
    plate lies on a bed that holds it, the liquid was wiped off. No block is told on a bench that
    may move on its support: what moves there is lighter.
    """

    def tells(effect: str, share: float) -> bool:
        return bool(rng.random() < share) or effect in names

    yields = rig.law == "elastic-plastic"
    drop = tells("impact-speed-loss", HEIGHTS) and yields and upright(rig)
    wet = tells("squeeze-film", DECOYS) and rig.bench in EFFECTS["squeeze-film"].benches
    thin = yields and rig.bench in EFFECTS["half-space-waves"].benches
    plate = {"thickness_m": float(np.exp(rng.uniform(*np.log(_THIN))))}
    moves = rig.bench in EFFECTS["support-compliance"].benches
    block = {"thickness_m": BLOCK} if rng.random() < 0.5 and not moves else {}
    viscosity = min(float(np.exp(rng.uniform(*np.log(_LIQUID)))), _largest_viscosity(rig))
    thickness = plate if tells("half-space-waves", DECOYS) and thin else block
    return replace(rig, drop=drop, told=rig.told | thickness, liquid=viscosity if wet else 0.0)


def _largest_viscosity(rig: Rig) -> float:
    """Largest viscosity of a film that every ball leaves [Pa s]: the slowest loses half its speed.

    From 30 to 0.1 um a film takes 6 pi eta R^2 ln(300)/m of a speed; what stays in it does not
    rebound.
    """
    bodies = [rig.strikers[k] for k in rig.which]
    least = min(b.mass * v / b.tip_radius**2 for b, v in zip(bodies, rig.speed, strict=True))
    return float(0.5 * least / (6.0 * math.pi * math.log(300.0)))


def _planted(rng: np.random.Generator, kind: str, family: str, instrument: Instrument) -> Truth:
    """Nothing is missing, but a mass is stated 5 % off or the strength 14 %."""
    rig = told(rng, BENCHES[str(rng.choice(["rods-normal", "balls-normal"]))](rng), ())
    sign = float(rng.choice([-1.0, 1.0]))
    if kind == "mass-error":
        more = {"mass_factor": 1.0 + 0.05 * sign}
        return Truth(kind, rig, (), (), family, {}, instrument, more)
    rig = replace(rig, tolerance=rig.tolerance | {"strength": 0.05})
    return Truth(kind, rig, (), (), family, {"strength": 2.8 * sign}, instrument)


def draw_instrument(rng: np.random.Generator) -> Instrument:
    """Draw the shape of the noise, outliers and missing cells."""
    return Instrument(
        shape=str(rng.choice(["gaussian", "skewed", "heavy"], p=[0.4, 0.35, 0.25])),
        outliers=float(rng.choice([0.0, 0.01, 0.02])),
        missing=float(rng.choice([0.0, 0.03])),
        seed=int(rng.integers(2**31)),
    )


def draw_nuisances(rng: np.random.Generator) -> dict[str, float]:
    """Draw what differs from its stated value, in standard deviations within two."""
    return {name: float(np.clip(rng.normal(), -2.0, 2.0)) for name in NUISANCES}


def _single(
    rng: np.random.Generator, name: str, kind: str, family: str, z: dict[str, float], make: Maker
) -> tuple[Rig, tuple[Effect, ...], tuple[float, ...], Visibility]:
    table = EFFECTS if kind == "single" else OUTSIDE
    name = name or str(rng.choice(list(table)))
    law = FAMILIES[family]
    tried: list[tuple[float, tuple[Rig, tuple[Effect, ...], tuple[float, ...], Visibility]]] = []
    for _ in range(_RIGS):
        rig = make(str(rng.choice(table[name].benches)), (name,))
        seen = Visibility.of(rig, family=law, z=z)
        for _ in range(_DRAWS):
            effect = table[name].draw(rng, rig, law)
            whole = size = seen.size(seen.change([effect]))
            away = max(np.log(SEEN / max(whole, 1e-3)), np.log(whole / ENORMOUS + 1e-12), 0.0)
            if kind == "outside":
                size = beyond_library(rng, seen, effect) if away == 0.0 else whole
                away = max(away, np.log(BEYOND / max(size, 1e-3)))
            tried.append((float(away), (rig, (effect,), (size,), seen)))
            if away == 0.0:
                return tried[-1][1]
    return min(tried, key=lambda item: item[0])[1]


def _pair(
    rng: np.random.Generator, family: str, z: dict[str, float], make: Maker
) -> tuple[Rig, tuple[Effect, ...], tuple[float, ...]]:
    law = FAMILIES[family]
    tried: list[tuple[float, Rig, tuple[Effect, ...], tuple[float, ...]]] = []
    while len(tried) < _RIGS * _DRAWS:
        bench = str(rng.choice(["rods-normal", "balls-normal", "rods-oblique", "balls-oblique"]))
        able = [n for n, kind in EFFECTS.items() if bench in kind.benches]
        chosen = tuple(str(n) for n in rng.choice(able, 2, replace=False))
        if any(set(chosen) == seam for seam in _SAME_SEAM):
            continue
        rig = make(bench, chosen)
        effects = tuple(EFFECTS[n].draw(rng, rig, law) for n in chosen)
        sizes = tuple(
            size_of(rig, [e], family=law, z=z, keep=[o for o in effects if o is not e])
            for e in effects
        )
        low, high = min(sizes), max(sizes)
        away = max(np.log(BEYOND / max(low, 1e-3)), np.log(high / ENORMOUS), 0.0)
        tried.append((float(away), rig, effects, sizes))
        if away == 0.0:
            break
    _, rig, effects, sizes = min(tried, key=lambda item: item[0])
    return rig, effects, sizes


def readings_noise(rng: np.random.Generator, shape: str, count: int) -> Array:
    """Noise of unit variance and zero mean, shape (count,): gaussian, skewed or heavy-tailed."""
    if shape == "skewed":
        k = 3.0
        return np.asarray((rng.gamma(k, size=count) - k) / np.sqrt(k))
    if shape == "heavy":
        return np.asarray(rng.standard_t(5, size=count) * np.sqrt(3.0 / 5.0))
    return np.asarray(rng.normal(size=count))
