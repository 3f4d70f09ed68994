"""Run CalculiX on a deck and measure its printed displacements as ours are measured."""

from __future__ import annotations

import gzip
import json
import os
import resource
import shutil
import subprocess
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ....core.arrays import Array
from ....core.errors import InputError
from ....fem.contact import POINTS, ContactState, contact_forces
from ....fem.discretise import Discretisation
from ....fem.results.measure import edge_of_contact
from .deck import ELEMENT, Deck, write_deck

_COMMAND = "ccx"
_WEDGE = 180.0  # CalculiX turns axisymmetric elements into a wedge of 2 degrees

FOLDER = Path(__file__).resolve().parents[3] / "data" / "reference" / "calculix"
"""Where decks and results are kept."""


@dataclass(frozen=True)
class Reference:
    """What CalculiX gave; lengths in R, force in MPa R^2, one entry a depth reached.

    - `version`: of CalculiX.
    - `cpu_s`: processor seconds.
    - `unknowns`: twice the number of nodes in the meridian plane.
    - `delta`, `force`, `radius`, `share`: results, shape (n,).
    """

    version: str
    cpu_s: float
    unknowns: int
    delta: Array
    force: Array
    radius: Array
    share: Array


def run_deck(deck: Deck, *, name: str) -> Reference:
    """Run the deck; deck and printed output are kept, compressed, in this folder."""
    text = write_deck(deck)
    printed, cpu = solve_deck(text)
    for ending, content in (("inp", text), ("dat", printed)):
        with gzip.GzipFile(FOLDER / f"{name}.{ending}.gz", "wb", mtime=0) as stream:
            stream.write(content.encode())
    release = _version()
    about = {"element": ELEMENT, "version": release, "cpu_s": round(cpu, 1)}
    (FOLDER / f"{name}.json").write_text(json.dumps(about, indent=1) + "\n")
    return measure(deck, printed, cpu_s=cpu, version=release)


def solve_deck(text: str) -> tuple[str, float]:
    """Return what CalculiX prints for the text of a deck, and its processor seconds.

    Raises `InputError`: CalculiX is not installed.
    """
    if shutil.which(_COMMAND) is None:
        raise InputError(
            f"{_COMMAND!r} is not installed",
            key="CalculiX",
            allowed="install the Debian package calculix-ccx",
        )
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "case.inp").write_text(text)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(
            [_COMMAND, "case"],
            cwd=folder,
            capture_output=True,
            check=False,
            env={**os.environ, "OMP_NUM_THREADS": "1"},
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        printed = (Path(folder) / "case.dat").read_text()
    return printed, (after.ru_utime + after.ru_stime) - (before.ru_utime + before.ru_stime)


def load_reference(deck: Deck, *, name: str) -> Reference | None:
    """Return what an earlier run of this deck gave, if there is one."""
    path = FOLDER / f"{name}.json"
    if not path.exists():
        return None
    with gzip.open(FOLDER / f"{name}.inp.gz", "rt") as stream:
        if stream.read() != write_deck(deck):
            return None  # our mesh or the case has changed since
    with gzip.open(FOLDER / f"{name}.dat.gz", "rt") as stream:
        printed = stream.read()
    about = json.loads(path.read_text())
    return measure(deck, printed, cpu_s=about["cpu_s"], version=about["version"])


def measure(deck: Deck, printed: str, *, cpu_s: float = 0.0, version: str = "") -> Reference:
    """Read the printed reactions and displacements and measure F, a and delta_s*."""
    grid = deck.grid
    slave, master = grid.surfaces.sphere, grid.surfaces.flat
    found: list[tuple[float, float, float, float]] = []
    for depth, (reaction, moved) in zip(deck.problem.depths, _blocks(printed), strict=False):
        x = grid.mesh.points.copy()
        for node, u in moved.items():
            x[node] += u
        contact, _ = contact_forces(grid.surfaces, x, force=np.zeros(grid.n_dofs))
        if contact is None:
            break
        sphere = depth + moved[int(slave[0])][1]
        flat = -moved[int(master[0])][1]
        a = edge_of_contact(_touching(grid, contact, x), x[slave, 0])
        found.append((depth, _WEDGE * abs(reaction), a, float(sphere / (sphere + flat))))
    columns = np.array(found).reshape(-1, 4).T
    return Reference(version, cpu_s, 2 * len(grid.mesh.points), *columns)


def _touching(grid: Discretisation, contact: ContactState, x: Array) -> ContactState:
    """Contact state whose active nodes are those from the axis on that touch within the mesh.

    Two surfaces of straight edges that touch everywhere are up to h^2/(8 R) apart between their
    nodes; just outside of the contact the gap is ten times that.
    """
    s = grid.surfaces
    part = 0.5 * (1.0 + POINTS)
    gap = np.zeros(len(s.slave))
    gap[:-1] += (s.weight * contact.gap * (1.0 - part)).sum(axis=1)
    gap[1:] += (s.weight * contact.gap * part).sum(axis=1)
    gap /= s.mass
    r = x[s.slave, 0]
    width = np.diff(r, append=2.0 * r[-1] - r[-2])
    apart = np.flatnonzero(gap > 0.15 * width**2)
    last = int(apart[0]) if len(apart) else len(gap)
    return replace(contact, pressure=(np.arange(len(gap)) < last).astype(float))


def _blocks(printed: str) -> list[tuple[float, dict[int, Array]]]:
    """Reaction of the top and displacements by node of every step."""
    steps: list[tuple[float, dict[int, Array]]] = []
    moved: dict[int, Array] = {}
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


def _version() -> str:
    answer = subprocess.run([_COMMAND, "-v"], capture_output=True, text=True, check=False)
    return answer.stdout.strip().removeprefix("This is ")
