"""What stays of a contact: the published craters, by the groups that their shape depends on.

A sphere of the recovered radius (K. L. Johnson, Contact Mechanics, 1985, 6.4) lies within a tenth
of the depth only where a hard ball has left more than seven tenths of its approach, and knows no
rim. Craters of the finite elements, over the radius of contact and the depth left in the body, lie
so close together that those of the nearest pairs give it: their mean by the inverse squares of
their distances, as many as make a simplex in the groups. A crater of a pair that is left out lies
within 7 % of its depth at nine of ten, 10 % at nineteen of twenty, rim and wall alike, where its
body keeps a twentieth of what stays.
"""

from __future__ import annotations

import json
import math
from functools import cache
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from ..campaigns.case import Case
from ..campaigns.contents import read_array
from ..campaigns.parts import opened_part, published_parts, texts_of
from ..core.arrays import Array, Integers
from ..core.material import Material, Pair
from ..fem.rules import RULES as FEM
from ..models.uncertainty import LEAST

Body = Literal["sphere", "flat"]
PLACES = np.linspace(0.0, 1.5, 31)
"""Distances from the middle, over the radius of contact."""
_TABLES: dict[Body, str] = {"sphere": "tip", "flat": "crater"}


class Left(NamedTuple):
    """What a contact has left.

    `radius`: of the contact at its deepest [m]; `depth`: deepest approach [m]; `sphere`, `flat`:
    permanent displacement of each pole [m].
    """

    radius: float
    depth: float
    sphere: float
    flat: float

    def of(self, body: Body) -> float:
        """What stays in one body [m]; 0 where it keeps less than a thousandth."""
        own = self.sphere if body == "sphere" else self.flat
        return own if own > FEM.least_dent * max(self.sphere + self.flat, 0.0) else 0.0


class CraterShape(NamedTuple):
    """Height over the surface that was, over the depth left: -1 in the middle.

    `height`, `std`: at `PLACES`, and its standard deviation; `near`: whether the nearest published
    crater is no further than one spread of them all.
    """

    height: Array
    std: Array
    near: bool


class _Craters(NamedTuple):
    groups: Array  # (n, groups), over their spreads
    spread: Array
    heights: Array  # (n, places)
    pair: Integers  # which pair each is of


def crater_shape(pair: Pair, left: Left, body: Body, *, without: int = -1) -> CraterShape:
    """Return the crater that a contact leaves in one body, which has to keep something.

    `without` is the number of a published pair that is left out. Refused where the published cases
    are missing or damaged.
    """
    known = _published(body)
    own = _groups(pair, left, body) / known.spread
    # a rigid partner, beyond the moduli of the published ones, changes no more than 5 % of a crater
    shares = known.groups[:, 0]
    own[0] = np.clip(own[0], shares.min(), shares.max())
    away = np.sum((known.groups - own) ** 2, axis=1)
    away[known.pair == without] = math.inf
    nearest = np.argsort(away)[: known.groups.shape[1] + 1]
    part = 1.0 / np.maximum(away[nearest], np.finfo(float).eps)
    part /= part.sum()
    height = part @ known.heights[nearest]
    spread = np.sqrt(part @ (known.heights[nearest] - height) ** 2)
    std = np.where(PLACES > 0.0, np.hypot(LEAST, spread), 0.0)
    return CraterShape(height, std, bool(away[nearest[0]] <= 1.0))


def _groups(pair: Pair, left: Left, body: Body) -> Array:
    """What the shape depends on, the elastic share first; strengths at Tabor's strain, 0.2 a/R."""
    a = left.radius / pair.R
    own_first = (pair.sphere, pair.flat)[:: 1 if body == "sphere" else -1]
    (ours, exponent), (theirs, _) = (_strength(metal, 0.2 * a) for metal in own_first)
    share = pair.elastic_share if body == "sphere" else 1.0 - pair.elastic_share
    whole = left.sphere + left.flat
    weaker = 1.0 if math.isinf(theirs) else theirs / (ours + theirs)
    return np.array([
        share, weaker, math.log(pair.E_reduced / ours), math.log(a), math.log(whole / left.depth),
        exponent, math.log(left.of(body) / whole),
    ])  # fmt: skip


def _strength(metal: Material, strain: float) -> tuple[float, float]:
    """Flow stress at a plastic strain [Pa], and its exponent there."""
    curve = metal.flow.curve if metal.flow else None
    if curve is None:
        return metal.strength, 0.0
    here, beyond = curve(strain), curve(1.3 * strain)
    return here, math.log(beyond / here) / math.log(1.3)


@cache
def _published(body: Body) -> _Craters:
    rows = [
        (number, _groups(pair, left, body), height)
        for number, pair, left, heights in _read()
        if (height := heights.get(body)) is not None
    ]
    pairs, groups, shapes = zip(*rows, strict=True)
    spread = np.std(groups, axis=0)
    return _Craters(np.array(groups) / spread, spread, np.array(shapes), np.array(pairs))


@cache
def _read() -> tuple[tuple[int, Pair, Left, dict[Body, Array]], ...]:
    """Number of the pair, the pair, what was left, and the shapes; of every published unloading."""
    found: list[tuple[int, Pair, Left, dict[Body, Array]]] = []
    numbers: dict[Pair, int] = {}
    for path in published_parts():
        found += _of_part(path, numbers)
    return tuple(found)


def _of_part(
    path: Path, numbers: dict[Pair, int]
) -> list[tuple[int, Pair, Left, dict[Body, Array]]]:
    out = []
    with opened_part(path) as file:
        told = [json.loads(text) for text in texts_of(file, "specification")]
        pairs = [Case.from_specification(one).pair for one in told]
        number = [numbers.setdefault(pair, len(numbers)) for pair in pairs]
        table = {k: read_array(file["unloadings"][k]) for k in file["unloadings"]}
        curve = file["unloading_curves"]
        first = np.searchsorted(read_array(curve["unloading"]), np.arange(len(table["case"])))
        radius, delta = (read_array(curve[k])[first] for k in ("radius", "delta"))
        surfaces: dict[Body, list[Array]] = {
            body: [
                read_array(file[f"{name}s"][k]).astype(float)
                for k in ("unloading", f"{name}_r", f"{name}_z")
            ]
            for body, name in _TABLES.items()
        }
        for k, case in enumerate(table["case"]):
            pair = pairs[case]
            left = Left(
                float(radius[k]), float(delta[k]), float(table["residual_sphere"][k]),
                float(table["residual_flat"][k]),
            )  # fmt: skip
            if not left.sphere + left.flat > FEM.least_dent * left.depth:
                continue
            heights: dict[Body, Array] = {}
            for body, (owner, r, z) in surfaces.items():
                mine = slice(*np.searchsorted(owner, (k, k + 1)))
                if left.of(body) > 0.0:
                    heights[body] = _over_the_depth(body, r[mine], z[mine], left, pair.R)
            out.append((number[case], pair, left, heights))
    return out


def _over_the_depth(body: Body, r: Array, z: Array, left: Left, R: float) -> Array:
    if body == "sphere":  # towards the flat is down, and the pole was at 0
        r = np.minimum(r, R)
        z = R - np.sqrt(R**2 - r**2) - z
    return np.interp(PLACES * left.radius, r, z) / left.of(body)
