"""Stored cases as objects: what cases' files and the rows of published parts become."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from ..core.arrays import Array
from ..core.errors import InputError
from .case import Case
from .contents import Tree, read_tree
from .quality import Quality, quality_of
from .schema import CURVE, PROFILES, UNLOADING_PROFILES, Dataset


@dataclass(frozen=True)
class UnloadingRecord:
    """One stored unloading; see `campaigns.schema` for units."""

    depth: float
    curve: dict[str, Array]
    residual_sphere: float
    residual_flat: float
    profiles: dict[str, Array]


@dataclass(frozen=True)
class CaseRecord:
    """One stored case.

    - `id`: case id.
    - `case`: its specification.
    - `status`: `done` or `failed`.
    - `message`: why it failed; empty when done.
    - `curve`: loading results by name, shape (n,), SI (see `campaigns.schema.CURVE`).
    - `unloadings`: in the order of their depth.
    - `profiles`: contact pressure and surfaces by name (see `campaigns.schema.PROFILES`).
    - `counters`: work that the solve took.
    - `accuracy`: settings that it was solved with: finer than the specification's after a retry.
    - `environment`: versions and commit that computed it.
    - `mesh`: digest of its mesh.
    """

    id: str
    case: Case
    status: str
    message: str
    curve: dict[str, Array]
    unloadings: tuple[UnloadingRecord, ...]
    profiles: dict[str, Array]
    counters: dict[str, float]
    accuracy: dict[str, Any]
    environment: dict[str, str]
    mesh: str

    @property
    def quality(self) -> Quality:
        """Balances, smoothness and reach of the loading curve."""
        return quality_of(self.curve or {"delta": np.zeros(0)}, self.case.pair.R)


def scaled(record: CaseRecord) -> tuple[Array, Array, Array, Array]:
    """Return Delta/R, F/(E' R^2), a/R and delta_s* of a loading curve, shape (n,)."""
    pair, c = record.case.pair, record.curve
    share = c["sphere"] / (c["sphere"] + c["flat"])
    force = c["force"] / (pair.E_reduced * pair.R**2)
    return c["delta"] / pair.R, force, c["radius"] / pair.R, share


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


def read_summary(file: h5py.Group, _path: Path) -> Summary:
    """Read what is known of a case but its arrays."""
    attrs = file.attrs
    return Summary(
        id=str(attrs["id"]),
        case=Case.from_specification(json.loads(attrs["specification"])),
        status=str(attrs["status"]),
        message=str(attrs["message"]),
        cpu_s=float(attrs.get("counter_cpu_s", 0.0)),
        quality=Quality(**json.loads(attrs["quality"])) if "quality" in attrs else None,
    )


def read_case(file: h5py.Group, path: Path) -> CaseRecord:
    """Read a case whole; refuse one without a dataset, or with one in another unit."""
    tree = read_tree(file)
    attributes, prefix = tree.attributes, "counter_"
    names = sorted((n for n in tree.groups if n.startswith("unload-")), key=lambda n: int(n[7:]))
    return CaseRecord(
        id=str(attributes["id"]),
        case=Case.from_specification(json.loads(attributes["specification"])),
        status=str(attributes["status"]),
        message=str(attributes["message"]),
        curve=_arrays(tree, "loading", CURVE, path),
        unloadings=tuple(_unloading(tree, name, path) for name in names),
        profiles=_arrays(tree, "profiles", PROFILES, path),
        counters={
            name[len(prefix) :]: float(value)
            for name, value in attributes.items()
            if name.startswith(prefix)
        },
        accuracy=json.loads(attributes.get("accuracy", "{}")),
        environment=json.loads(attributes["environment"]),
        mesh=str(attributes.get("mesh", "")),
    )


def _unloading(case: Tree, name: str, path: Path) -> UnloadingRecord:
    attributes = case.groups[name].attributes
    return UnloadingRecord(
        depth=float(attributes["depth"]),
        curve=_arrays(case, name, CURVE, path),
        residual_sphere=float(attributes["residual_sphere_m"]),
        residual_flat=float(attributes["residual_flat_m"]),
        profiles=_arrays(case, name, UNLOADING_PROFILES, path),
    )


def _arrays(case: Tree, name: str, schema: dict[str, Dataset], path: Path) -> dict[str, Array]:
    """Arrays of one of a case's groups; nothing where it has no such group."""
    if name not in case.groups:
        return {}
    group, out = case.groups[name], {}
    for column, about in schema.items():
        key = f"{name}/{column}"
        if column not in group.arrays:
            raise InputError("missing", source=str(path), key=key)
        if group.units[column] != about.unit:
            raise InputError(
                f"unit {group.units[column]!r}", source=str(path), key=key, allowed=about.unit
            )
        out[column] = np.asarray(group.arrays[column], dtype=float)
    return out
