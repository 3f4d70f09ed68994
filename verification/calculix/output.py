"""Run CalculiX on a deck and measure its printed displacements as ours are measured."""

from __future__ import annotations

import gzip
import json
import os
import resource
import shutil
import subprocess
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ...core.errors import InputError
from ...fem.contact import contact_forces
from ...fem.measure import edge_of_contact
from .deck import Deck, write_deck

Floats = npt.NDArray[np.float64]

_WEDGE = 180.0  # CalculiX turns axisymmetric elements into a wedge of 2 degrees

FOLDER = Path(__file__).parent
"""Where decks and results are kept."""


@dataclass(frozen=True)
class Reference:
    """What CalculiX gave; lengths in R, force in MPa R^2, one entry a depth reached.

    Parameters
    ----------
    element, version
        Element and version of CalculiX.
    cpu_s
        Processor seconds.
    unknowns
        Twice the number of nodes in the meridian plane.
    delta, force, radius, share
        Results.
    """

    element: str
    version: str
    cpu_s: float
    unknowns: int
    delta: list[float]
    force: list[float]
    radius: list[float]
    share: list[float]


def run_deck(deck: Deck, *, name: str, command: str = "ccx") -> Reference:
    """Write the deck to this folder (compressed), run it, keep and return what it gave.

    Raises
    ------
    InputError
        CalculiX is not installed.
    """
    if shutil.which(command) is None:
        raise InputError(
            f"{command!r} is not installed",
            key="CalculiX",
            allowed="install the Debian package calculix-ccx",
        )
    text = write_deck(deck)
    with gzip.GzipFile(FOLDER / f"{name}.inp.gz", "wb", mtime=0) as stream:
        stream.write(text.encode())
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "case.inp").write_text(text)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(
            [command, "case"],
            cwd=folder,
            capture_output=True,
            check=False,
            env={**os.environ, "OMP_NUM_THREADS": "1"},
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        printed = (Path(folder) / "case.dat").read_text()
    cpu = (after.ru_utime + after.ru_stime) - (before.ru_utime + before.ru_stime)
    found = measure(deck, printed, cpu_s=cpu, version=_version(command))
    (FOLDER / f"{name}.json").write_text(json.dumps(asdict(found), indent=1) + "\n")
    return found


def load_reference(name: str) -> Reference | None:
    """Return what an earlier run gave, if there is one."""
    path = FOLDER / f"{name}.json"
    return Reference(**json.loads(path.read_text())) if path.exists() else None


def measure(deck: Deck, printed: str, *, cpu_s: float = 0.0, version: str = "") -> Reference:
    """Read the printed reactions and displacements and measure F, a and delta_s*."""
    grid = deck.grid
    slave, master = grid.surfaces.slave, grid.surfaces.master
    depths, force, radius, share = [], [], [], []
    for depth, (reaction, moved) in zip(deck.problem.depths, _blocks(printed), strict=False):
        x = grid.mesh.points.copy()
        for node, u in moved.items():
            x[node] += u
        contact, _ = contact_forces(grid.surfaces, x, force=np.zeros(grid.n_dofs))
        if contact is None:
            break
        sphere = depth + moved[int(slave[0])][1]
        flat = -moved[int(master[0])][1]
        depths.append(depth)
        force.append(_WEDGE * abs(reaction))
        radius.append(edge_of_contact(contact, x[slave, 0]))
        share.append(float(sphere / (sphere + flat)))
    corners = len(grid.mesh.points)
    nodes = corners if deck.element == "CAX4" else 4 * corners - 1
    return Reference(deck.element, version, cpu_s, 2 * nodes, depths, force, radius, share)


def _blocks(printed: str) -> list[tuple[float, dict[int, Floats]]]:
    """Reaction of the top and displacements by node of every step."""
    steps: list[tuple[float, dict[int, Floats]]] = []
    moved: dict[int, Floats] = {}
    reaction = 0.0
    kind = ""
    for line in printed.splitlines():
        words = line.split()
        if not words:
            continue
        if "total force" in line:
            kind = "force"
            if moved:
                steps.append((reaction, moved))
            moved = {}
        elif "displacements" in line:
            kind = "moved"
        elif kind == "force":
            reaction = float(words[1])
            kind = ""
        elif kind == "moved":
            moved[int(words[0]) - 1] = np.array([float(words[1]), float(words[2])])
    if moved:
        steps.append((reaction, moved))
    return steps


def _version(command: str) -> str:
    answer = subprocess.run([command, "-v"], capture_output=True, text=True, check=False)
    return answer.stdout.strip().removeprefix("This is ")
