"""A campaign as one table of dimensionless rows, the ground that every fit stands on."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Self

import numpy as np

from ..campaigns import CaseRecord, read_curves
from ..campaigns.records import scaled
from ..core.arrays import Array, Integers, Mask
from ..core.errors import InputError
from ..core.material import Pair
from ..models import critical_depth
from ..models.closed_form import Bodies
from ..models.fitted import bodies_of
from ..models.table import energy_exponent
from .rules import RULES

Sources = Mapping[Path, Sequence[CaseRecord]]
"""Runs and published parts, each with its completed cases."""

HELD_OUT = ("validation", "challenge")
"""Cases whose name begins so are for judging a finished fit; no fit reads them."""

# limit: number from which a case of `space` judges too [-]: half of a Sobol design, one itself
_SECOND_HALF = 128

_COARSEST = "smoke"


@dataclass(frozen=True, eq=False)
class CaseRows:
    """Rows of all cases; every array has shape (n,) and is dimensionless.

    - `case`: number of the material combination that the row belongs to.
    - `D`: Delta/R.
    - `w`: delta/delta_c.
    - `pairs`, `names`: pair and name of each case, length n_cases.
    """

    case: Integers
    D: Array
    w: Array
    pairs: tuple[Pair, ...] = field(kw_only=True)
    names: tuple[str, ...] = field(kw_only=True)

    @cached_property
    def bodies(self) -> Bodies:
        """What the closed form needs of each case's bodies, every field of shape (n_cases,)."""
        return bodies_of(self.pairs)

    def rows(self, mask: Mask) -> Self:
        """Return the rows of `mask`; the cases keep their numbers."""
        arrays: dict[str, Any] = {
            k: v[mask] for k, v in vars(self).items() if isinstance(v, np.ndarray)
        }
        return replace(self, **arrays)


@dataclass(frozen=True, eq=False)
class Table(CaseRows):
    """Loading rows: `case`, `D`, `w`, `pairs` and `names` as of `CaseRows`.

    - `force`: F/(E' R^2).
    - `radius`: a/R.
    - `share`: delta_s*.
    - `edge_seen`: whether the opening gap beside the contact was wide enough to be fitted. Where it
      was not, the radius is that of a node, up to an element too small, and the surface that can
      touch ends close by: force and radius of such a row are not fitted.
    """

    force: Array
    radius: Array
    share: Array
    edge_seen: Mask

    @property
    def hardness(self) -> Array:
        """Mean pressure over Sy_min."""
        modulus = np.array([p.E_reduced / p.Sy_min for p in self.pairs])
        return np.asarray(self.force / (np.pi * self.radius**2) * modulus[self.case])


@dataclass(frozen=True)
class ResidualTable(CaseRows):
    """Unloadings as `CaseRows`, `D` and `w` those of the turning point.

    - `total`: permanent approach over the largest one.
    - `sphere_part`: the sphere's part of the permanent approach.
    - `exponent`: N of F/F_m = ((Delta - Delta_r)/(Delta_m - Delta_r))^N, so that the elastic energy
      is right.
    """

    total: Array
    sphere_part: Array
    exponent: Array


def read_sources(paths: Iterable[Path]) -> Sources:
    """Read runs and published parts, each once."""
    return {path: read_curves(path) for path in paths}


def tables_of(sources: Sources, *, held_out: bool = False) -> tuple[Table, ResidualTable]:
    """Return the two tables of runs and published parts; without a completed case refuse them.

    A combination that several cases solve counts once: by the one that the present solver made, of
    these by the one of most unloadings, else by the latest. With `held_out` only the cases that are
    kept out of every fit are read. Cases of the lowest resolution, whose force ripples by percents,
    count only where none is finer. Metals that harden or feel the rate are left out: the forms know
    neither.
    """
    chosen: dict[object, CaseRecord] = {}
    asked = [r for of in sources.values() for r in of if is_held_out(r) == held_out]
    found = [r for r in asked if r.case.pair.perfectly_plastic and np.isfinite(r.case.pair.Sy_min)]
    fine = [r for r in found if r.case.accuracy.level != _COARSEST]
    for record in fine or found:
        key = tuple(np.round(_key(record.case.pair), 9))
        if key not in chosen or _worth(record) >= _worth(chosen[key]):
            chosen[key] = record
    if not chosen:
        raise InputError(
            "no completed elastic-plastic case"
            + (f" named {' or '.join(HELD_OUT)}-..." if held_out else ""),
            source=", ".join(map(str, sources)),
            allowed="a finished campaign",
        )
    records = list(chosen.values())
    return _loading(records), _residuals(records)


def is_held_out(record: CaseRecord) -> bool:
    """Whether a case is kept out of every fit."""
    design, _, number = record.case.name.partition("-")
    second = design == "space" and number.isdigit() and int(number) >= _SECOND_HALF
    return second or record.case.name.startswith(HELD_OUT)


def is_current(record: CaseRecord) -> bool:
    """Whether the present version of the solver made this case: it is part of a case's identity."""
    return record.id == record.case.id


def _worth(record: CaseRecord) -> tuple[bool, int]:
    return is_current(record), len(record.unloadings)


def _key(pair: Pair) -> Array:
    E, b = pair.E_reduced, bodies_of([pair])
    return np.ravel([b.k_s * E, b.nu_s, b.nu_f, b.q_s * E, b.q_f * E, b.k_f * E])


def _loading(records: list[CaseRecord]) -> Table:
    parts = []
    for number, record in enumerate(records):
        p, c = record.case.pair, record.curve
        usable = c["radius"] <= RULES.form_radius * p.R
        D, *others = scaled(record)
        seen = c["radius"] != c["radius_last_node"]
        columns = (np.full(len(D), number), D, c["delta"] / critical_depth(p), *others, seen)
        parts.append([column[usable] for column in columns])
    return Table(*map(np.concatenate, zip(*parts, strict=True)), **_who(records))


def _who(records: Iterable[CaseRecord]) -> dict[str, Any]:
    return {
        "pairs": tuple(r.case.pair for r in records),
        "names": tuple(r.case.name for r in records),
    }


def _residuals(records: list[CaseRecord]) -> ResidualTable:
    rows = []
    for number, record in enumerate(records):
        p = record.case.pair
        for u in record.unloadings:
            total = u.residual_sphere + u.residual_flat
            depth = u.depth * p.R
            if not 0.0 < total < depth or u.curve["radius"][0] > RULES.form_radius * p.R:
                continue
            exponent = energy_exponent(u.curve["delta"], u.curve["force"], total)
            left = (total / depth, u.residual_sphere / total)
            rows.append((number, u.depth, depth / critical_depth(p), *left, exponent))
    columns = np.array(rows).reshape(-1, 6).T
    return ResidualTable(columns[0].astype(np.int64), *columns[1:], **_who(records))
