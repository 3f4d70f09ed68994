"""Checks of quasi-static presses: load against strength, what springs back against elasticity."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ...core.rig import BodyTable
from ..rules import RULES
from . import limits
from .findings import Finding, Severity
from .trial_view import TrialReading, TrialView, by_trial

LOAD_CLASS = 0.005
"""Relative standard deviation of a load stated without one [-]: class 1 of ISO 7500-1, 1 %."""


@by_trial
def check_press_load(view: TrialView) -> Iterator[Finding]:
    """Mean pressure, load over the dent's area, against the strength of the flat."""
    target = view.found.setup.target
    pressure = limits.hardness(target, view.striker) if target.yields else None
    area = _dent_area(view)
    if pressure is None or area is None:
        return
    low, high = RULES.mean_pressure
    # Sy_Pa alone says little of how a metal hardens
    high *= 1.0 if target.hardness_Pa is not None else RULES.hardened
    load = _load(view)
    p = load.value / area.value
    std = p * math.hypot(load.relative, area.relative, pressure.relative)
    z = max(low * pressure.value - p, p - high * pressure.value, 0.0) / max(std, 1e-12)
    yield Finding(
        f"load of {view.name} against the strength",
        Severity.CONTRADICTION if z > RULES.beyond else Severity.CONSISTENT,
        f"{load.value:.4g} N on the dent is a mean pressure of {p / 1e6:.4g} MPa, "
        f"{p / pressure.value:.2g} times the flat's {pressure.value / 1e6:.4g} MPa",
        p, pressure.value, z,
    )  # fmt: skip


@by_trial
def check_press_recovery(view: TrialView) -> Iterator[Finding]:
    """What springs back against Hertz's and a punch's recovery at the same load and radius."""
    back, modulus, radius = view.measured("recovered_depth_m"), _reduced(view), _radius(view)
    if back is None or math.isnan(modulus) or radius is None:
        return
    load = _load(view)
    scale = load.value / (modulus * radius.value)
    std = math.hypot(back.std, scale * math.hypot(load.relative, radius.relative, 0.05))
    low, high = (share * scale for share in RULES.recovery)
    z = max(low - back.value, back.value - high, 0.0) / std
    tail = ""
    if back.value > high and z > RULES.beyond:
        tail = ": is the machine's own compliance taken off?"
    yield Finding(
        f"recovery of {view.name} against elasticity",
        Severity.CONTRADICTION if z > RULES.beyond else Severity.CONSISTENT,
        f"{back.value * 1e6:.4g} um spring back, elastic bodies give {low * 1e6:.4g} to "
        f"{high * 1e6:.4g} um{tail}",
        back.value, 0.5 * (low + high), z,
    )  # fmt: skip


@by_trial
def check_press_depths(view: TrialView) -> Iterator[Finding]:
    """Depth under load against what stays and what springs back."""
    deepest, back = view.measured("press_depth_m"), view.measured("recovered_depth_m")
    left = view.measured("permanent_depth_m")
    weak = limits.clearly_softer(view.found.setup.target, view.striker)
    # a ball that is dented as well keeps a part of the approach
    if deepest is None or back is None or left is None or not weak:
        return
    z = (left.value + back.value - deepest.value) / math.hypot(left.std, back.std, deepest.std)
    yield Finding(
        f"depths of {view.name}",
        Severity.CONTRADICTION if abs(z) > RULES.beyond else Severity.CONSISTENT,
        f"{left.value * 1e6:.4g} um stay and {back.value * 1e6:.4g} um spring back of "
        f"{deepest.value * 1e6:.4g} um under load",
        left.value + back.value, deepest.value, abs(z),
    )  # fmt: skip


def _load(view: TrialView) -> TrialReading:
    load, std = (float(x[view.i]) for x in (view.found.trials.load_N, view.found.load_std))
    return TrialReading(load, LOAD_CLASS * load if np.isnan(std) else std)


def _dent_area(view: TrialView) -> TrialReading | None:
    """Area of the contact at the peak [m^2]: of the diameter, else of the permanent depth."""
    diameter = view.measured("dent_diameter_m")
    if diameter is not None:
        area = 0.25 * math.pi * diameter.value**2
        return TrialReading(area, 2.0 * diameter.relative * area)
    depth = view.measured("permanent_depth_m")
    if depth is None or depth.value <= 0.0 or view.parted:
        return None
    area = math.pi * limits.open_dent_radius(view.R, depth.value) ** 2
    # pile-up and recovery
    return TrialReading(area, math.hypot(depth.relative, 0.2) * area)


def _radius(view: TrialView) -> TrialReading | None:
    """Radius of the contact at the peak [m]."""
    diameter = view.measured("dent_diameter_m")
    if diameter is not None:
        return TrialReading(0.5 * diameter.value, 0.5 * diameter.std)
    deepest = view.measured("press_depth_m")
    if deepest is None:
        return None
    low, high = RULES.press_geometry
    a = limits.open_dent_radius(view.R, deepest.value)
    return TrialReading(0.5 * (low + high) * a, 0.25 * (high - low) * a)


def _reduced(view: TrialView) -> float:
    """Reduced modulus E' of the two bodies [Pa]; nan where one of them is not stated."""
    found = 0.0
    bodies: tuple[BodyTable, ...] = (view.found.setup.target, view.striker)
    for body in bodies:
        if body.E_Pa is None or body.nu is None:
            return math.nan
        found += (1.0 - body.nu.value**2) / body.E_Pa.value
    return 1.0 / found
