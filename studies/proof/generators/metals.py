"""Metals that are not elastic-perfectly plastic: drawn so far off that readings show it.

Real metals are: a flow curve that rises, a modulus of unloading that falls with plastic strain, an
unloading that follows another law. None of it is missing physics: the sheet states a 0.2 % proof
strength, and the tool must know that its law is a law and not the metal.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .metal_kinds import MOST, kinds, numbers
from .rig import Rig
from .simulate import how_far_off, observables, rows_of

OFF = (0.03, 0.08)
"""Between which the rms change of restitution, or of the dent where that is larger, is drawn."""

_FEW = 600  # time steps per depth over speed
_SEEN = ("restitution", "permanent_depth_m")


def draw_metal(rng: np.random.Generator, rig: Rig, *, family: float, z: dict[str, float]) -> Rig:
    """Return a bench whose metal is some way off elastic-perfect plasticity, and says how.

    `rig`, `family`, `z`: as for `simulate.rows_of`.
    """
    if np.isinf(rig.target.Sy):
        return rig
    wanted = float(rng.uniform(*OFF))
    strain = float(np.exp(rng.uniform(np.log(0.01), np.log(0.04))))
    found = rig
    for kind in rng.permutation(kinds(family)):
        found = _this_far(rig, str(kind), strain, wanted, family=family, z=z)
        if float(found.metal_told["metal_off"]) > OFF[0]:
            break
    return found


def _this_far(
    rig: Rig, kind: str, strain: float, wanted: float, *, family: float, z: dict[str, float]
) -> Rig:  # fmt: skip
    """The bench with a metal of one kind that is so far off, or as far as real ones go."""
    size, off, changed = 0.1, 0.0, rig
    for _ in range(5):
        changed = replace(rig, metal=numbers(kind, size, strain))
        off = _off(rig, changed, family, z)
        if abs(off / wanted - 1.0) < 0.1:
            break
        size = float(np.clip(size * wanted / max(off, 1e-4), 1e-3, MOST[kind]))
    told: dict[str, float | str] = {
        "metal": kind, "metal_size": size, "metal_strain": strain, "metal_off": off
    }  # fmt: skip
    return replace(changed, metal_told=told)


def _off(rig: Rig, changed: Rig, family: float, z: dict[str, float]) -> float:
    """Largest rms logarithmic change of an observable that any of these benches may record."""
    seen = [
        observables(replace(r, noise=dict.fromkeys(_SEEN, (0.0, 0.0))),
                    rows_of(r, (), family=family, z=z, steps=_FEW))
        for r in (rig, changed)
    ]  # fmt: skip
    return how_far_off(*seen)
