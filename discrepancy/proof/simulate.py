"""From a bench, nuisances and effects to the numbers that a perfect instrument would read."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from . import dynamics
from . import parameters as at
from .effects import EFFECTS, OUTSIDE, Effect
from .rig import COLUMNS, NUISANCES, Rig

Array = NDArray[np.float64]


def rows_of(
    rig: Rig, effects: Sequence[Effect], *, family: float, z: dict[str, float],
    speed: Array | None = None, steps: int = 1200,
) -> Array:  # fmt: skip
    """Parameters of all impacts with their effects, shape (n, N_PARAMETERS).

    Parameters
    ----------
    rig, effects
        The bench and what acts on it.
    family
        Base law.
    z
        Nuisances in standard deviations.
    speed
        (n,) factor on each trial's speed: what the release really did.
    steps
        Time steps per depth over speed.
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


def noise_std(rig: Rig, clean: dict[str, Array]) -> dict[str, Array]:
    """Standard deviation of the instrument at these values, by column, each (n,)."""
    return {
        name: np.hypot(number, fraction * np.abs(clean[name]))
        for name, (number, fraction) in rig.noise.items()
    }


def size_of(
    rig: Rig, effects: Sequence[Effect], *, family: float, z: dict[str, float],
    keep: Sequence[Effect] = (),
) -> float:  # fmt: skip
    """Norm of the effect over the noise, after what the nuisances can imitate is taken out.

    With e the change of all readings over their noise, and J its derivatives with respect to the
    nuisances in prior standard deviations: sqrt(e' (1 + J J')^-1 e). Repeats are identical here.

    Parameters
    ----------
    rig, family, z
        As for `rows_of`.
    effects
        What acts.
    keep
        What acts in both impacts that are compared.
    """
    few, counts = _distinct(rig)
    with_it = _stacked(few, [*keep, *effects], family, z)
    without = _stacked(few, keep, family, z)
    clean = {name: column for name, column in zip(few.noise, without, strict=True)}
    std = np.concatenate(list(noise_std(few, clean).values()))
    weight = np.sqrt(np.tile(counts, len(few.noise))) / std
    e = (np.concatenate(with_it) - np.concatenate(without)) * weight
    e[~np.isfinite(e)] = 0.0
    columns = []
    for name in NUISANCES:
        if rig.tolerance[name] == 0.0:
            continue
        step = 0.5
        high = _stacked(few, keep, family, z | {name: z.get(name, 0.0) + step})
        low = _stacked(few, keep, family, z | {name: z.get(name, 0.0) - step})
        column = (np.concatenate(high) - np.concatenate(low)) / (2.0 * step) * weight
        columns.append(np.nan_to_num(column))
    J = np.stack(columns, axis=1)
    inner = np.linalg.solve(np.eye(J.shape[1]) + J.T @ J, J.T @ e)
    return float(np.sqrt(max(e @ e - (J.T @ e) @ inner, 0.0)))


def _distinct(rig: Rig) -> tuple[Rig, Array]:
    """The bench with each condition once, and how often it was repeated."""
    from dataclasses import replace

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
