"""The full fields of chosen cases, one VTU file each beside the campaign file."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from ..fem import Solution
from ..fem.fields import write_vtu

FOLDER = "fields"
"""Folder beside the campaign file."""


def write_fields(solution: Solution, folder: Path, *, name: str) -> list[Path]:
    """Write each kept state as `NAME-DEPTH.vtu`, whole or not at all.

    Parameters
    ----------
    solution
        A solve with snapshots.
    folder
        Where the files go; made if needed.
    name
        First part of their names.

    Raises
    ------
    OSError
        They cannot be written; what was begun is removed.
    """
    made = []
    for snapshot in solution.snapshots:
        path = folder / f"{name}-{snapshot.depth:.4g}.vtu"
        unfinished = folder / f".{os.getpid()}-{path.name}"
        try:
            write_vtu(snapshot, unfinished)
            unfinished.rename(path)
        except OSError:
            unfinished.unlink(missing_ok=True)
            raise
        made.append(path)
    return made


def fields_of(case_id: str, folder: Path) -> Sequence[Path]:
    """Return the files of one case, in the order of their names."""
    return sorted(folder.glob(f"{case_id[:16]}-*.vtu"))
