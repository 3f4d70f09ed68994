"""The library of impacts by dynamic finite elements, and the sets that are made from it.

`python -m dentscope.studies.proof.explicit.catalogue` computes the impacts that the file lacks,
one after the other; it may be stopped at any time. Each impact is kept with its description, so a
changed description is computed anew.
"""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field
from pathlib import Path

import h5py
import numpy as np

from ....core.provenance import content_id, environment
from ...concealed import Metal, Striker
from ..generators.benches import ALUMINIUM, BEARING_STEEL, BRASS, COPPER, MILD_STEEL
from . import solver as explicit
from .mesh import make_mesh

FILE = Path(__file__).resolve().parents[3] / "data" / "proof" / "explicit_impacts.h5"

VERSION = 2
"""To be raised when the numbers of the same description change."""


@dataclass(frozen=True)
class Series:
    """Bars on one block: the impacts of one concealed truth.

    Parameters
    ----------
    name
        Of the series; goes into the store only.
    target
        Material of the block.
    strikers
        The bars.
    speeds
        [m/s].
    kind
        `null`, `single`, `pair` or `outside`.
    effects
        Name of each effect and its numbers; rod waves need none, the bar is meshed anyhow.
    block
        Radius and thickness of the block [m].
    hold
        `bottom` or `rim`.
    """

    name: str
    target: Metal
    strikers: tuple[Striker, ...]
    speeds: tuple[float, ...]
    kind: str
    effects: dict[str, dict[str, float]] = field(default_factory=dict)
    block: tuple[float, float] = (0.03, 0.03)
    hold: str = "bottom"


def _slug(name: str, tip: float, radius: float, length: float) -> Striker:
    return Striker(name, BEARING_STEEL, tip, radius, length)


_SLUGS = (_slug("slug-s", 4e-3, 2.5e-3, 7e-3), _slug("slug-l", 9e-3, 4.5e-3, 12e-3))
_WIDE = (_slug("slug-m", 9e-3, 6e-3, 20e-3), _slug("slug-w", 12e-3, 8e-3, 25e-3))
_BARS = (_slug("bar-60", 9e-3, 4.5e-3, 60e-3), _slug("bar-150", 9e-3, 4.5e-3, 150e-3))
_MORE = (_slug("slug-n", 6e-3, 3e-3, 9e-3), _slug("slug-x", 15e-3, 6e-3, 16e-3))
_V = (0.5, 1.0, 2.0, 4.0)
_SLOW = (0.3, 0.6, 1.2, 2.4)

SERIES: tuple[Series, ...] = (
    Series("null-steel", MILD_STEEL, _SLUGS, _V, "null"),
    Series("null-aluminium", ALUMINIUM, _MORE, _V, "null"),
    Series(
        "rate-steel", MILD_STEEL, _SLUGS, _V, "single",
        {"strain-rate-hardening": {"C": 0.025, "reference": 1.0}},
    ),
    Series("bars-steel", MILD_STEEL, _BARS, _V, "single", {"rod-longitudinal-waves": {}}),
    Series(
        "voce-steel", MILD_STEEL, _SLUGS, _V, "single",
        {"work-hardening": {"rise": 0.8, "strain": 0.04}},
    ),
    Series(
        "softening-steel", MILD_STEEL, _SLUGS, _V, "outside",
        {"strain-softening": {"rise": -0.45, "strain": 0.02}},
    ),
    Series(
        "layer-steel", MILD_STEEL, _SLUGS, _V, "single",
        {"hardened-layer": {"rise": 1.2, "thickness": 0.15e-3}},
    ),
    Series(
        "plate-aluminium", ALUMINIUM, _WIDE, _SLOW, "single",
        {"half-space-waves": {"thickness": 0.008}}, block=(0.06, 0.008), hold="rim",
    ),
    Series(
        "pad-steel", MILD_STEEL, _WIDE, _SLOW, "single",
        {"support-compliance": {"pad": 0.004, "pad_E": 2e8}}, block=(0.022, 0.022),
    ),
    Series(
        "cut-steel", MILD_STEEL, _WIDE, _SLOW, "single", {"truncated-tip": {"radius": 0.45e-3}}
    ),
    Series(
        "crushed-aluminium", ALUMINIUM, _MORE, _V, "outside",
        {"crushed-layer": {"rise": -0.6, "thickness": 0.12e-3}},
    ),
    Series(
        "bars-rate-steel", MILD_STEEL, _BARS, _V, "pair",
        {"rod-longitudinal-waves": {}, "strain-rate-hardening": {"C": 0.04, "reference": 1.0}},
    ),
    Series(
        "rate-copper", COPPER, _MORE, _V, "single",
        {"strain-rate-hardening": {"C": 0.05, "reference": 1.0}},
    ),
    Series("bars-aluminium", ALUMINIUM, _BARS, _V, "single", {"rod-longitudinal-waves": {}}),
    Series(
        "voce-copper", COPPER, _MORE, _V, "single",
        {"work-hardening": {"rise": 1.5, "strain": 0.08}},
    ),
    Series("null-brass", BRASS, _WIDE, _SLOW, "null"),
)  # fmt: skip
"""All series, in the order in which they are computed; each impact is a striker at a speed."""

DIVISIONS = 9
"""Elements over the contact radius that is expected."""


def description(series: Series, striker: Striker, speed: float) -> dict[str, object]:
    """What is computed, as plain values."""
    return {
        "version": VERSION, "divisions": DIVISIONS, "speed": speed, "striker": asdict(striker),
        "target": asdict(series.target), "effects": series.effects, "block": list(series.block),
        "hold": series.hold,
    }  # fmt: skip


def impacts() -> Iterator[tuple[Series, Striker, float, str]]:
    """Every impact of the library: series, striker, speed, content id."""
    for series in SERIES:
        for striker in series.strikers:
            for speed in series.speeds:
                text = json.dumps(description(series, striker, speed))
                yield series, striker, speed, content_id(text)[:16]


def _numbers(metal: Metal) -> list[float]:
    shear = metal.E / (2.0 * (1.0 + metal.nu))
    return [metal.density, shear, metal.E / (3.0 * (1.0 - 2.0 * metal.nu)), 0.0, 1.0, 0.0, 1.0]


def compute(
    series: Series, striker: Striker, speed: float, *, divisions: int = DIVISIONS
) -> dict[str, object]:
    """Compute one impact.

    Returns
    -------
    dict
        `restitution`, `contact_time_s`, `peak_force_N`, `permanent_depth_m`, `mass_kg`, `momentum`
        (impulse over change of momentum), `vibration` (share of the first energy left in the bar),
        `steps`, `parted`, `cpu_s` and `history` (k, 3).
    """
    effects = series.effects
    metal, other = series.target, striker.metal
    E = 1.0 / ((1.0 - metal.nu**2) / metal.E + (1.0 - other.nu**2) / other.E)
    scale = max(
        (15.0 * striker.mass * speed**2 / (16.0 * math.sqrt(striker.tip_radius) * E)) ** 0.4,
        speed * math.sqrt(striker.mass / (2.0 * math.pi * striker.tip_radius * 2.8 * metal.Sy)),
    )
    cut = effects.get("truncated-tip", {}).get("radius", 0.0)
    a = math.sqrt(2.0 * striker.tip_radius * scale + cut * cut)
    pad = effects.get("support-compliance", {})
    mesh = make_mesh(
        tip_radius=striker.tip_radius, bar_radius=striker.radius, bar_length=striker.length,
        tip_flat=cut, block_radius=series.block[0], block_thickness=series.block[1],
        pad=pad.get("pad", 0.0), fine=a / divisions, reach=1.4 * a, hold=series.hold,
    )  # fmt: skip
    rubber = Metal("pad", pad.get("pad_E", 1e9), 0.4, math.inf, 1200.0)
    materials = np.array([_numbers(other), _numbers(metal), _numbers(rubber)])
    rate = effects.get("strain-rate-hardening")
    if rate:
        materials[1, explicit.RATE] = rate["C"]
        materials[1, explicit.REFERENCE] = rate["reference"]
    voce = effects.get("work-hardening") or effects.get("strain-softening")
    if voce:
        materials[1, explicit.RISE], materials[1, explicit.STRAIN] = voce["rise"], voce["strain"]
    base = np.full(len(mesh.quads), 1e30)
    block = mesh.body == 1
    base[block] = min(metal.Sy, 1e30)
    layer = effects.get("hardened-layer") or effects.get("crushed-layer")
    if layer:
        depth = -mesh.x[mesh.quads[block], 1].mean(axis=1)
        base[block] *= 1.0 + layer["rise"] * np.exp(-depth / layer["thickness"])
    history = np.zeros((400, 3))
    settle = max(16.0 * a / 5000.0 + 4e-6, 2.2 * striker.length / 5100.0)
    start = time.process_time()
    found = explicit.strike(
        mesh.x.copy(), mesh.quads, mesh.body, mesh.tip, mesh.top, mesh.held, materials, base, speed,
        5e-3, settle, history,
    )  # fmt: skip
    return {
        "restitution": found.rebound / speed, "contact_time_s": found.duration,
        "peak_force_N": found.peak, "permanent_depth_m": found.depth, "mass_kg": found.mass,
        "momentum": found.impulse / (found.mass * (speed + found.rebound)),
        "vibration": found.vibration / (0.5 * found.mass * speed**2), "steps": found.steps,
        "parted": found.parted,
        "elements": len(mesh.quads), "cpu_s": time.process_time() - start,
        "history": history[:found.rows].astype(np.float32),
    }  # fmt: skip


def fill(path: Path = FILE) -> Iterator[str]:
    """Compute what is lacking, each impact on disk before the next begins; yield a line each."""
    wanted = list(impacts())
    for number, (series, striker, speed, key) in enumerate(wanted):
        with h5py.File(path, "a") as store:
            if key in store:
                continue
        found = compute(series, striker, speed)
        with h5py.File(path, "a") as store:
            group = store.create_group(key)
            group.create_dataset("history", data=found.pop("history"), compression="gzip")
            group["history"].attrs["columns"] = "time [s], force [N], height of the bar [m]"
            for name, value in found.items():
                group.attrs[name] = value
            group.attrs["series"] = series.name
            group.attrs["striker"] = striker.name
            group.attrs["description"] = json.dumps(description(series, striker, speed))
            group.attrs["environment"] = json.dumps(environment())
        yield (
            f"{number + 1}/{len(wanted)} {series.name} {striker.name} {speed} m/s: "
            f"e {found['restitution']:.4f}, {found['cpu_s']:.1f} s"
        )


def stored(path: Path = FILE) -> int:
    """Number of impacts in the library."""
    if not path.exists():
        return 0
    with h5py.File(path, "r") as store:
        return len(store)


if __name__ == "__main__":
    for text in fill():
        sys.stderr.write(text + "\n")
