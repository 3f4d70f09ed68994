"""Stored cases as objects: what a campaign file's groups and the rows of published parts become."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import numpy.typing as npt

from ..core.errors import InputError
from .case import Case
from .quality import Quality, quality_of
from .schema import CURVE, PROFILES, UNLOADING_PROFILES, Dataset

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class UnloadingRecord:
    """One stored unloading; see `campaigns.schema` for units."""

    depth: float
    curve: dict[str, Floats]
    residual_sphere: float
    residual_flat: float
    profiles: dict[str, Floats]


@dataclass(frozen=True)
class CaseRecord:
    """One stored case.

    Parameters
    ----------
    id
        Case id.
    case
        Its specification.
    status
        `done` or `failed`.
    message
        Why it failed; empty when done.
    curve
        Loading results by name, shape (n,), SI (see `campaigns.schema.CURVE`).
    unloadings
        In the order of their depth.
    profiles
        Contact pressure and surfaces by name (see `campaigns.schema.PROFILES`).
    counters
        Work that the solve took.
    accuracy
        Settings that it was solved with: finer than the specification's after a retry.
    environment
        Versions and commit that computed it.
    mesh
        Digest of its mesh.
    """

    id: str
    case: Case
    status: str
    message: str
    curve: dict[str, Floats]
    unloadings: tuple[UnloadingRecord, ...]
    profiles: dict[str, Floats]
    counters: dict[str, float]
    accuracy: dict[str, Any]
    environment: dict[str, str]
    mesh: str

    @property
    def quality(self) -> Quality:
        """Balances, smoothness and reach of the loading curve."""
        return quality_of(self.curve or {"delta": np.zeros(0)}, self.case.pair.R)


@dataclass(frozen=True)
class Summary:
    """One stored case without its arrays; `quality` is none where the solver gave nothing."""

    id: str
    case: Case
    status: str
    message: str
    cpu_s: float
    quality: Quality | None

    @property
    def stale(self) -> bool:
        """Whether the present solver would give other numbers."""
        return self.id != self.case.id


def read_summary(key: str, group: h5py.Group, path: Path) -> Summary:
    """Read what is known of a case but its arrays."""
    attrs, quality = group.attrs, None
    if "quality" in attrs:
        quality = Quality(**json.loads(attrs["quality"]))
    elif "loading" in group:  # stored before the quality was
        quality = read_case(key, group, path).quality
    return Summary(
        id=key,
        case=Case.from_specification(json.loads(attrs["specification"])),
        status=str(attrs["status"]),
        message=str(attrs["message"]),
        cpu_s=float(attrs.get("counter_cpu_s", 0.0)),
        quality=quality,
    )


def read_case(key: str, group: h5py.Group, path: Path) -> CaseRecord:
    """Read a case whole; a dataset that is missing or in another unit is refused."""
    unloadings = []
    for name in sorted((n for n in group if n.startswith("unload-")), key=lambda n: int(n[7:])):
        part = group[name]
        unloadings.append(
            UnloadingRecord(
                depth=float(part.attrs["depth"]),
                curve=_read_arrays(part, CURVE, path),
                residual_sphere=float(part.attrs["residual_sphere_m"]),
                residual_flat=float(part.attrs["residual_flat_m"]),
                profiles=_read_arrays(part, UNLOADING_PROFILES, path),
            )
        )
    prefix = "counter_"
    return CaseRecord(
        id=key,
        case=Case.from_specification(json.loads(group.attrs["specification"])),
        status=str(group.attrs["status"]),
        message=str(group.attrs["message"]),
        curve=_read_arrays(group["loading"], CURVE, path) if "loading" in group else {},
        unloadings=tuple(unloadings),
        profiles=_read_arrays(group["profiles"], PROFILES, path) if "profiles" in group else {},
        counters={
            name[len(prefix) :]: float(value)
            for name, value in group.attrs.items()
            if name.startswith(prefix)
        },
        accuracy=json.loads(group.attrs.get("accuracy", "{}")),
        environment=json.loads(group.attrs["environment"]),
        mesh=str(group.attrs.get("mesh", "")),
    )


def _read_arrays(group: h5py.Group, schema: dict[str, Dataset], path: Path) -> dict[str, Floats]:
    out = {}
    for name, about in schema.items():
        if name not in group:
            raise InputError("missing", source=str(path), key=f"{group.name}/{name}")
        if group[name].attrs.get("unit") != about.unit:
            raise InputError(
                f"unit {group[name].attrs.get('unit')!r}",
                source=str(path),
                key=f"{group.name}/{name}",
                allowed=about.unit,
            )
        out[name] = np.asarray(group[name][()], dtype=float)
    return out
