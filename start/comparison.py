"""`dentscope.compare_laws(...)`: the contact laws side by side for one pair, and which to use."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..core.arrays import one_number
from ..core.errors import InputError
from ..core.inputs.input_file import path_of
from ..core.material import Pair
from ..core.output import figure
from ..core.tables import frame, html_table, text_table
from ..models import LAWS, Laws, laws_named
from ..models.base import ContactLaw, unwarned
from ..models.choose import Demand, demand, follows_flow, past_curves, strains_under
from .case_file import metal_keys, read_pair
from .judged import CURVE_POINTS, ELASTIC, USABLE, Departure, Reference, judged
from .measured import KEPT_ROUND_OFF

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# limit: laws that are recommended [-]
_RECOMMENDED = 4

USED = metal_keys("sphere") | metal_keys("flat") | {"radius_m", "load.max_delta_over_R"}
"""Keys of CASE.toml that a law answers for."""


class LawRow(NamedTuple):
    """One law at one depth; SI."""

    law: str
    delta_over_R: float
    delta_m: float
    force_N: float
    contact_radius_m: float
    mean_pressure_over_Symin: float
    residual_sphere_m: float
    residual_flat_m: float


@dataclass(frozen=True)
class LawComparison:
    """Laws on one pair, those to use first.

    - `pair`, `need`: the two bodies, and what they ask of a law at the largest depth.
    - `best`: names of the laws to use, best first.
    - `reference`: the solved pair that they are judged by; none where nothing yields, and Hertz's
      force with finite strain added is the judge.
    - `departures`: by law, how far it is from the finite elements of that pair, or from that force.
    - `rows`: every law from below first yield to the largest depth.
    """

    pair: Pair
    need: Demand
    best: tuple[str, ...]
    reference: Reference | None
    departures: dict[str, Departure]
    rows: tuple[LawRow, ...]

    @property
    def finding(self) -> str:
        """Which laws to use, and what the pair asks of them."""
        last = self.rows[-1].delta_over_R
        use = ", ".join(f"{name} ({self.told(name)})" for name in self.best)
        by = f"; judged at all depths by {ELASTIC}"
        deep = f"{self.need.w:.4g} times the depth of first yield"
        if not np.isfinite(self.pair.Sy_min):
            deep = "neither body yields"
        if self.reference:
            deepest = self.reference.deepest
            beyond = f"; solved to Delta/R = {deepest:.2g}, not judged beyond"
            by = f"; judged at all depths by {self.reference.told}{beyond * (last > deepest)}"
        end = self.last_rows()[0]
        left = end.residual_sphere_m, end.residual_flat_m
        return "\n".join((
            f"use: {use or 'none of these laws holds here'}",
            f"at Delta/R = {last:g}: {deep}; regime: {self.need.regime}{by}",
            *past_curves(self.pair, strains_under(self.pair, end.contact_radius_m, left)),
        ))  # fmt: skip

    def told(self, law: str) -> str:
        """How far a law is from the finite elements, in words."""
        found = self.departures.get(law)
        return found.told if found else "of one pair, not judged"

    def last_rows(self) -> list[LawRow]:
        """Each law at the largest depth, the nearest to the finite elements first."""
        ends = list({row.law: row for row in self.rows}.values())
        if not self.departures:
            return sorted(ends, key=lambda r: r.law not in self.best)
        far = {name: one.worst for name, one in self.departures.items()}
        return sorted(ends, key=lambda r: (round(far.get(r.law, 0.0), 3), r.law != "fitted"))

    def table(self) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
        """Return head and cells of the laws at the largest depth."""
        pressure = "p/Sy_min" if np.isfinite(self.pair.Sy_min) else "p/E'"
        head = ("law", "F [N]", "a [mm]", pressure, "left [um]", "largest departure")
        last = self.last_rows()
        kept = [row.residual_sphere_m + row.residual_flat_m for row in last]
        cells: list[tuple[str, ...]] = [
            (
                row.law, f"{row.force_N:.4g}", f"{row.contact_radius_m * 1e3:.4g}",
                f"{row.mean_pressure_over_Symin:.3f}",
                f"{left * 1e6 if left > KEPT_ROUND_OFF * row.delta_m else 0.0:.4g}",
                self.told(row.law),
            )
            for row, left in zip(last, kept, strict=True)
        ]  # fmt: skip
        return head, cells

    def frame(self) -> Any:
        """Return all rows as a pandas data frame, SI."""
        return frame(row._asdict() for row in self.rows)

    def plot(self) -> Figure:
        """Return force over Hertz's, mean pressure, contact radius and residual depth.

        The laws to use stand in colour, the others thin and grey.
        """
        made, axes = figure(2, 2, size=(10.0, 7.2))
        pair = self.pair
        stiffness = 4.0 / 3.0 * pair.E_reduced * np.sqrt(pair.R)
        names = list(dict.fromkeys(row.law for row in self.rows))
        others = [name for name in names if name not in self.best]
        for k, name in enumerate((*others, *reversed(self.best))):
            x, d, force, a, p, s, f = np.array([r[1:] for r in self.rows if r.law == name]).T
            look: dict[str, Any] = {"color": "0.75", "lw": 0.9, "label": None if k else "others"}
            if name in self.best:
                # a law that hides another lies on it as the thinner line
                i = self.best.index(name)
                look = {"color": f"C{i}", "lw": 2.0 + 1.5 * i, "label": name, "zorder": 3.0}
            for axis, y in zip(
                axes.flat, (force / (stiffness * d**1.5), p, a / pair.R, (s + f) / d), strict=True
            ):
                axis.semilogx(x, y, **look)
        for axis, label, top in zip(
            axes.flat,
            ("force over Hertz's [-]", "pressure over the weaker strength [-]",
             "contact radius over R [-]", "residual over largest depth [-]"),
            (1.6, 5.0, None, 1.0), strict=True,
        ):  # fmt: skip
            axis.set(xlabel="approach over R [-]", ylabel=label, ylim=(0.0, top))
            axis.grid(alpha=0.3)
        handles, labels = axes[0, 0].get_legend_handles_labels()
        axes[0, 0].legend(
            handles[::-1], labels[::-1], title="best first", fontsize=8, title_fontsize=8
        )
        made.suptitle(textwrap.fill(self.finding.replace("\n", "; "), 120), fontsize=10)
        return made

    def __repr__(self) -> str:
        head, cells = self.table()
        return f"{self.finding}\n{text_table([head, *cells], numbers=True)}"

    def _repr_html_(self) -> str:
        return html_table(*self.table(), title=self.finding)


def compare_laws(
    pair: Pair | str | Path,
    *,
    law: Laws = (),
    max_delta_over_R: float | None = None,
) -> LawComparison:
    """Compare contact laws on a pair of one's own; `best`, `departures`, `plot()`, `frame()` tell.

    Parameters
    ----------
    pair
        The two bodies, or a CASE.toml as `dentscope case --new` writes it.
    law
        A law or several, by name or as they are; by default all.
    max_delta_over_R
        Largest approach over R; by default the file's, and 0.01 for a pair.

    Raises
    ------
    InputError
        A mistake in the file, an unknown law, or a depth outside 0 to 0.5.

    Examples
    --------
    >>> from dentscope.core import Material, Pair
    >>> soft, hard = Material(E=200e9, nu=0.3, Sy=300e6), Material(E=200e9, nu=0.3, Sy=3e9)
    >>> compare_laws(Pair(hard, soft, 1e-2), law=["hertz", "fitted"]).best
    ('fitted',)
    """
    last = 0.01
    if max_delta_over_R is not None:
        max_delta_over_R = one_number(max_delta_over_R, key="max_delta_over_R")
    if not isinstance(pair, Pair):
        content, pair = read_pair(path_of(pair, key="pair", allowed="a pair, or CASE.toml"))
        last = content.load.max_delta_over_R
    last = last if max_delta_over_R is None else max_delta_over_R
    if not 1e-12 <= last <= 0.5:
        raise InputError(f"{last:g}", key="max_delta_over_R", allowed="1e-12 to 0.5")
    return compared(pair, laws_named(law) or list(LAWS.values()), last=last)


def compared(pair: Pair, laws: Sequence[ContactLaw], *, last: float) -> LawComparison:
    """Compare these laws up to an approach of `last` R."""
    need = demand(pair, last * pair.R)
    reference, departures = judged(pair, laws, last=last)
    best = _best(pair, laws, departures) if reference else _elastic(departures)
    return LawComparison(pair, need, best, reference, departures, _rows(pair, laws, last))


def _best(
    pair: Pair, laws: Sequence[ContactLaw], departures: dict[str, Departure]
) -> tuple[str, ...]:
    """Laws within `USABLE` of the finite elements, nearest first; ours of the same number first."""
    # where a metal hardens, a law that does not know it is near by chance
    known = [law.name for law in laws if pair.perfectly_plastic or follows_flow(law)]
    near = [name for name in known if name in departures and departures[name].worst <= USABLE]
    near.sort(key=lambda name: (round(departures[name].worst, 3), name != "fitted"))
    return tuple(near[:_RECOMMENDED])


def _elastic(departures: dict[str, Departure]) -> tuple[str, ...]:
    """Hertz's law, of which all others are copies; ours where finite strain is 1 % or more."""
    ours = {"hertz": 0, "fitted": 1}  # of those that are as near
    near = sorted(departures, key=lambda one: (round(departures[one].worst, 2), ours.get(one, 2)))
    return tuple(near[:1])


def _rows(pair: Pair, laws: Sequence[ContactLaw], last: float) -> tuple[LawRow, ...]:
    deepest = last * pair.R
    first = min(0.3 * pair.first_yield * pair.R, 1e-2 * deepest)
    depth = np.geomspace(first, deepest, CURVE_POINTS)
    scale = pair.Sy_min if pair.Sy_min < float("inf") else pair.E_reduced
    rows: list[LawRow] = []
    for law in laws:
        with unwarned():
            force, a = law.loading(pair, depth), law.contact_radius(pair, depth)
            pressure = law.hardness(pair, depth) / scale
            sphere, flat = law.residual(pair, depth)
        if not np.all(np.isfinite(force)):
            raise InputError(f"{law.name} has no finite force for this pair", key="law")
        columns = (depth / pair.R, depth, force, a, pressure, sphere, flat)
        rows += [LawRow(law.name, *map(float, row)) for row in zip(*columns, strict=True)]
    return tuple(rows)
