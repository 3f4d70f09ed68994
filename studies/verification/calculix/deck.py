"""Input deck for CalculiX: axisymmetric elements on our mesh, hard contact, one step a depth.

Lengths are in R and stresses in MPa, so that forces come out in MPa R^2. The deck uses none of our
numerics: elements, plasticity, contact and Newton's method are CalculiX's own.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from .... import fem
from ....core.arrays import Integers
from ....core.material import Material
from ....fem.discretise import Discretisation, discretise

ELEMENT = "CAX4"
"""Four nodes, full integration."""

_STIFFNESS = 1e9  # contact pressure over penetration [MPa/R]
_FIRST, _LAST, _ROWS = 1e-5, 5.0, 150  # plastic strains of a table


@dataclass(frozen=True)
class Deck:
    """What is to be written.

    - `problem`: pair and depths; every depth becomes a step.
    - `accuracy`: settings whose mesh is used.
    """

    problem: fem.ContactProblem
    accuracy: fem.Accuracy

    @property
    def grid(self) -> Discretisation:
        """Our discretisation, whose mesh and node sets the deck shares."""
        return discretise(self.problem, self.accuracy)


def write_deck(deck: Deck) -> str:
    """Return the text of the deck."""
    grid = deck.grid
    mesh = grid.mesh
    n, quads = mesh.n_sphere_quads, mesh.quads
    lines = ["*HEADING", "sphere on flat, lengths in R, stresses in MPa", "*NODE, NSET=ALL"]
    lines += [f"{i + 1},{x:.12g},{y:.12g},0." for i, (x, y) in enumerate(mesh.points)]
    for name, part, first in (("SPHERE", quads[:n], 0), ("FLAT", quads[n:], n)):
        lines.append(f"*ELEMENT, TYPE={ELEMENT}, ELSET=E{name}")
        for e, row in enumerate(part, start=first + 1):
            lines.append(",".join(str(x) for x in (e, *(int(i) + 1 for i in row))))
    for name, nodes in (
        ("TOP", mesh.top),
        ("FAR", mesh.far),
        ("AXIS", np.flatnonzero(mesh.points[:, 0] == 0.0)),
        ("SLAVE", mesh.sphere_surface),
        ("MASTER", mesh.flat_surface),
    ):
        lines += [f"*NSET, NSET={name}", *_sixteen(nodes)]
    lines += _surface("SSLAVE", mesh.quads, mesh.sphere_surface)
    lines += _surface("SMASTER", mesh.quads, mesh.flat_surface)
    pair = deck.problem.pair
    for name, body in (("SPHERE", pair.sphere), ("FLAT", pair.flat)):
        lines += _material(name, body)
        lines += [f"*SOLID SECTION, ELSET=E{name}, MATERIAL=M{name}", "1."]
    lines += [
        "*SURFACE INTERACTION, NAME=SMOOTH",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
        f"{_STIFFNESS:g}",
        "*CONTACT PAIR, INTERACTION=SMOOTH, TYPE=SURFACE TO SURFACE",
        "SSLAVE, SMASTER",
        "*BOUNDARY",
        "AXIS,1,1",
        "FAR,1,2",
    ]
    for depth in deck.problem.depths:
        lines += _step(depth)
    return "\n".join(lines) + "\n"


def _material(name: str, body: Material) -> list[str]:
    lines = [f"*MATERIAL, NAME=M{name}", "*ELASTIC", f"{body.E * 1e-6:.10g},{body.nu:g}"]
    if np.isfinite(body.strength):
        lines.append("*PLASTIC")
        lines += [f"{stress * 1e-6:.10g},{strain:.10g}" for strain, stress in _flow_curve(body)]
    return lines


def _flow_curve(body: Material) -> list[tuple[float, float]]:
    """Plastic strain and flow stress [Pa]; CalculiX is linear between rows and takes 200."""
    curve = None if body.flow is None else body.flow.curve
    if curve is None:
        return [(0.0, body.Sy)]
    strains = np.append(0.0, np.geomspace(_FIRST, _LAST, _ROWS))
    return [(float(p), curve(float(p))) for p in strains]


def _step(depth: float) -> list[str]:
    return [
        "*STEP, NLGEOM, INC=1000",
        "*STATIC",
        "1.,1.,1e-5,1.",
        "*BOUNDARY",
        f"TOP,2,2,{-depth:.12g}",
        "*NODE PRINT, NSET=TOP, TOTALS=ONLY, FREQUENCY=1000",
        "RF",
        "*NODE PRINT, NSET=SLAVE, FREQUENCY=1000",
        "U",
        "*NODE PRINT, NSET=MASTER, FREQUENCY=1000",
        "U",
        "*END STEP",
    ]


def _sixteen(nodes: Iterable[int]) -> list[str]:
    numbers = [str(int(i) + 1) for i in nodes]
    return [",".join(numbers[k : k + 16]) + "," for k in range(0, len(numbers), 16)]


def _surface(name: str, quads: Integers, nodes: Integers) -> Iterator[str]:
    """Element faces whose two corners both lie in `nodes`."""
    yield f"*SURFACE, NAME={name}, TYPE=ELEMENT"
    inside = np.isin(quads, nodes)
    for e, side in zip(*np.nonzero(inside & np.roll(inside, -1, axis=1)), strict=True):
        yield f"{e + 1},S{side + 1}"
