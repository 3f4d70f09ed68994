"""Three contact laws with drawn constants, levelled to a reference curve.

* cut-off: Hertz's force up to a limiting pressure, then a straight line
  (C. Thornton, J. Appl. Mech. 64 (1997) 383)
* logarithmic: past yield (2x - 1)[1 + ln(2x - 1)/3.3] of the force there, x = depth over that of
  first yield, until the pressure stops growing (W. J. Stronge, Impact Mechanics, 2000, chapter 6)
* series: the depth is the sum of Hertz's and of a plastic dent's, each under the same force

Constants of such laws are chosen to fit; so level and slope follow the reference but for a drawn
offset, and the shape between is the law's own, drawn together where it strays farther from the
reference than the reference is known to be off.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...core.arrays import Array, Mask

# limit: depths of a null law [-]; time
_DEPTHS = 120

KINDS = ("cut-off", "logarithmic", "series")


@dataclass(frozen=True, eq=False)
class NullCurve:
    """A law of one contact as tables over the depth, for fast evaluation of many impacts.

    - `log_depth`: (k,) equally spaced logarithms [ln m].
    - `log_force`, `recovery`, `crater`, `radius`: (k,) loading force [ln N]; elastic recovery and
      crater depth after a peak there, radius of the contact [m].
    - `power`: exponent of the recovery.
    """

    log_depth: Array
    log_force: Array
    recovery: Array
    crater: Array
    radius: Array
    power: float


@dataclass(frozen=True, eq=False)
class NullReference:
    """The baseline's curve of one contact: what a law is levelled to.

    - `R`, `E`, `Y`: radius [m], reduced modulus [Pa], strength of the weaker body [Pa] (inf:
      elastic).
    - `depth`, `force`, `recovery`, `crater`, `radius`: (k,) at depths of a wide range [m, N, m, m,
      m].
    - `lost`: (k,) share of the work that the baseline keeps: laws differ by a part of that.
    - `given_back`: share of the elastic work that returns, for bodies without a yield strength.
    - `low`, `high`: depths between which the impacts of this contact move [m].
    """

    R: float
    E: float
    Y: float
    depth: Array
    force: Array
    recovery: Array
    crater: Array
    radius: Array
    lost: Array
    given_back: float = 1.0
    low: float = 0.0
    high: float = math.inf


@dataclass(frozen=True, slots=True)
class Draw:
    """Constants of one null law.

    - `kind`: one of `KINDS`.
    - `a`, `b`, `c`: shape constants, uniform in (0, 1).
    - `level`, `back`: logarithmic offset and slope over ln(depth) of force and of recovery.
    - `power`: offset of the recovery's exponent.
    - `stray`: largest rms distance of the shapes of force and of recovery from the reference
      (logarithm).
    - `dent`, `wide`: as `level`, of the crater and of the contact's radius at a force.
    """

    kind: str
    a: float
    b: float
    c: float
    level: tuple[float, float]
    back: tuple[float, float]
    power: float
    stray: tuple[float, float] = (math.inf, math.inf)
    dent: tuple[float, float] = (0.0, 0.0)
    wide: tuple[float, float] = (0.0, 0.0)


def draw(rng: np.random.Generator, size: dict[str, float]) -> Draw:
    """Draw a law; `size` holds the standard deviations of the levels, and of the size of all."""
    kind = KINDS[int(rng.integers(len(KINDS)))]
    a, b, c = (float(x) for x in rng.random(3))
    drawn = [
        (rng.normal(0.0, size.get(k, 0.0)), rng.normal(0.0, size.get(f"{k} slope", 0.0)))
        for k in ("force", "recovery", "crater", "radius")
    ]
    times = math.exp(rng.normal(0.0, size.get("size", 0.0)))
    level, back, dent, wide = ((times * x, times * slope) for x, slope in drawn)
    stray = times * size.get("force shape", math.inf), times * size.get("recovery shape", math.inf)
    power = float(rng.uniform(-0.1, 0.1))
    return Draw(kind, a, b, c, level, back, power, stray, dent, wide)


def curve(reference: NullReference, law: Draw) -> NullCurve:
    """Tabulate a law for one contact, levelled to the reference over its range of depths."""
    low, high = reference.low, reference.high
    x = np.linspace(math.log(low) - 6.0, math.log(high) + 1.0, _DEPTHS)
    d = np.exp(x)
    known = np.log(reference.depth)
    base = np.interp(x, known, np.log(reference.force))
    recovery = np.exp(np.interp(x, known, np.log(reference.recovery)))
    crater = np.interp(x, known, reference.crater / reference.depth) * d
    radius = np.exp(np.interp(x, known, np.log(reference.radius)))
    inside = (x >= math.log(low)) & (x <= math.log(high))
    middle = 0.5 * (math.log(low) + math.log(high))
    if math.isinf(reference.Y):
        f = _levelled(base, base, x, inside, middle, law.level, math.inf)
        # without yield the way back is the way in
        return NullCurve(x, f, recovery, crater, radius, 1.5 + law.level[1])
    force, power, rec = _shape(reference, law, d)
    f = _levelled(np.log(force), base, x, inside, middle, law.level, law.stray[0])
    own = _levelled(np.log(rec), np.log(recovery), x, inside, middle, law.back, law.stray[1])
    # where little is left, laws differ by a part of that, not by a part of the recovery
    kept = np.interp(x, known, reference.lost)
    part = np.minimum(kept / max(float(np.sqrt(np.mean(kept[inside] ** 2))), 1e-3), 2.0)
    f = base + part * (f - base)
    rec = recovery * np.exp(part * (own - np.log(recovery)))
    rec = np.minimum(rec, 0.999 * d)
    # what does not recover stays; the crater's share of it is the reference's
    left = np.maximum(d - recovery, 1e-12)
    crater = np.maximum(d - rec, 0.0) * np.clip(crater / left, 0.0, 1.0)
    far = np.clip(x, x[inside][0], x[inside][-1]) - middle
    crater = crater * np.exp(law.dent[0] + law.dent[1] * far)
    # at one pressure the contact that carries more is wider
    radius = radius * np.exp(0.5 * (f - base) + law.wide[0] + law.wide[1] * far)
    return NullCurve(x, f, rec, crater, radius, power)


def _levelled(
    own: Array, base: Array, x: Array, inside: Mask, middle: float,
    offset: tuple[float, float], stray: float,
) -> Array:  # fmt: skip
    """Turn a logarithmic curve so that it follows the base but for the offset and its shape."""
    line = np.polynomial.polynomial.polyfit(x[inside] - middle, (base - own)[inside], 1)
    far = np.clip(x, x[inside][0], x[inside][-1]) - middle
    shape = own - base + line[0] + line[1] * far
    rms = float(np.sqrt(np.mean(shape[inside] ** 2)))
    if rms > stray:
        shape = shape * (stray / rms)
    return np.asarray(base + shape + offset[0] + offset[1] * far)


def _shape(reference: NullReference, law: Draw, d: Array) -> tuple[Array, float, Array]:
    """Return loading force, exponent and recovery of a law before levelling."""
    R, E, Y = reference.R, reference.E, reference.Y
    hertz = 4.0 / 3.0 * E * math.sqrt(R) * d**1.5
    pressure = (1.4 + 0.5 * law.a) * Y if law.kind == "logarithmic" else (2.0 + 0.7 * law.a) * Y
    first = R * (math.pi * pressure / (2.0 * E)) ** 2
    at_first = 4.0 / 3.0 * E * math.sqrt(R) * first**1.5
    grown = 1.0 + (0.3 + 0.6 * law.b) * d / (d + 25.0 * first)
    if law.kind == "cut-off":
        force = np.where(d <= first, hertz, at_first + math.pi * R * pressure * (d - first))
        power, give = 1.5, 0.75
    elif law.kind == "logarithmic":
        x = np.maximum(2.0 * d / first - 1.0, 1.0)
        growth = np.minimum(1.0 + np.log(x) / 3.3, 1.9 + 0.4 * law.c)
        force = np.where(d <= first, hertz, at_first * x * growth)
        power, give = 1.4 + law.power, 0.72
    else:
        force = _in_series(hertz, d, first, 2.0 * math.pi * R * (2.4 + 0.6 * law.c) * Y)
        power, give = 1.5 + law.power, 0.7
    return force, power, give * force / (E * np.sqrt(R * d * grown))


def _in_series(hertz: Array, d: Array, first: float, stiffness: float) -> Array:
    """Force at which Hertz's depth and a dent's, softened at its start, add up to d."""
    f = np.exp(np.linspace(math.log(hertz[0]), math.log(hertz[-1]), 4 * _DEPTHS))
    elastic = np.exp(np.interp(np.log(f), np.log(hertz), np.log(d)))
    start = float(np.interp(first, d, hertz))
    dent = f / stiffness * (1.0 - np.exp(-((f / (2.0 * start)) ** 0.7)))
    return np.asarray(np.exp(np.interp(np.log(d), np.log(elastic + dent), np.log(f))))
