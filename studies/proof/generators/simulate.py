"""From a bench, nuisances and effects to the numbers that a perfect instrument would read."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize

from ....core.arrays import Array
from . import dynamics
from . import parameters as at
from .effects import EFFECTS, OUTSIDE, Effect
from .metal_kinds import TYPICAL, other_metals
from .rig import COLUMNS, NUISANCES, RATIOS, Rig


def rows_of(
    rig: Rig, effects: Sequence[Effect], *, family: float, z: dict[str, float],
    speed: Array | None = None, steps: int = 1200,
) -> Array:  # fmt: skip
    """Parameters of all impacts with their effects, shape (n, N_PARAMETERS).

    - `rig`, `effects`: the bench and what acts on it.
    - `family`: base law.
    - `z`: nuisances in standard deviations.
    - `speed`: (n,) factor on each trial's speed: what the release really did.
    - `steps`: time steps per depth over speed.
    """
    p = rig.rows(family, z, steps=steps)
    if speed is not None:
        p[:, at.NORMAL_SPEED] *= speed
        p[:, at.TANGENTIAL_SPEED] *= speed
    for effect in effects:
        kind = EFFECTS.get(effect.name) or OUTSIDE[effect.name]
        kind.put(p, rig, effect)
    return p


def results_of(p: Array) -> Array:
    """All results of the impacts, shape (n, N_RESULTS)."""
    out = np.zeros((len(p), at.N_RESULTS))
    dynamics.impacts(p, out)
    return out


def observables(rig: Rig, p: Array) -> dict[str, Array]:
    """The recorded columns of a perfect instrument, each of shape (n,)."""
    out = results_of(p)
    return {name: out[:, COLUMNS[name]] for name in rig.noise}


def how_far_off(plain: dict[str, Array], changed: dict[str, Array]) -> float:
    """Largest rms logarithmic change of the restitution or the dent, of those recorded."""
    changes = [
        np.log(np.maximum(changed[k], 1e-12) / np.maximum(plain[k], 1e-12))
        for k in ("restitution", "permanent_depth_m")
        if k in plain
    ]
    return max((float(np.sqrt(np.mean(c**2))) for c in changes), default=0.0)


def noise_std(rig: Rig, clean: dict[str, Array]) -> dict[str, Array]:
    """Standard deviation of the instrument at these values, by column, each (n,)."""
    return {
        name: np.hypot(number, fraction * np.abs(clean[name]))
        for name, (number, fraction) in rig.noise.items()
    }


UNKNOWN = 1.0
"""Standard deviation of the logarithm of an effect's numbers, of which nobody is told."""
_MOVED = 0.05  # of the same, for derivatives
_COUNTS = ("elements", "seed")  # numbers that say nothing of physics


def _numbers_moved(effects: Sequence[Effect]) -> Iterator[list[Effect]]:
    """Yield the effects with one number a little larger each time."""
    for i, one in enumerate(effects):
        for key, value in one.numbers.items():
            if key in _COUNTS or value == 0.0:
                continue
            more = replace(one, numbers=one.numbers | {key: value * math.exp(_MOVED)})
            yield [*effects[:i], more, *effects[i + 1 :]]


@dataclass(frozen=True, eq=False)
class Visibility:
    """How large changes of a rig's readings look, with what else may change them taken out.

    With e a change of all readings over their noise, and J their derivatives with respect to the
    nuisances, to what a metal may be off perfect plasticity and to the numbers of what acts in all
    impacts, in prior standard deviations, the size is sqrt(e' (1 + J J')^-1 e).

    - `rig`: each condition once.
    - `family`, `z`, `keep`: base law, nuisances, and what acts in all impacts that are compared.
    - `plain`, `weight`: (m,) readings without more, and one over the noise of their repeats' mean.
    - `J`: (m, k) derivatives over the noise.
    """

    rig: Rig
    family: float
    z: dict[str, float]
    keep: tuple[Effect, ...]
    plain: Array
    weight: Array
    J: Array

    @classmethod
    def of(
        cls, rig: Rig, *, family: float, z: dict[str, float], keep: Sequence[Effect] = ()
    ) -> Visibility:
        """Simulate what is needed."""
        few, counts = _distinct(rig)
        readings = _stacked(few, keep, family, z)
        clean = dict(zip(few.noise, readings, strict=True))
        std = np.concatenate(list(noise_std(few, clean).values()))
        weight = np.sqrt(np.tile(counts, len(few.noise))) / std
        columns = []
        for name in NUISANCES:
            if rig.tolerance[name] == 0.0:
                continue
            step = 0.5
            high = _stacked(few, keep, family, z | {name: z.get(name, 0.0) + step})
            low = _stacked(few, keep, family, z | {name: z.get(name, 0.0) - step})
            column = (np.concatenate(high) - np.concatenate(low)) / (2.0 * step) * weight
            columns.append(np.nan_to_num(column))
        plain = np.concatenate(readings)
        for other in other_metals(few, family):
            changed = dict(zip(few.noise, _stacked(other, keep, family, z), strict=True))
            off = how_far_off(clean, changed)
            if off > 0.0:
                change = (np.concatenate(list(changed.values())) - plain) * weight
                columns.append(np.nan_to_num(TYPICAL / off * change))
        for effects in _numbers_moved(keep):
            moved = np.concatenate(_stacked(few, effects, family, z))
            columns.append(np.nan_to_num((moved - plain) * weight * UNKNOWN / _MOVED))
        return cls(few, family, z, tuple(keep), plain, weight, np.stack(columns, axis=1))

    def change(self, effects: Sequence[Effect]) -> Array:
        """Change of the readings by effects, over the noise, shape (m,)."""
        there = np.concatenate(_stacked(self.rig, [*self.keep, *effects], self.family, self.z))
        e = (there - self.plain) * self.weight
        e[~np.isfinite(e)] = 0.0
        return e

    def size(self, e: Array) -> float:
        """Return the size of a change (m,)."""
        inner = np.linalg.solve(np.eye(self.J.shape[1]) + self.J.T @ self.J, self.J.T @ e)
        return math.sqrt(max(float(e @ e - (self.J.T @ e) @ inner), 0.0))

    def places(self, e: Array) -> list[tuple[str, str, float]]:
        """Where a change (m,) shows: observable, condition or "overall", and score; largest first.

        A contrast is a constant over the readings of one observable, or over their ratios to those
        without the effect, or a slope of these along a condition that varies, each weighted by how
        sure it is; its score is what the change has along it over the standard deviation that
        noise, nuisances and metals have there. An observable that does not change has no score.
        """
        rig, n = self.rig, len(self.rig)
        bodies = [rig.strikers[k] for k in rig.which]
        along = {
            "impact speed": np.log(rig.speed), "rod length": np.array([b.length for b in bodies]),
            "tip radius": np.log([b.tip_radius for b in bodies]),
            "striker mass": np.log([b.mass for b in bodies]), "angle": rig.angle,
            "tangential speed": rig.tangential, "temperature": rig.temperature,
        }  # fmt: skip
        total = np.eye(len(e)) + self.J @ self.J.T
        spread = np.diag(total)
        found = []
        for k, name in enumerate(rig.noise):
            here = slice(k * n, (k + 1) * n)
            weight = self.weight[here]
            if name in RATIOS:
                weight = weight * np.abs(self.plain[here])
            sure = weight**2 / spread[here]
            shapes = {"overall": np.ones(n)}
            shapes |= {
                c: x - np.average(x, weights=sure) for c, x in along.items() if np.ptp(x) > 1e-6
            }
            for condition, x in shapes.items():
                contrast = np.zeros(len(e))
                contrast[here] = x * weight / spread[here]
                size = math.sqrt(float(contrast @ total @ contrast))
                found.append((name, condition, abs(float(contrast @ e)) / size))
        return sorted(found, key=lambda place: -place[2])


def size_of(
    rig: Rig, effects: Sequence[Effect], *, family: float, z: dict[str, float],
    keep: Sequence[Effect] = (),
) -> float:  # fmt: skip
    """Norm of the effect over the noise, after what the nuisances can imitate is taken out.

    `rig`, `family`, `z`: as for `rows_of`; `effects`: what acts; `keep`: what acts in both impacts
    that are compared; its numbers are unknown.
    """
    seen = Visibility.of(rig, family=family, z=z, keep=keep)
    return seen.size(seen.change(effects))


# draws of each imitator, how many of the nearest are improved, and by how many steps
_SAMPLES, _POLISHED, _STEPS = 12, 2, 60


def beyond_library(rng: np.random.Generator, seen: Visibility, effect: Effect) -> float:
    """Size of what is left of an effect after any one of the library has imitated it.

    A layer that crushes may look like a blunt tip to every instrument of the set; then no name is
    wrong. The imitators are the generator's own: draws of each effect that the bench can show, the
    nearest of them improved by a simplex search in their numbers.

    `seen`: the rig, and what else may change its readings; `effect`: one of `OUTSIDE`.
    """
    wanted = seen.change([effect])
    least = seen.size(wanted)
    tried: list[tuple[float, int, Effect]] = []
    for name in _able(seen.rig):
        draws = [EFFECTS[name].draw(rng, seen.rig, seen.family) for _ in range(_SAMPLES)]
        # a bar or beam has no numbers that matter, and costs much
        for one in draws[: 1 if "elements" in draws[0].numbers else _SAMPLES]:
            tried.append((seen.size(wanted - seen.change([one])), len(tried), one))
    for size, _, one in sorted(tried)[:_POLISHED]:
        keys = [k for k, v in one.numbers.items() if k not in _COUNTS and v > 0.0]
        first = np.log([one.numbers[k] for k in keys])

        def left(x: Array, one: Effect = one, keys: list[str] = keys) -> float:
            numbers = one.numbers | dict(zip(keys, np.exp(x).tolist(), strict=True))
            return seen.size(wanted - seen.change([replace(one, numbers=numbers)]))

        found = minimize(left, first, method="Nelder-Mead", options={"maxfev": _STEPS})
        least = min(least, size, float(found.fun))
    return least


def _able(rig: Rig) -> list[str]:
    """Effects of the library that the bench can show, as its sheet is."""
    lacking = {
        "impact-speed-loss": not rig.drop, "squeeze-film": not rig.liquid,
        "half-space-waves": rig.law == "elastic-plastic" and "thickness_m" not in rig.told,
    }  # fmt: skip
    return [
        n for n, kind in EFFECTS.items() if rig.bench in kind.benches and not lacking.get(n, False)
    ]


def _distinct(rig: Rig) -> tuple[Rig, Array]:
    """The bench with each condition once, and how often it was repeated."""
    key = np.stack([rig.which, rig.angle, rig.speed, rig.tangential, rig.temperature], axis=1)
    _, first, counts = np.unique(key, axis=0, return_index=True, return_counts=True)
    some = {
        name: getattr(rig, name)[first]
        for name in ("which", "angle", "speed", "tangential", "temperature")
    }
    return replace(rig, **some), counts.astype(float)


def _stacked(
    rig: Rig, effects: Sequence[Effect], family: float, z: dict[str, float]
) -> list[Array]:
    p = rows_of(rig, effects, family=family, z=z, steps=600)
    return list(observables(rig, p).values())
