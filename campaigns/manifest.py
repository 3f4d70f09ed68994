"""What a published data set says of its parts: cases, versions, quality, checksums."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

import h5py
import numpy as np

from ..core.provenance import file_digest
from .quality import MOST_ENERGY_DEFECT, MOST_STEP

MANIFEST = "PARTS.md"

_HEAD = """# The parts

Written by `dentscope campaign publish`. Quality is that of the completed cases: the energy defect
is the largest |work - stored - dissipated|/work, a step the largest of F, a or delta_s* between two
recorded depths, over the local value.

| part | MB | cases | failed | reach 0.1 and a/R = 0.5 | reach 0.04 | numerics | processor h |
| --- | --- | --- | --- | --- | --- | --- | --- |
"""


def write_manifest(folder: Path) -> Path:
    """Write PARTS.md for all parts in `folder`."""
    parts = sorted(folder.glob("*.h5"))
    text = _HEAD + "".join(_row(path) for path in parts)
    text += "\n## Quality\n\n"
    text += "| part | energy defect, median and largest | above the mark | "
    text += "step, median and largest | above the mark |\n| --- | --- | --- | --- | --- |\n"
    text += "".join(_quality(path) for path in parts)
    text += f"\nMarks: energy defect {MOST_ENERGY_DEFECT:.1%}, step {MOST_STEP:.0%}.\n"
    text += "\n## Failures\n\n" + ("".join(map(_failures, parts)) or "None.\n")
    text += "\n## Computed with\n\n" + "".join(map(_versions, parts))
    text += "\n## SHA-256\n\n"
    text += "".join(f"- `{path.name}` {file_digest(path)}\n" for path in parts)
    place = folder / MANIFEST
    place.write_text(text, encoding="utf-8")
    return place


def _row(path: Path) -> str:
    with h5py.File(path, "r") as file:
        cases = file["cases"]
        done = _texts(cases["status"]) == "done"
        depth, radius = cases["depth_reached"][()], cases["radius_reached"][()]
        whole = int(((depth >= 0.1 - 1e-9) & (radius >= 0.5 - 1e-9)).sum())
        hours = sum(json.loads(t).get("cpu_s", 0.0) for t in _texts(cases["counters"])) / 3600.0
        version = file.attrs["numerics_version"]
    n, size = len(done), path.stat().st_size / 1e6
    shallow = int((depth >= 0.04 - 1e-9).sum())
    return (
        f"| `{path.name}` | {size:.2f} | {n} | {n - int(done.sum())} | {whole} | {shallow} | "
        f"{version} | {hours:.1f} |\n"
    )


def _quality(path: Path) -> str:
    with h5py.File(path, "r") as file:
        cases = file["cases"]
        done = _texts(cases["status"]) == "done"
        if not done.any():
            return f"| `{path.name}` | | | | |\n"
        energy = cases["energy_defect"][()][done]
        names = ("force_step", "radius_step", "share_step")
        steps = np.nanmax([cases[name][()][done] for name in names], axis=0)
    return (
        f"| `{path.name}` | {np.median(energy):.2%}, {energy.max():.2%} | "
        f"{int((energy > MOST_ENERGY_DEFECT).sum())} | "
        f"{np.median(steps):.2%}, {steps.max():.2%} | {int((steps > MOST_STEP).sum())} |\n"
    )


def _failures(path: Path) -> str:
    with h5py.File(path, "r") as file:
        cases = file["cases"]
        told = zip(*(_texts(cases[name]) for name in ("status", "name", "message")), strict=True)
        return "".join(f"- `{name}`: {why}\n" for status, name, why in told if status != "done")


def _versions(path: Path) -> str:
    with h5py.File(path, "r") as file:
        found = Counter(_texts(file["cases/environment"]))
    lines = []
    for text, count in found.most_common():
        words = ", ".join(f"{name} {value}" for name, value in json.loads(text).items())
        lines.append(f"- `{path.name}`, {count} cases: {words}\n")
    return "".join(lines)


def _texts(data: h5py.Dataset) -> np.ndarray[tuple[int], np.dtype[np.str_]]:
    return np.char.decode(data[()], "utf-8")
