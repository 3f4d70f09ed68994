"""Instants at which a sound sets in, to a fraction of a millisecond.

A rise of the energy within a millisecond over that of the milliseconds before finds each event; the
place at which the two sides of the record differ most in their variance (the information criterion
of Maeda 1985, used for the first arrivals of earthquakes) is its onset.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.signal import butter, find_peaks, sosfilt

from ...core.arrays import Array
from ..rules import RULES
from .file import Sound


@dataclass(frozen=True)
class Onsets:
    """Events in a record of sound: onsets and their deviations [s], rises [dB], (n,)."""

    time: Array
    std: Array
    rise_db: Array


def find_onsets(
    sound: Sound, *, least_rise_db: float, least_interval: float, lowest_hz: float
) -> Onsets:
    """Return the onsets of a record: rises of at least so many dB, so many seconds apart.

    Frequencies below `lowest_hz` are taken out first; the filter runs forward only, so that no
    event is heard before it happens.
    """
    rate = sound.rate
    edge = min(lowest_hz, 0.2 * rate)
    heard = sosfilt(butter(4, edge, "highpass", fs=rate, output="sos"), sound.samples)
    rise = _rise_db(heard, rate)
    peaks, _ = find_peaks(rise, height=least_rise_db, distance=max(1, round(least_interval * rate)))
    time, std = np.array([_pick(heard, int(p), rate) for p in peaks]).reshape(-1, 2).T
    order = np.argsort(time)
    return Onsets(time[order], std[order], rise[peaks][order])


def _rise_db(heard: Array, rate: float) -> Array:
    """Energy just after each sample over that just before, (n,) [dB]."""
    total = np.concatenate([[0.0], np.cumsum(heard**2)])
    n = heard.size
    after = max(2, round(RULES.onset_after * rate))
    before = max(4, round(RULES.onset_before * rate))
    here = np.arange(n)
    ahead, behind = np.minimum(here + after, n), np.maximum(here - before, 0)
    energy = (total[ahead] - total[here]) / np.maximum(ahead - here, 1)
    past = (total[here] - total[behind]) / np.maximum(here - behind, 1)
    # digital silence would make any click infinitely loud
    floor = max(float(np.quantile(past, 0.1)), 1e-10 * float(np.max(energy)), 1e-30)
    rise: Array = 10.0 * np.log10(np.maximum(energy, floor) / np.maximum(past, floor))
    rise[: before // 2] = 0.0
    return rise


def _pick(heard: Array, peak: int, rate: float) -> tuple[float, float]:
    """Onset near a sample and its standard deviation [s]."""
    first = max(peak - round(RULES.onset_search[0] * rate), 0)
    part = heard[first : peak + round(RULES.onset_search[1] * rate)]
    n = part.size
    k = np.arange(4, n - 4)
    if k.size < 4:
        return peak / rate, RULES.onset_after
    sums, squares = np.cumsum(part), np.cumsum(part**2)
    tiny = 1e-12 * squares[-1] / n + 1e-300
    left = squares[k - 1] / k - (sums[k - 1] / k) ** 2
    rest = n - k
    right = (squares[-1] - squares[k - 1]) / rest - ((sums[-1] - sums[k - 1]) / rest) ** 2
    criterion = k * np.log(np.maximum(left, tiny)) + rest * np.log(np.maximum(right, tiny))
    weight = np.exp(-0.5 * (criterion - criterion.min()))
    weight /= weight.sum()
    mean = float(weight @ k)
    std = float(np.sqrt(weight @ (k - mean) ** 2))
    return (first + mean) / rate, float(np.hypot(std, 0.5)) / rate
