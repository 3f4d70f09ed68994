"""What a set conceals: drawn from a seed, never shown to the diagnosing process."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ....core.arrays import Array
from .benches import BENCHES
from .effects import EFFECTS, OUTSIDE, Effect, Kind
from .metals import draw_metal
from .parameters import CAVITY, FOUNDATION
from .rig import NUISANCES, Rig
from .simulate import Visibility, size_beyond_library, size_of

NULL_BENCHES = (
    "rods-normal", "rods-oblique", "balls-normal", "balls-oblique", "balls-small", "balls-elastic",
    "balls-drops", "rods-angles",
)  # fmt: skip

HEIGHTS = 0.3
"""Share of the nulls with normal impacts whose sheet states heights in place of speeds."""

SEEN, ENORMOUS = 4.0, 80.0
"""Sizes between which a drawn effect is kept at once; else the nearest of several draws."""

BEYOND = 10.0
"""Size of what nothing else imitates, from which an effect is kept at once: outside the library of
what that leaves, in a pair of what the other effect's numbers leave."""

PLANTED = ("mass-error", "strength-error")
"""Kinds of case in which a stated value is wrong by more than its tolerance allows."""

_DRAWS = 8
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

    Parameters
    ----------
    kind
        `null`, `single`, `pair` or `outside`.
    rig
        The bench.
    effects
        What acts; empty for a null.
    sizes
        Size of each effect, less what the numbers of others imitate; outside the library, less
        what that imitates.
    family
        Base law: `cavity`, `foundation` or `explicit`.
    z
        Nuisances in stated standard deviations.
    instrument
        The instrument.
    more
        Further facts for the record.
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
"""The two fast families and the value of their base law."""


def draw(
    rng: np.random.Generator, kind: str, *, name: str = "", off: bool | None = None, bench: str = ""
) -> Truth:
    """Draw one case of a fast family.

    Parameters
    ----------
    rng
        Source of everything that is drawn.
    kind
        `null`, `single`, `pair` or `outside`.
    name
        The mechanism of a single, or the effect outside the library; drawn if empty.
    off
        Whether materials and geometry differ from what is stated; drawn if left out.
    bench
        The bench of a null; drawn if empty.
    """
    family = str(rng.choice(list(FAMILIES)))
    z = draw_nuisances(rng) if (rng.random() < 0.5 if off is None else off) else {}
    instrument = draw_instrument(rng)
    if kind in PLANTED:
        return _planted(rng, kind, family, instrument)
    make = _maker(rng, family, z)
    if kind == "null":
        rig = make(bench or str(rng.choice(NULL_BENCHES)))
        if rig.law == "elastic-plastic" and upright(rig) and rng.random() < HEIGHTS:
            rig = replace(rig, drop=True)
        return _told(Truth(kind, rig, (), (), family, z, instrument))
    if kind == "pair":
        rig, effects, sizes = _pair(rng, family, z, make)
        return _told(Truth(kind, rig, effects, sizes, family, z, instrument))
    table = EFFECTS if kind == "single" else OUTSIDE
    name = name or str(rng.choice(list(table)))
    rig, effect, size = _single(rng, name, table[name], family, z, make)
    return _told(Truth(kind, rig, (effect,), (size,), family, z, instrument))


def upright(rig: Rig) -> bool:
    """Whether every impact is normal."""
    return bool(np.all(rig.angle > 0.5 * np.pi - 1e-9)) and not np.any(rig.tangential)


Maker = Callable[[str], Rig]


def _maker(rng: np.random.Generator, family: str, z: dict[str, float]) -> Maker:
    """Return what draws a bench; half of all sets are of metals that are off perfect plasticity."""
    off = bool(rng.random() < 0.5)

    def make(bench: str) -> Rig:
        rig = BENCHES[bench](rng)
        return draw_metal(rng, rig, family=FAMILIES[family], z=z) if off else rig

    return make


def _told(case: Truth) -> Truth:
    """The same with what its metal is, and where its effects would be seen first, on record."""
    more: dict[str, Any] = {**case.rig.metal_told}
    if case.effects:
        seen = Visibility.of(case.rig, family=FAMILIES[case.family], z=case.z)
        more["places"] = seen.places(seen.change(case.effects))
    return replace(case, more=case.more | more)


def _planted(rng: np.random.Generator, kind: str, family: str, instrument: Instrument) -> Truth:
    """Nothing is missing, but a mass is stated 5 % off or the strength 14 %."""
    rig = BENCHES[str(rng.choice(["rods-normal", "balls-normal"]))](rng)
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


def _prepared(make: Maker, bench: str, names: tuple[str, ...]) -> Rig:
    """The bench with what a user would write down when such an effect is possible there."""
    rig = make(bench)
    if "impact-speed-loss" in names:
        rig = replace(rig, drop=True)
    return rig


def _single(
    rng: np.random.Generator, name: str, kind: Kind, family: str, z: dict[str, float], make: Maker
) -> tuple[Rig, Effect, float]:
    tried: list[tuple[float, Rig, Effect, float]] = []
    for _ in range(_DRAWS):
        rig = _prepared(make, str(rng.choice(kind.benches)), (name,))
        effect = kind.draw(rng, rig, FAMILIES[family])
        law, away = FAMILIES[family], 0.0
        if name in OUTSIDE:
            whole, size = size_beyond_library(rng, rig, effect, family=law, z=z)
            away = np.log(BEYOND / max(size, 1e-3))
        else:
            whole = size = size_of(rig, [effect], family=law, z=z)
        away = max(
            np.log(SEEN / max(whole, 1e-3)), np.log(whole / ENORMOUS + 1e-12), away, 0.0
        )  # fmt: skip
        tried.append((float(away), rig, effect, size))
        if away == 0.0:
            break
    _, rig, effect, size = min(tried, key=lambda item: item[0])
    return rig, effect, size


def _pair(
    rng: np.random.Generator, family: str, z: dict[str, float], make: Maker
) -> tuple[Rig, tuple[Effect, ...], tuple[float, ...]]:
    law = FAMILIES[family]
    tried: list[tuple[float, Rig, tuple[Effect, ...], tuple[float, ...]]] = []
    while len(tried) < _DRAWS:
        bench = str(rng.choice(["rods-normal", "balls-normal", "rods-oblique", "balls-oblique"]))
        able = [n for n, kind in EFFECTS.items() if bench in kind.benches]
        chosen = tuple(str(n) for n in rng.choice(able, 2, replace=False))
        if any(set(chosen) == seam for seam in _SAME_SEAM):
            continue
        rig = _prepared(make, bench, chosen)
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
