"""Chapters 4 and 5: the oblique rod, and what its scar tells."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ....campaigns import CaseRecord
from ....dynamics.inverse import alpha
from ...plot import Entry, Picture, finish, sheet
from .. import chapter5
from . import chapter4, tables
from .claims import judged


def pictures(records: Sequence[CaseRecord]) -> list[Entry]:
    """Redraw figures and tables; nothing here needs finite elements."""
    return [
        tables.properties("4.1"),
        tables.legend(chapter4.NINE),
        *chapter4.pictures(),
        _alpha(),
        *(tables.comparison(f"5.{k}", angle) for k, angle in ((2, 20.0), (3, 45.0), (4, 70.0))),
    ]  # fmt: skip


def _alpha() -> Picture:
    made, (axis,) = sheet()
    angles = np.radians(np.linspace(0.2, 89.8, 400))
    rod = chapter5.thesis_rod()
    sticks = {}
    for mu in (0.0, 0.1, 0.2, 0.5, 1.0):
        values = np.array([alpha(rod, float(angle), mu=mu) for angle in angles])
        sticks[mu] = values > 0.0
        jam = np.abs(np.diff(values, append=values[-1])) > 5.0
        axis.plot(np.degrees(angles), np.where(jam, np.nan, values), label=f"friction {mu:g}")
    axis.axhline(0.0, color="k", lw=0.8)
    axis.set_ylim(-1.5, 1.5)
    finish(axis, x="angle [degrees]", y="alpha (below zero: sliding)")
    small = [f"{mu:g}" for mu in (0.1, 0.2, 0.5) if sticks[mu][0]]
    note = (
        "Drawn with the corrected 5.12. No change of sign without friction, one at 82 degrees for "
        "0.1, two for 0.2 and 0.5. "
    ) + judged(
        ("the sign changes at large angles", all(sticks[mu][-1] for mu in (0.1, 0.2, 0.5))),
        (f"it changes at small angles too, for any friction (here for {', '.join(small)})",
         len(small) == 3),
        ("the more friction, the more angles stick",
         bool(np.all(np.diff([np.mean(s) for s in sticks.values()]) > 0.0))),
        ("with 1 it always sticks", bool(np.all(sticks[1.0]))),
    )  # fmt: skip
    return Picture("5.3", "Sliding per normal travel", made, note)
