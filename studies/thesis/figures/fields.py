"""Figures 2.1-2.4 and 3.7: the mesh, and von Mises fields of stored finite-element solves.

The fields come from `dentscope figures --fields 2.2` (minutes), which solves the pair of a figure
and keeps the part near the contact in `docs/thesis/fields`; drawing needs the file only.
"""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.collections import PolyCollection

from ....core.arrays import Array, Mask
from ....core.material import Material, Pair
from ....core.output import write_file
from ....fem import NUMERICS_VERSION, Accuracy, ContactProblem, geometric_depths, solve
from ....fem.discretise import discretise
from ....fem.mesh import Zone
from ....models import LAWS
from ...plot import Picture, finish, sheet
from .. import chapter3
from .names import FIELDS

STORE = Path(__file__).resolve().parents[3] / "docs" / "thesis" / "fields"
_THESIS_ELEMENTS = 9784


def _steels(sphere: float, flat: float) -> Pair:
    return Pair(
        Material(E=200e9, nu=0.3, Sy=sphere), Material(E=200e9, nu=0.3, Sy=flat), 1e-3
    )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Wanted:
    """A field picture: pair, depth, what the thesis says, how far the solve goes on."""

    title: str
    pair: Callable[[], Pair]
    depth: float
    said: str
    last: float = 0.0


WANTED = dict(zip(FIELDS, (
    Wanted("von Mises stress, Sy* = 0.1", lambda: _steels(503e6, 5030e6), 0.02,
           "the flat is still elastic"),
    Wanted("von Mises stress, Sy* = 1", lambda: _steels(503e6, 503e6), 0.02,
           "large parts of both bodies yield"),
    Wanted("von Mises stress, Sy* = 10", lambda: _steels(5030e6, 503e6), 0.02,
           "the flat yields also outside the contact, the sphere does not"),
    Wanted("Mesh and von Mises stress of chapter 3", lambda: chapter3.bench().pair, 148e-6 / 0.1365,
           "", last=0.1),
), strict=True))  # fmt: skip
"""Field pictures by figure number; the thesis gives no depth for 2.2-2.4. The solve of 3.7 goes on
as far as figure 3.8 does."""


@dataclass(frozen=True, slots=True)
class Field:
    """Part of a solved section near the contact; lengths in R, stress in Sy_min.

    - `corners`: corners of the elements as deformed, shape (n, 4, 2).
    - `sphere`: whether an element is the sphere's, shape (n,).
    - `stress`, `plastic`: von Mises stress and equivalent plastic strain, shape (n,).
    - `depth`, `force`: loading curve of the same solve, Delta/R and F/(E' R^2), shape (k,); empty
      in older files.
    - `origin`: depth, contact radius, force, settings and version of the solve.
    """

    corners: Array
    sphere: Mask
    stress: Array
    plastic: Array
    depth: Array
    force: Array
    origin: dict[str, Any]


def solve_field(number: str, *, folder: Path = STORE) -> Path:
    """Solve the pair of figure `number` at the level "quick" and keep its field.

    Raises `RuntimeError`: the solver did not reach the depth; nothing is written.
    """
    wanted, accuracy = WANTED[number], Accuracy.quick()
    pair = wanted.pair()
    first = 0.3 * pair.first_yield
    depths = geometric_depths(first, wanted.depth, 20)
    if wanted.last:
        depths = (*depths, *geometric_depths(wanted.depth, wanted.last, 20)[1:])
    problem = ContactProblem(pair=pair, depths=depths, snapshots=(wanted.depth,))
    solution = solve(problem, accuracy=accuracy)
    if not solution.snapshots:
        raise RuntimeError(str(solution.outcome))
    seen, R = solution.snapshots[-1], pair.R
    curve = solution.loading
    there = int(np.argmin(np.abs(curve.delta / R - seen.depth)))
    a = float(curve.radius[there]) / R
    corners = ((seen.points + seen.displacement) / R)[seen.quads]
    near = np.hypot(*corners.mean(axis=1).T) < 3.2 * a
    path = folder / f"figure-{number.replace('.', '-')}.npz"
    origin = {
        "Delta_over_R": seen.depth, "a_over_R": a, "force_N": float(curve.force[there]),
        "level": accuracy.level, "numerics_version": NUMERICS_VERSION,
        "elements": len(seen.quads),
    }  # fmt: skip
    stream = io.BytesIO()
    np.savez_compressed(
        stream,
        corners=corners[near].astype(np.float32),
        sphere=(np.arange(len(seen.quads)) < seen.n_sphere_quads)[near],
        stress=(seen.von_mises[near] / pair.Sy_min).astype(np.float32),
        plastic=seen.plastic_strain[near].astype(np.float32),
        depth=curve.delta / R,
        force=curve.force / (pair.E_reduced * R**2),
        origin=np.array(json.dumps(origin)),
    )
    return write_file(path, stream.getvalue())


def read_field(number: str, *, folder: Path = STORE) -> Field | None:
    """Return the stored field of figure `number`; None if there is none."""
    path = folder / f"figure-{number.replace('.', '-')}.npz"
    if not path.exists():
        return None
    with np.load(path, allow_pickle=False) as data:
        return Field(
            data["corners"].astype(float), data["sphere"], data["stress"].astype(float),
            data["plastic"].astype(float),
            data["depth"] if "depth" in data else np.zeros(0),
            data["force"] if "force" in data else np.zeros(0),
            json.loads(str(data["origin"])),
        )  # fmt: skip


def chapter_2() -> list[Picture]:
    """Figures 2.1-2.4."""
    found = [(number, read_field(number)) for number in ("2.2", "2.3", "2.4")]
    return [_mesh(), *(_field(number, field) for number, field in found if field is not None)]


def _grid_of(pair: Pair, depth: float) -> tuple[Array, Any]:
    """Mesh of published results when the contact has reached Delta/R = `depth`."""
    problem = ContactProblem(pair=pair, depths=geometric_depths(0.3 * pair.first_yield, depth, 20))
    a = float(LAWS["ghaednia"].contact_radius(pair, depth * pair.R)) / pair.R
    mesh = discretise(problem, Accuracy.production(), Zone(0.9 * a, 1.4 * a)).mesh
    return np.asarray(mesh.points[mesh.quads]), mesh


def _draw_mesh(axis: Any, corners: Array, spheres: int, *, reach: float) -> None:
    for part, colour in ((corners[:spheres], "C0"), (corners[spheres:], "C1")):
        near = np.max(np.abs(part.mean(axis=1)), axis=1) < 1.3 * reach
        axis.add_collection(
            PolyCollection(list(part[near]), facecolors="none", edgecolors=colour, linewidths=0.4)
        )
    axis.set_xlim(0.0, reach)
    axis.set_ylim(-reach, reach)
    axis.set_aspect("equal")


def _mesh() -> Picture:
    made, axes = sheet(2, size=(4.8, 6.2))
    corners, mesh = _grid_of(WANTED["2.3"].pair(), 0.04)
    for axis, reach in zip(axes, (1.2, 0.45), strict=True):
        _draw_mesh(axis, corners, mesh.n_sphere_quads, reach=reach)
        finish(axis, x="r/R", y="z/R")
    note = (
        f"Settings of published results: {len(mesh.quads)} four-node elements up to 200 R, "
        f"{mesh.n_sphere_quads} of them in the sphere; the thesis has {_THESIS_ELEMENTS} nine-node "
        "ones. Drawn for Delta/R = 0.04: the mesh is made anew as the contact grows, finest where "
        "its edge is, so that every contact radius on the way is resolved alike."
    )
    return Picture("2.1", "Mesh, whole and near the contact", made, note)


def chapter_3() -> Picture:
    """Figure 3.7: mesh, and beside it the stress where it was solved."""
    field = read_field("3.7")
    made, axes = sheet(1 if field is None else 2, size=(5.6, 5.6))
    wanted = WANTED["3.7"]
    corners, mesh = _grid_of(wanted.pair(), wanted.depth)
    reach = 0.1 if field is None else 2.2 * field.origin["a_over_R"]
    _draw_mesh(axes[0], corners, mesh.n_sphere_quads, reach=reach)
    axes[0].set_title("(a) mesh of published results", fontsize=9)
    finish(axes[0], x="r/R", y="z/R")
    note = f"(a) {len(mesh.quads)} elements for the chapter's pair and R = 136.5 mm"
    if field is None:
        note += "; the stress of (b) needs `dentscope figures --fields 3.7`, some minutes."
    else:
        _draw_field(made, axes[1], field)
        axes[1].set_title("(b) von Mises stress at 148 um", fontsize=9)
        note += f". (b) {_told(field)}"
    return Picture("3.7", wanted.title, made, note)


def _field(number: str, field: Field) -> Picture:
    made, (axis,) = sheet(size=(7.2, 6.2))
    _draw_field(made, axis, field)
    wanted = WANTED[number]
    return Picture(number, wanted.title, made, f"{_told(field)} The thesis: {wanted.said}.")


def _told(field: Field) -> str:
    a = field.origin["a_over_R"]
    return (
        f"Delta/R = {field.origin['Delta_over_R']:.3g}, a/R = {a:.3f}, level "
        f"{field.origin['level']}. {_yielded(field, a)}"
    )


def _draw_field(made: Any, axis: Any, field: Field) -> None:
    a = field.origin["a_over_R"]
    for side in (1.0, -1.0):
        drawn = PolyCollection(
            list(field.corners * np.array([side, 1.0])), array=field.stress, cmap="turbo",
            edgecolors="face", linewidths=0.2,
        )  # fmt: skip
        drawn.set_clim(0.0, 1.5)
        axis.add_collection(drawn)
    reach = 2.2 * a
    axis.set_xlim(-reach, reach)
    axis.set_ylim(-reach, reach)
    axis.set_aspect("equal")
    made.colorbar(drawn, ax=axis, label="von Mises stress / Sy_min", shrink=0.85, extend="max")
    finish(axis, x="r/R", y="z/R")


def _yielded(field: Field, a: float) -> str:
    """What has yielded in either body, by its plastic strain."""
    told = []
    middles = field.corners.mean(axis=1)
    for name, mine in (("sphere", field.sphere), ("flat", ~field.sphere)):
        plastic = mine & (field.plastic > 1e-5)
        if not np.any(plastic):
            told.append(
                f"the {name} has not yielded (at most {field.stress[mine].max():.2f} Sy_min)"
            )
            continue
        wide = float(middles[plastic, 0].max()) / a
        deep = float(np.abs(middles[plastic, 1]).max()) / a
        strain = 100.0 * float(field.plastic[plastic].max())
        told.append(
            f"the {name} has yielded to {wide:.2f} a sideways and {deep:.2f} a deep, by up to "
            f"{strain:.2g} %"
        )
    return f"{told[0][0].upper()}{told[0][1:]}; {told[1]}."
