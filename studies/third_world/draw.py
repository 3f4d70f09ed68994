"""One concealed set: rig, metal, errors of the sheet, effects large enough to be seen."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...core.arrays import Array
from .benches import BENCHES, TOLERANCE, Rig
from .contact import Law
from .effects import EFFECTS, OUTSIDE, Effect, tip_of
from .motion import blows, presses
from .physics import Physics, physics_of

NULLS = ("balls", "rods", "balls-aslant", "rods-aslant", "elastic", "small", "drops", "heated",
         "pressed", "plateau", "beads")  # fmt: skip
"""Kinds of rig that a null is drawn from, in turn."""

PAIRS = (
    ("balls", "strain-rate-hardening", "squeeze-film"),
    ("balls", "half-space-waves", "work-hardening"),
    ("balls", "support-compliance", "impact-speed-loss"),
    ("rods", "truncated-tip", "rod-longitudinal-waves"),
    ("rods-aslant", "tilt", "rod-flexural-vibration"),
    ("rods-aslant", "ploughing-friction", "tilt"),
    ("balls-aslant", "tangential-compliance", "velocity-dependent-friction"),
    ("small", "size-effect", "roughness"),
)
"""Rig and effects of each pair."""

SEEN = (5.0, 80.0)
"""Sizes between which an effect is kept; else the nearest of a few draws."""

_RIGS, _TRIES = 2, 3
"""How many rigs are tried, and draws of the effects on each: few rigs, since a rig that was chosen
for what acts on it says what acts."""

_DECOYS, _HEIGHTS, _OTHER = 0.5, 0.3, 0.3
"""Shares of the sheets that state a liquid, or a thin plate, where one could act; heights; and a
block, or a gauge of the depths."""

_SPREAD = {"hardness": 0.02, "meyer": 0.015, "pile": 0.03, "unloading": 0.08, "fall": 0.1}
"""Standard deviations by which a metal's dents differ from the mean of metals: fractions of the
hardness and of the edge, else numbers."""


@dataclass(frozen=True)
class Truth:
    """What a set conceals: its kind, rig, metal, effects with their sizes, errors of the sheet."""

    kind: str
    rig: Rig
    law: Law
    effects: tuple[Effect, ...]
    sizes: tuple[float, ...]
    z: dict[str, float]
    seed: int

    def record(self) -> dict[str, Any]:
        """As plain values."""
        return {
            "kind": self.kind, "mechanisms": [e.name for e in self.effects if e.name in EFFECTS],
            "effects": [vars(e) for e in self.effects], "sizes": list(self.sizes),
            "bench": self.rig.bench, "nuisances": self.z, "seed": self.seed,
            "law": {k: getattr(self.law, k) for k in _SPREAD},
        }  # fmt: skip


def draw(
    rng: np.random.Generator, kind: str, name: str, *, tries: int = _RIGS * _TRIES
) -> Truth:  # fmt: skip
    """Draw a set.

    - `rng`: source of everything.
    - `kind`: `null`, `single`, `pair` or `outside`.
    - `name`: rig of a null, effect of a single or of what is outside, both of a pair with a plus.
    - `tries`: draws of which the one nearest to a size that is seen is kept.
    """
    tried: list[tuple[float, Truth]] = []
    names = [] if kind == "null" else name.split("+")
    kinds = [(EFFECTS | OUTSIDE)[n] for n in names]
    for turn in range(tries if names else 1):
        law = metal(rng)
        z = {k: float(np.clip(rng.normal(), -2.0, 2.0)) for k in TOLERANCE}
        z = z if rng.random() < 0.6 else {}
        if turn % _TRIES == 0:
            benches = [b for b, *both in PAIRS if both == names] or [
                str(rng.choice(k.benches)) for k in kinds
            ]
            rig = as_stated(rng, BENCHES[benches[0] if names else name](rng), names)
        effects = tuple(k.draw(rng, rig) for k in kinds)
        sizes = tuple(size_of(rig, law, z, effects, without=e) for e in effects)
        truth = Truth(kind, rig, law, effects, sizes, z, int(rng.integers(2**31)))
        away = max(
            (max(math.log(SEEN[0] / max(s, 1e-3)), math.log(max(s, 1e-3) / SEEN[1]), 0.0)
             for s in sizes), default=0.0,
        )  # fmt: skip
        tried.append((away, truth))
        if away == 0.0:
            break
    return min(tried, key=lambda item: item[0])[1]


def metal(rng: np.random.Generator) -> Law:
    """Draw a metal, some per cent off the mean of metals."""
    mean = Law()
    off = {k: s * float(np.clip(rng.normal(), -1.5, 1.5)) for k, s in _SPREAD.items()}
    return Law(
        hardness=mean.hardness * (1.0 + off["hardness"]), meyer=mean.meyer + off["meyer"],
        pile=mean.pile * (1.0 + off["pile"]), unloading=mean.unloading + off["unloading"],
        fall=mean.fall + off["fall"],
    )  # fmt: skip


def as_stated(rng: np.random.Generator, rig: Rig, names: Sequence[str]) -> Rig:
    """What a sheet says more: all that lets an effect be named, whether it acts or not.

    Where they do not act, the plate lies on a bed that holds it and the liquid was wiped off.
    """

    def tells(effect: str, share: float) -> bool:
        told = bool(rng.random() < share) or effect in names
        return told and rig.bench in EFFECTS[effect].benches

    gauge = {"permanent_depth_m": 0.04} if rng.random() < _OTHER else {}
    fluid = float(np.exp(rng.uniform(*np.log((0.05, 1.0)))))
    plate = 2.0 * tip_of(rig) * float(np.exp(rng.uniform(*np.log((0.4, 1.6)))))
    # what moves on its support is lighter than a block
    moves = rig.bench in EFFECTS["support-compliance"].benches
    block = {"thickness_m": 0.2} if rng.random() < _OTHER and not moves else {}
    thin = tells("half-space-waves", _DECOYS) and rig.bench != "elastic"
    return replace(
        rig, heights=rig.heights or tells("impact-speed-loss", _HEIGHTS),
        gauge=gauge if "permanent_depth_m" in rig.noise else {},
        told={"thickness_m": float(np.round(plate, 4))} if thin else block,
        fluid=fluid if tells("squeeze-film", _DECOYS) else 0.0,
    )  # fmt: skip


def acting(p: Physics, effects: Sequence[Effect]) -> Physics:
    """Put effects into blows."""
    for effect in effects:
        (EFFECTS | OUTSIDE)[effect.name].put(p, effect)
    return p


def readings(
    rig: Rig, law: Law, z: dict[str, float], effects: Sequence[Effect],
    release: Array | None = None,
) -> dict[str, Array]:  # fmt: skip
    """What perfect instruments read, by column, (n,) each, NaN where there is nothing to read."""
    struck = rig.load == 0.0
    found = {k: np.full(len(struck), np.nan) for k in rig.noise}
    for rows, read in ((struck, blows), (~struck, presses)):
        if np.any(rows):
            for k, column in read(acting(_rows(rig, law, z, rows, release), effects)).items():
                if k in found:
                    found[k][rows] = column
    return found


def _rows(rig: Rig, law: Law, z: dict[str, float], rows: Array, release: Array | None) -> Physics:
    some = {k: getattr(rig, k)[rows] for k in ("which", "angle", "speed", "temperature", "load")}
    return physics_of(replace(rig, **some), law, z, None if release is None else release[rows])


def size_of(
    rig: Rig, law: Law, z: dict[str, float], effects: Sequence[Effect], *, without: Effect
) -> float:
    """Norm of what one effect changes, over the noise, less what the sheet and a metal imitate."""
    key = np.stack([rig.which, rig.angle, rig.speed, rig.temperature, rig.load], axis=1)
    _, first, counts = np.unique(key, axis=0, return_index=True, return_counts=True)
    some = {k: getattr(rig, k)[first] for k in ("which", "angle", "speed", "temperature", "load")}
    few = replace(rig, **some)
    rest = [e for e in effects if e is not without]

    def flat(law: Law, z: dict[str, float], acts: Sequence[Effect]) -> Array:
        return np.concatenate(list(readings(few, law, z, acts).values()))

    plain = flat(law, z, rest)
    base = dict(zip(few.noise, np.split(plain, len(few.noise)), strict=True))
    std = np.concatenate([np.hypot(n, f * base[k]) for k, (n, f) in few.noise.items()])
    weight = np.nan_to_num(np.sqrt(np.tile(counts, len(few.noise))) / std)
    stated = ("strength", "modulus", "speed")
    moved = [flat(law, z | {k: z.get(k, 0.0) + 1.0}, rest) for k in stated]
    moved += [flat(replace(law, **{k: getattr(law, k) + d}), z, rest)
              for k, d in (("meyer", 0.03), ("unloading", 0.12), ("pile", 0.1))]  # fmt: skip
    J = np.nan_to_num(np.stack([(m - plain) * weight for m in moved], axis=1))
    e = np.nan_to_num((flat(law, z, effects) - plain) * weight)
    inner = np.linalg.solve(np.eye(J.shape[1]) + J.T @ J, J.T @ e)
    return math.sqrt(max(float(e @ e - (J.T @ e) @ inner), 0.0))
