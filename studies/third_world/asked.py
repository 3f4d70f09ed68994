"""Further trials of a concealed set: what the same rig, metal and instruments show when asked.

An answer hangs on the set's seed, the trial and how often it was asked before, on nothing else.
"""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ...core.arrays import Array
from .benches import READ, Rig
from .draw import Truth, readings
from .sheet import (
    HEIGHT,
    RELEASE,
    SIGNED,
    SPEED,
    Instrument,
    drawn,
    noise_of,
    released,
    seen,
    table,
)

PRESSED = ("permanent_depth_m", "dent_diameter_m")
"""What is read of a press where the set has had none."""


class Asked(NamedTuple):
    """A trial: striker, normal speed [m/s], angle [degrees], temperature [K]; a load is of a press.

    A press has no speed [N].
    """

    striker: str
    speed: float
    angle: float = 90.0
    temperature: float = 293.0
    load: float = 0.0


def answer(
    truth: Truth, asked: Sequence[Asked], *, before: Sequence[Asked] = ()
) -> list[list[str]]:
    """Return rows of trials.csv with their header.

    `asked`: what is asked, in the order of testing; `before`: what was asked of it before.
    """
    rig, n = truth.rig, len(truth.rig.which)
    rng, settings = released(truth)
    by = {k: drawn(rng, rig, k, n)[0] for k in rig.noise}
    noise = dict(rig.noise)
    new = [k for k in PRESSED if any(x.load for x in asked) and k not in noise]
    noise |= {k: READ[k] for k in new}
    wide = _with(replace(rig, noise=noise), asked)
    count = Counter(before)
    draws = []
    for one in asked:
        draws.append(np.random.default_rng(_seed(truth, f"{tuple(one)} {count[one]}")))
        count[one] += 1
    known = dict(zip(rig.speed.tolist(), settings.release.tolist(), strict=True))
    release, stated = (np.array(x) for x in zip(*(
        _released(truth, one, r, known if rig.heights else {})
        for one, r in zip(asked, draws, strict=True)
    ), strict=True))  # fmt: skip
    found = readings(wide, truth.law, truth.z, truth.effects,
                     np.concatenate([settings.release, release]))  # fmt: skip
    read: dict[str, Array] = {}
    for k, column in found.items():
        tool = by.get(k, Instrument("gaussian", 1.0, 1.0))
        off = [float(noise_of(r, 1)[tool.shape][0]) * tool.spread for r in draws]
        read[k] = seen(tool, np.concatenate([np.zeros(n), off]), noise[k], column)
        read[k] = read[k] if k in SIGNED else np.where(read[k] > 0.0, read[k], np.nan)
        if k in new:
            read[k][wide.load == 0.0] = np.nan
            read[f"{k}_std"] = np.hypot(noise[k][0], noise[k][1] * read[k])
    rows = np.arange(n, n + len(asked))
    speed = np.concatenate([settings.stated, stated])
    return table(wide, speed, read, rows, first=n + len(before) + 1)


def _with(rig: Rig, asked: Sequence[Asked]) -> Rig:
    """The rig with further rows: what acts may hang on all of its bodies."""
    names = [s.name for s in rig.strikers]
    more: dict[str, Any] = {
        "which": np.array([names.index(x.striker) for x in asked], dtype=np.intp),
        "angle": np.radians([x.angle for x in asked]),
        "speed": np.array([x.speed for x in asked]),
        "temperature": np.array([x.temperature for x in asked]),
        "load": np.array([x.load for x in asked]),
    }
    whole: dict[str, Any] = {k: np.concatenate([getattr(rig, k), x]) for k, x in more.items()}
    return replace(rig, **whole)


def _released(
    truth: Truth, one: Asked, rng: np.random.Generator, known: dict[float, float]
) -> tuple[float, float]:
    """Factor on the speed, and the speed that is stated."""
    if one.load > 0.0:
        return 1.0, 0.0
    if truth.rig.heights:
        at = np.random.default_rng(_seed(truth, f"height {one.speed:.4g}"))
        return known.get(one.speed, 1.0 + 0.5 * HEIGHT * float(at.normal())), one.speed
    release = 1.0 + RELEASE * float(rng.normal())
    return release, one.speed * release * (1.0 + SPEED * float(rng.normal()))


def _seed(truth: Truth, what: str) -> int:
    digest = hashlib.sha256(f"{truth.seed}/{what}".encode()).digest()
    return int.from_bytes(digest[:16], "little")


def possible(rig: Rig) -> dict[str, tuple[float, float]]:
    """Return ranges of speeds [m/s], angles [degrees] and loads [N] of what may be asked."""
    struck = rig.load == 0.0
    deep = [math.pi * (x * b.tip_radius) ** 2 for b in rig.strikers for x in (0.05, 0.25)]
    found = {
        "speed": (float(rig.speed[struck].min()), float(rig.speed[struck].max())),
        "angle": (math.degrees(rig.angle.min()), math.degrees(rig.angle.max())),
    }
    if math.isfinite(rig.flat.Sy):
        loads = np.clip([2.6 * rig.flat.Sy * x for x in deep], 20.0, 5000.0).tolist()
        loads += rig.load[~struck].tolist()
        found["load"] = (min(loads), max(loads))
    return found


def begun(rng: np.random.Generator, rig: Rig, *, most: int) -> Rig:
    """Return what a first session has of a rig's trials: conditions at random until it is full."""
    columns = ("which", "angle", "speed", "temperature", "load")
    settings = np.stack([getattr(rig, k) for k in columns], axis=1)
    group = np.unique(settings, axis=0, return_inverse=True)[1].ravel()
    rows: list[int] = []
    for one in rng.permutation(int(group.max()) + 1):
        more = np.flatnonzero(group == one).tolist()
        if len(rows) + len(more) <= most:
            rows += more
    return replace(rig, **{k: getattr(rig, k)[sorted(rows)] for k in columns})
