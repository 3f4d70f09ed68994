"""A campaign as one table of dimensionless rows, the ground that every fit stands on."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ..campaigns import CaseRecord, read_curves
from ..core.errors import InputError
from ..core.material import Pair
from ..models import critical_depth

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Table:
    """Loading rows of all cases; every array has shape (n,) and is dimensionless.

    Parameters
    ----------
    case
        Number of the material combination that the row belongs to.
    ratio
        Sy* = S_ys/S_yf.
    modulus
        E'/Sy_min.
    elastic_share
        E'(1 - nu_s^2)/E_s (2.3).
    D
        Delta/R.
    w
        Delta/delta_c.
    force
        F/(E' R^2).
    radius
        a/R.
    share
        delta_s*.
    edge_seen
        Whether the opening gap beside the contact was wide enough to be fitted. Where it was not,
        the radius is that of a node, up to an element too small, and the surface that can touch
        ends close by: force and radius of such a row are not fitted.
    pairs
        Pair of each case, shape (n_cases,).
    """

    case: npt.NDArray[np.int64]
    ratio: Floats
    modulus: Floats
    elastic_share: Floats
    D: Floats
    w: Floats
    force: Floats
    radius: Floats
    share: Floats
    edge_seen: npt.NDArray[np.bool_]
    pairs: tuple[Pair, ...]

    def rows(self, mask: npt.NDArray[np.bool_]) -> Table:
        """Return the rows of `mask`."""
        columns = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "pairs"}
        return Table(**{name: c[mask] for name, c in columns.items()}, pairs=self.pairs)


@dataclass(frozen=True)
class ResidualTable:
    """Unloadings of all cases; every array has shape (n,) and is dimensionless.

    Parameters
    ----------
    case, ratio, modulus, D, w
        As in `Table`, at the turning point.
    total
        Permanent approach over the largest one.
    sphere_part
        The sphere's part of the permanent approach.
    """

    case: npt.NDArray[np.int64]
    ratio: Floats
    modulus: Floats
    D: Floats
    w: Floats
    total: Floats
    sphere_part: Floats


def read_tables(path: Path) -> tuple[Table, ResidualTable]:
    """Read a campaign file into the two tables.

    Raises
    ------
    InputError
        The file is missing, damaged, or holds no completed elastic-plastic case.
    """
    records = [r for r in read_curves(path) if np.isfinite(r.case.pair.Sy_min)]
    if not records:
        raise InputError(
            "no completed elastic-plastic case", source=str(path), allowed="a finished campaign"
        )
    return _loading(records), _residuals(records)


def _loading(records: list[CaseRecord]) -> Table:
    columns: list[list[Floats]] = [[] for _ in range(10)]
    for number, record in enumerate(records):
        p, c = record.case.pair, record.curve
        n = len(c["delta"])
        D = c["delta"] / p.R
        values = (
            np.full(n, number),
            np.full(n, p.Sy_ratio),
            np.full(n, p.E_reduced / p.Sy_min),
            np.full(n, p.elastic_share),
            D,
            c["delta"] / critical_depth(p),
            c["force"] / (p.E_reduced * p.R**2),
            c["radius"] / p.R,
            c["sphere"] / (c["sphere"] + c["flat"]),
            c["radius"] != c["radius_last_node"],
        )
        for column, value in zip(columns, values, strict=True):
            column.append(value)
    case, ratio, modulus, elastic, D, w, force, radius, share, seen = map(np.concatenate, columns)
    return Table(
        case=case.astype(np.int64),
        ratio=ratio,
        modulus=modulus,
        elastic_share=elastic,
        D=D,
        w=w,
        force=force,
        radius=radius,
        share=share,
        edge_seen=seen.astype(bool),
        pairs=tuple(r.case.pair for r in records),
    )


def _residuals(records: list[CaseRecord]) -> ResidualTable:
    rows = []
    for number, record in enumerate(records):
        p = record.case.pair
        for u in record.unloadings:
            total = u.residual_sphere + u.residual_flat
            if total <= 0.0:
                continue
            depth = u.depth * p.R
            rows.append(
                (
                    number,
                    p.Sy_ratio,
                    p.E_reduced / p.Sy_min,
                    u.depth,
                    depth / critical_depth(p),
                    total / depth,
                    u.residual_sphere / total,
                )
            )
    columns = np.array(rows).reshape(-1, 7).T
    return ResidualTable(columns[0].astype(np.int64), *columns[1:])
