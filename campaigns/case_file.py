"""One ended case as the bytes of its file, and its full fields as files beside that."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

import h5py
import numpy as np
import numpy.typing as npt

from ..core.arrays import Array
from ..core.errors import Ending
from ..core.provenance import environment
from ..fem import Curve, Solution, Unloading
from ..fem.results.fields import write_vtu
from .case import Case
from .contents import new_image
from .parts import filled
from .quality import quality_of
from .schema import CURVE, FORMAT, PROFILES, UNLOADING_PROFILES, Dataset

# limit: profiles are kept out to this many contact radii [-]; beyond it the surface is at rest
_PROFILE_REACH = 2.0

# limit: values of an array that is compressed [-]: below it compression saves nothing
_COMPRESSED_FROM = 512


def case_image(
    case: Case,
    solution: Solution | None,
    *,
    message: str = "",
    computed_by: Mapping[str, str] | None = None,
    fields: Sequence[str] = (),
    also: Callable[[h5py.Group], None] | None = None,
) -> bytes:
    """Return an ended case as a sealed file.

    `solution` is none when the worker gave nothing, and `message` says why; `computed_by` holds
    versions and commit of the worker, those of this process by default. `fields` names the files
    with its full fields; `also` writes more into the file.
    """
    done = solution is not None and solution.outcome.completed
    ending = solution.outcome.ending if solution else Ending.WORKER_LOST
    with new_image() as made:
        file = made.file
        file.attrs["format"] = FORMAT
        file.attrs["id"] = case.id
        file.attrs["status"] = "done" if done else "failed"
        file.attrs["specification"] = json.dumps(case.specification())
        file.attrs["environment"] = json.dumps(dict(computed_by or environment()))
        file.attrs["outcome"] = ending.value
        file.attrs["message"] = "" if done else (message or str(solution and solution.outcome))
        if solution is not None:
            _put_solution(file, solution)
            file.attrs["fields"] = json.dumps(list(fields))
        if also is not None:
            also(file)
    return made.sealed


def write_fields(solution: Solution, folder: Path, *, name: str) -> list[Path]:
    """Write each kept state as `NAME-DEPTH.vtu`, whole or not at all; make the folder if needed."""
    return [
        write_vtu(snapshot, folder / f"{name}-{snapshot.depth:.4g}.vtu")
        for snapshot in solution.snapshots
    ]


def _put_solution(file: h5py.Group, solution: Solution) -> None:
    # a retried case may have been solved more finely than its specification asks
    file.attrs["accuracy"] = json.dumps(solution.accuracy.as_dict())
    file.attrs["mesh"] = solution.mesh_digest
    file.attrs["boundary"] = solution.boundary
    file.attrs["yield_measure"] = solution.yield_measure
    quality = quality_of(vars(solution.loading), solution.problem.pair.R)
    file.attrs["quality"] = json.dumps(asdict(quality))
    counters = solution.counters
    for name in counters.__dataclass_fields__:
        file.attrs[f"counter_{name}"] = float(getattr(counters, name))
    _put_arrays(file.create_group("loading"), solution.loading, CURVE)
    for number, unloading in enumerate(solution.unloadings, start=1):
        part = file.create_group(f"unload-{number}")
        part.attrs["depth"] = unloading.depth
        part.attrs["residual_sphere_m"] = unloading.residual_sphere
        part.attrs["residual_flat_m"] = unloading.residual_flat
        part.attrs["steps"] = unloading.steps
        part.attrs["outcome"] = unloading.outcome.ending.value
        _put_arrays(part, unloading.curve, CURVE)
        _put_arrays(part, unloading, UNLOADING_PROFILES)
    if solution.profiles:
        _put_profiles(file.create_group("profiles"), solution)


def _put_profiles(group: h5py.Group, solution: Solution) -> None:
    reach = _PROFILE_REACH * np.nanmax(solution.loading.radius)
    for name, about in PROFILES.items():
        columns = [getattr(p, name) for p in solution.profiles]
        if about.axes[-1] != "node":
            _put_array(group, name, np.array(columns, dtype=np.float32), about)
            continue
        side = "flat_r" if name.startswith("flat") else "sphere_r"
        radii = [getattr(p, side) for p in solution.profiles]
        kept = [
            c[: int(np.searchsorted(r, reach)) + 1] for c, r in zip(columns, radii, strict=True)
        ]
        # the mesh follows the contact, so that the profiles differ in their number of nodes
        _put_array(group, name, filled(kept).astype(np.float32), about)


def _put_arrays(group: h5py.Group, part: Curve | Unloading, schema: dict[str, Dataset]) -> None:
    for name, about in schema.items():
        _put_array(group, name, getattr(part, name), about)


def _put_array(
    group: h5py.Group, name: str, values: Array | npt.NDArray[np.float32], about: Dataset
) -> None:
    packed = {"compression": "gzip", "shuffle": True} if values.size > _COMPRESSED_FROM else {}
    if values.size:  # HDF5 has no chunk of nothing, and so no checksum of it
        packed |= {"chunks": values.shape, "fletcher32": True}
    data = group.create_dataset(name, data=values, **packed)
    data.attrs["unit"] = about.unit
    data.attrs["axes"] = ",".join(about.axes)
    data.attrs["meaning"] = about.meaning
