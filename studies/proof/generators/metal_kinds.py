"""How metals differ from elastic-perfect plasticity: kinds, and the numbers that say how far."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from . import parameters as at
from .rig import Rig

MOST = {"etsion-unloading": 1.0, "chord-modulus": 0.35, "flow-curve": 0.45}
"""Weight of another law, fall of the modulus, rise of a flow curve: as far as real metals go."""
TYPICAL = 0.05
"""By so much, in the rms of restitution or dent, is a metal off that nothing is said of."""

_STRAIN, _STEP = 0.02, 0.3  # strain over which a modulus falls; step, as a part of the most


def numbers(kind: str, size: float, strain: float) -> dict[int, float]:
    """Return the parameters of a metal of one kind, by their places."""
    if kind == "etsion-unloading":
        return {at.OTHER_UNLOADING: size}
    if kind == "chord-modulus":
        return {at.CHORD: size, at.CHORD_STRAIN: strain}
    # shape of the tension test of 6061-T6 by Cady at 0.001/s: a rise that is over at 10 %
    return {at.CURVE: size, at.CURVE_STRAIN: 0.033}


def kinds(family: float) -> list[str]:
    """Return the kinds that a base law can take."""
    return ["chord-modulus", "flow-curve"] + ["etsion-unloading"] * (family == at.CAVITY)


def other_metals(rig: Rig, family: float) -> Iterator[Rig]:
    """Yield the bench with metals that are a step farther off, one of each kind."""
    if np.isinf(rig.target.Sy):
        return
    for kind in kinds(family):
        more = numbers(kind, _STEP * MOST[kind], _STRAIN)
        size, *_ = more
        more[size] += rig.metal.get(size, 0.0)
        yield replace(rig, metal={**more, **{k: v for k, v in rig.metal.items() if k != size}})
