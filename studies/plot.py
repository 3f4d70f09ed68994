"""What all figures share: the picture with its line, colours, finite elements beside."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from ..campaigns import CaseRecord
from ..core.material import Pair
from ..core.output import write_figure
from ..models import LAWS
from ..models.base import ContactLaw


class Line(NamedTuple):
    """How a law is drawn in every figure, also in words."""

    colour: str
    colour_told: str
    dashes: Any
    dashes_told: str
    width: float = 1.4


_DASHED, _DOTTED, _DASH_DOT = (0, (5, 2)), (0, (1.2, 1.4)), (0, (6, 1.5, 1.2, 1.5))
LINES = {
    "hertz": Line("0.6", "grey", "-", "solid"),
    "jackson-green": Line("C0", "blue", _DASHED, "dashed"),
    "jackson-green-2007": Line("C0", "blue", "-", "solid"),
    "kogut-etsion": Line("C1", "orange", "-", "solid"),
    "kogut-etsion-continued": Line("C1", "orange", _DASHED, "dashed"),
    "kogut-komvopoulos": Line("C2", "green", "-", "solid"),
    "ye-komvopoulos": Line("C4", "purple", _DASH_DOT, "dash-dotted"),
    "brake-2015": Line("C5", "brown", "-", "solid"),
    "brake-2012": Line("C6", "pink", _DASHED, "dashed"),
    "stronge": Line("C8", "olive", _DOTTED, "dotted", 2.0),
    "thornton": Line("C9", "cyan", "-", "solid"),
    "thornton-ning": Line("C9", "cyan", _DASHED, "dashed"),
    "ghaednia": Line("C3", "red", "-", "solid, thick", 3.2),
    "fitted": Line("k", "black", _DASHED, "dashed", 1.6),
}
"""What lies under a law shows beside it or through its gaps: the thick one is drawn first, those
that often coincide with another are broken."""


@dataclass(frozen=True, slots=True)
class Picture:
    """One redrawn figure.

    `number`: the thesis's figure number, or a name of our own; `title`: what it shows; `made`: the
    figure; `note`: one or two sentences: agrees, differs by how much, why.
    """

    number: str
    title: str
    made: Figure
    note: str

    @property
    def file(self) -> str:
        """Name of the PNG file."""
        return f"figure-{self.number.replace('.', '-').replace(' ', '')}.png"

    def save(self, folder: Path) -> Path:
        """Write the PNG into `folder`."""
        return write_figure(self.made, folder / self.file, dpi=110, metadata={"Software": None})


@dataclass(frozen=True, slots=True)
class Table:
    """One table of the thesis with our numbers.

    `number`: the thesis's table number; `title`: what it shows; `header`: names of the columns,
    with units; `rows`: cells as text; `note`: agrees, differs by how much, why.
    """

    number: str
    title: str
    header: tuple[str, ...]
    rows: Sequence[Sequence[str]]
    note: str


Entry = Picture | Table
"""What a chapter of the gallery is made of."""


def sheet(columns: int = 1, *, size: tuple[float, float] = (6.4, 4.6)) -> tuple[Figure, list[Any]]:
    """Return an off-screen figure and its axes in one row."""
    made = bare_sheet((size[0] * columns, size[1]))
    return made, list(made.subplots(1, columns, squeeze=False)[0])


def bare_sheet(size: tuple[float, float]) -> Figure:
    """Return an off-screen figure without axes, `size` in inches."""
    return Figure(figsize=size, layout="constrained")


def finish(axis: Any, *, x: str, y: str, legend: str = "") -> None:
    """Label an axis; `legend` is the title of its legend."""
    axis.set_xlabel(x)
    axis.set_ylabel(y)
    axis.grid(alpha=0.3)
    handles, _ = axis.get_legend_handles_labels()
    if handles:
        # a long legend would hide curves
        beside = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0)} if len(handles) > 4 else {}
        axis.legend(fontsize=7, title=legend or None, title_fontsize=7, **beside)


def laws(*names: str) -> list[ContactLaw]:
    """Return the laws of these names that there are."""
    return [LAWS[name] for name in names if name in LAWS]


def look(law: ContactLaw) -> dict[str, Any]:
    """Colour, dashes, width, order and label of a law's curve."""
    line = line_of(law)
    # thick ones below, broken ones above
    order = 2.0 + 0.1 * (line.dashes != "-") - 0.05 * line.width
    return {
        "color": line.colour, "ls": line.dashes, "lw": line.width, "zorder": order,
        "label": law.name,
    }  # fmt: skip


def line_of(law: ContactLaw) -> Line:
    """How a law is drawn; a joined one as its loading."""
    return LINES.get(law.name.split("+")[0], Line("0.4", "grey", "-", "solid"))


def same(record: CaseRecord, pair: Pair, *, within: float = 0.02) -> bool:
    """Whether a stored case is this pair up to scale (nu within 0.01)."""
    mine, theirs = (_groups(p) for p in (pair, record.case.pair))
    return bool(np.allclose(mine[:3], theirs[:3], rtol=within) and np.allclose(
        mine[3:], theirs[3:], atol=0.011
    ))  # fmt: skip


def _groups(pair: Pair) -> list[float]:
    s, f = pair.sphere, pair.flat
    stiff = [1e9 if b.rigid else b.E / pair.Sy_min for b in (s, f)]
    nus = [0.0 if b.rigid else b.nu for b in (s, f)]
    return [*stiff, min(max(pair.Sy_ratio, 1e-3), 1e3), *nus]


def at_depth(record: CaseRecord, D: float) -> dict[str, float]:
    """A stored curve at Delta/R = `D`: force, radius, sphere share, hardness; nan beyond it."""
    R = record.case.pair.R
    x = record.curve["delta"] / R
    if not x[0] <= D <= x[-1]:
        return {}
    names = ("force", "radius", "sphere", "hardness")
    return {n: float(np.interp(D, x, record.curve[n])) for n in names}


def solved(records: Sequence[CaseRecord]) -> str:
    """Return what the finite elements of a figure rest on."""
    return f"{len(records)} solved cases" if records else "no campaign was found beside it"


def percent(value: float) -> str:
    """Deviation for a note, with sign."""
    return f"{value:+.1%}"
