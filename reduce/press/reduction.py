"""A press from load and depth: its depths and its stiffness, each with what it assumed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError
from ...core.tables import counted
from ..measured import ZERO, Measured, Trial
from ..rules import RULES
from ..shared.regression import unit_covariance
from .columns import PressRecord
from .curve import contact_zero, left_depth, stiffness
from .cycles import Cycle, cycles_of, noise_of

# limit: way in the air at least, in that of the whole record [-]; a preload creeps less
_AIR = 0.05


@dataclass(frozen=True)
class ReducedPress:
    """One press: its cycle, and its largest load [N].

    `left` and `deepest` are the depth that stays and that under the largest load, from the zero of
    contact, `recovered` what the unloading gives back, `crept` what came while the load was held
    [m]; `stiffness` the slope of the unloading where it begins, without the machine's as far as
    known [N/m].
    """

    cycle: Cycle
    load: Measured
    left: Measured
    deepest: Measured
    recovered: Measured
    stiffness: Measured
    crept: float

    @property
    def stays(self) -> bool:
        """Whether the depth that stays is seen beyond its error."""
        return self.left.value > 2.0 * self.left.std

    def values(self) -> dict[str, Measured]:
        """What was measured, by name."""
        return {
            "load_N": self.load, "permanent_depth_m": self.left, "press_depth_m": self.deepest,
            "recovered_depth_m": self.recovered, "unloading_stiffness_N_m": self.stiffness,
        }  # fmt: skip


@dataclass(frozen=True)
class PressReduction:
    """All presses of a record in the order of time, and what was assumed.

    `depth` (n,) is without the machine's compliance [m], `zero` that of the first contact in it
    [m], `compliance` the machine's [m/N], none where nothing tells it.
    """

    record: PressRecord
    depth: Array
    zero: Measured
    compliance: Measured | None
    presses: tuple[ReducedPress, ...]
    notes: tuple[str, ...]

    @property
    def largest(self) -> ReducedPress:
        """The press with the largest load."""
        return max(self.presses, key=lambda p: p.load.value)

    def trial(self, press: ReducedPress, label: str) -> Trial:
        """Return the row of a press: what hangs on an unknown compliance is left out of it."""
        seen = {"load_N": press.load}
        if press.stays:
            seen["permanent_depth_m"] = press.left
        if self.compliance is not None:
            seen |= {"press_depth_m": press.deepest, "recovered_depth_m": press.recovered}
        return Trial(seen, label=label)


def reduce_press(
    record: PressRecord, *, compliance: Measured | None, load_std: float
) -> PressReduction:
    """Return what a record shows of each press; refuse one without a whole press.

    `compliance` is the machine's, still in the depth [m/N]; none takes the file's, or that of
    several cycles. `load_std` is of the largest load [N].
    """
    noise = noise_of(record.load)
    record, tare = _tared(record, noise)
    load, cycles = record.load, cycles_of(record)
    notes = [f"the load cell shows {tare:.4g} N in the air: taken off"] if tare else []
    slopes = [stiffness(load, record.depth, c) for c in cycles]
    whole = min((1.0 / s.value for s in slopes if s.value > 0.0), default=math.inf)
    if compliance is not None and not compliance.value < whole:
        raise InputError(
            f"{compliance.value:g} m/N, and all that is pressed gives way by {whole:.3g} m/N",
            source=record.source, key="machine_compliance_m_N",
            allowed="less than the whole; 0 where the machine has taken it off",
        )  # fmt: skip
    if compliance is None and record.stated is not None:
        said = f"the file states a machine compliance of {record.stated:.4g} m/N"
        if record.stated < whole:
            compliance = Measured(record.stated, 0.0)
            notes.append(f"{said}: taken off (--machine-compliance-m-N 0 if it has been)")
        else:
            notes.append(f"{said}, and all gives way by {whole:.4g} m/N: not in it, or wrong")
    if compliance is None:
        compliance = _from_cycles(cycles, slopes)
        if compliance is not None:
            notes.append(
                f"machine compliance {compliance} m/N from the slopes of {len(cycles)} cycles: "
                "taken off; the mean pressure is the same in all, or rises as Meyer's index says"
            )
    if compliance is None:
        notes.append(
            "the machine's own compliance is not known: press_depth_m, recovered_depth_m and the "
            "stiffness hold it and make no row; --machine-compliance-m-N states it (0: taken off)"
        )
    own = compliance or ZERO
    depth = record.depth - own.value * load
    zero = contact_zero(load, depth, max(cycles, key=lambda c: c.peak), noise)
    notes.append(f"contact begins {zero.scaled(1e6)} um after the record's zero of depth")
    presses = tuple(
        _press(load, depth, c, s, zero, own, load_std * c.peak / max(load), noise)
        for c, s in zip(cycles, slopes, strict=True)
    )
    notes += _told(record, presses)
    return PressReduction(record, depth, zero, compliance, presses, tuple(notes))


def _tared(record: PressRecord, noise: float) -> tuple[PressRecord, float]:
    """Return a record without the load before the touch, and that load; 0 where none is seen.

    In the air the depth moves and the load does not; a preload that is held only creeps.
    """
    load, depth = record.load, record.depth
    level = float(np.median(load[: RULES.fewest_level_samples]))
    touched = np.flatnonzero(np.abs(load - level) > RULES.pulse_over_noise * max(noise, 1e-12))
    air = int(touched[0]) if touched.size else 0
    far = air and np.ptp(depth[:air]) > _AIR * np.ptp(depth)
    if air < RULES.fewest_level_samples or not far or abs(level) <= 2.0 * noise:
        return record, 0.0
    level = float(np.median(load[:air]))
    return replace(record, load=load - level), level


def _press(
    load: Array, depth: Array, cycle: Cycle, slope: Measured, zero: Measured, own: Measured,
    load_std: float, noise: float,
) -> ReducedPress:  # fmt: skip
    top = slice(cycle.begin, max(cycle.turn, cycle.begin) + 1)
    under = Measured(float(depth[top].max()), noise_of(depth))
    end = left_depth(load, depth, cycle, noise)
    # what the machine's error moves, it moves in proportion to the load
    machine = own.std * cycle.peak
    contact = slope
    if own.value and slope.value > 0.0 and 1.0 / slope.value > own.value:
        soft = Measured(1.0 / slope.value, slope.std / slope.value**2).minus(own)
        contact = Measured(1.0, 0.0).over(soft)
    held = top.start + np.flatnonzero(load[top] >= cycle.peak - 4.0 * noise)
    return ReducedPress(
        cycle, Measured(cycle.peak, load_std), end.minus(zero),
        under.minus(zero).widened(machine), under.minus(end).widened(machine), contact,
        float(depth[held[-1]] - depth[held[0]]) if held.size > 1 else 0.0,
    )  # fmt: skip


def _from_cycles(cycles: tuple[Cycle, ...], slopes: list[Measured]) -> Measured | None:
    """Return the machine's compliance from cycles of several loads [m/N].

    1/S = C + c P^(-1/m): a contact is as stiff as it is wide, and P is as a^m (Oliver and Pharr,
    eq. 15, with Meyer's index m for the 2 of a pyramid).
    """
    whole = [
        (c.peak, s.value) for c, s in zip(cycles, slopes, strict=True)
        if c.beyond and s.value > 0.0 and s.std < 0.1 * s.value
    ]  # fmt: skip
    if len(whole) < RULES.fewest_cycles:
        return None
    peak, slope = np.array(whole).T
    if peak.max() < RULES.cycle_ratio * peak.min():
        return None
    found = []
    for index in RULES.meyer:
        design = np.stack([np.ones(peak.size), peak ** (-1.0 / index)], axis=1)
        weight = slope[:, None]  # slopes are as good as each other in parts of themselves
        best = np.linalg.lstsq(design * weight, np.ones(peak.size), rcond=None)[0]
        rest = design @ best * slope - 1.0
        sigma = math.sqrt(float(rest @ rest) / (peak.size - 2))
        found.append((best[0], sigma * math.sqrt(unit_covariance(design * weight)[0, 0])))
    (first, first_std), (second, second_std) = found
    middle = 0.5 * (first + second)
    std = math.hypot(max(first_std, second_std), 0.5 * (first - second))
    return Measured(max(float(middle), 0.0), std)


def _told(record: PressRecord, presses: tuple[ReducedPress, ...]) -> list[str]:
    largest = max(presses, key=lambda p: p.load.value)
    told = []
    if record.missed:
        told.append(f"left out, without a load or a depth: {counted(record.missed, 'row')}")
    if len(presses) > 1:
        told.append(
            f"{len(presses)} cycles; what the row says is of the largest, as if it were the only: "
            "earlier, smaller ones leave no trace in it where nothing creeps"
        )
    least = largest.cycle.least
    if least > RULES.zero_reach[0]:
        told.append(f"unloaded to {least:.0%} of the load: the rest is made up from the unloading")
    if abs(largest.crept) > 0.005 * largest.deepest.value:
        told.append(f"{largest.crept * 1e6:.3g} um came while the load was held: part of the depth")
    if not largest.stays:
        told.append(f"no depth that stays is seen: {largest.left.scaled(1e6)} um")
    return told
