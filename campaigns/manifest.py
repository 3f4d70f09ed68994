"""What a published data set says of its parts: cases, versions, quality, checksums."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np

from ..core.arrays import Mask
from .contents import open_image, read_array
from .rules import RULES

MANIFEST = "PARTS.md"

_HEAD = """# The parts

Written by `dentscope campaign publish`. Quality is that of the completed cases: the energy defect
is the largest |work - stored - dissipated|/work, a step the largest of F, a or delta_s* between two
recorded depths, over the local value.

| part | MB | cases | failed | reach 0.1 and a/R = 0.5 | reach 0.04 | numerics | processor h |
| --- | --- | --- | --- | --- | --- | --- | --- |
"""


def manifest(folder: Path, names: Iterable[str], made: Mapping[str, bytes]) -> str:
    """Return PARTS.md for all parts of a folder; `made` are contents not written yet."""
    parts = []
    for name in sorted(names):
        image = made.get(name) or (folder / name).read_bytes()
        with open_image(image) as file:
            parts.append(Part(name, len(image), hashlib.sha256(image).hexdigest(), _tables(file)))
    text = _HEAD + "".join(map(_row, parts))
    text += "\n## Quality\n\n"
    text += "| part | energy defect, median and largest | above the mark | "
    text += "step, median and largest | above the mark |\n| --- | --- | --- | --- | --- |\n"
    text += "".join(map(_quality, parts))
    text += f"\nMarks: energy defect {RULES.energy_defect:.1%}, step {RULES.step:.0%}.\n"
    text += "\n## Failures\n\n" + ("".join(map(_failures, parts)) or "None.\n")
    text += "\n## Computed with\n\n" + "".join(map(_versions, parts))
    text += "\n## SHA-256\n\n"
    return text + "".join(f"- `{part.name}` {part.sha256}\n" for part in parts)


class Part(NamedTuple):
    """One part: its file and the columns of its table `cases`."""

    name: str
    size: int
    sha256: str
    cases: dict[str, Any]

    @property
    def done(self) -> Mask:
        """Which cases are complete, (n,)."""
        return np.array([status == "done" for status in self.cases["status"]])


def _tables(file: h5py.File) -> dict[str, Any]:
    columns = {name: read_array(file["cases"][name]) for name in file["cases"]}
    texts = {k: np.char.decode(v, "utf-8") for k, v in columns.items() if v.dtype.kind == "S"}
    return {**columns, **texts, "numerics_version": file.attrs["numerics_version"]}


def _row(part: Part) -> str:
    cases, n = part.cases, len(part.done)
    depth, radius = cases["depth_reached"], cases["radius_reached"]
    whole = int(((depth >= 0.1 - 1e-9) & (radius >= 0.5 - 1e-9)).sum())
    hours = sum(json.loads(t).get("cpu_s", 0.0) for t in cases["counters"]) / 3600.0
    shallow = int((depth >= 0.04 - 1e-9).sum())
    return (
        f"| `{part.name}` | {part.size / 1e6:.2f} | {n} | {n - int(part.done.sum())} | {whole} | "
        f"{shallow} | {cases['numerics_version']} | {hours:.1f} |\n"
    )


def _quality(part: Part) -> str:
    done = part.done
    if not done.any():
        return f"| `{part.name}` | | | | |\n"
    energy = part.cases["energy_defect"][done]
    names = ("force_step", "radius_step", "share_step")
    steps = np.nanmax([part.cases[name][done] for name in names], axis=0)
    return (
        f"| `{part.name}` | {np.median(energy):.2%}, {energy.max():.2%} | "
        f"{int((energy > RULES.energy_defect).sum())} | "
        f"{np.median(steps):.2%}, {steps.max():.2%} | {int((steps > RULES.step).sum())} |\n"
    )


def _failures(part: Part) -> str:
    told = zip(*(part.cases[name] for name in ("status", "name", "message")), strict=True)
    return "".join(f"- `{name}`: {why}\n" for status, name, why in told if status != "done")


def _versions(part: Part) -> str:
    lines = []
    for text, count in Counter(part.cases["environment"].tolist()).most_common():
        words = ", ".join(f"{name} {value}" for name, value in json.loads(text).items())
        lines.append(f"- `{part.name}`, {count} cases: {words}\n")
    return "".join(lines)
