"""`dentscope.case(...)`: a pair solved by finite elements, with its uncertainty."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import fem
from ..core.arrays import numbers, one_number
from ..core.errors import InputError
from ..core.inputs.input_file import path_of
from ..core.inputs.toml_input import parse_model
from ..core.material import Pair
from ..core.output import figure, write_figure
from ..core.rig import FrictionTable, value_of
from ..core.tables import frame, html_table, text_table, thinned
from ..models.choose import past_curves
from .case_file import Level, LoadTable, case_of, read_pair
from .measured import MeasuredContact, measured

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# limit: approach over R of a pair whose depth is not said [-]: shallow enough for a quick solve
_DEPTH = 0.01


@dataclass(frozen=True)
class Solved:
    """A solved pair.

    - `solution`: curves, unloadings, fields.
    - `uncertainty`: of the loading, what its level is off; none where the solve did not begin.
    - `level`: how finely it was solved; "smoke" is coarse, for a first look.
    """

    solution: fem.Solution
    uncertainty: Any
    level: str = ""

    @property
    def measured(self) -> MeasuredContact:
        """What people measure: first yield, pressures, what every unloading leaves."""
        return measured(self.solution)

    @property
    def remark(self) -> str:
        """What its level and an end of a flow curve mean for the numbers; often nothing."""
        told = ["level smoke: coarse, with steps in the curves; quick or production for numbers"]
        for last in self.solution.snapshots[-1:]:
            bodies = np.split(last.plastic_strain, [last.n_sphere_quads])
            strains = (float(strain.max(initial=0.0)) for strain in bodies)
            told += past_curves(self.solution.problem.pair, strains)
        back = (one.outcome for one in self.solution.unloadings)
        told += [str(ending) for ending in back if not ending.completed]
        return "\n".join(told if self.level == "smoke" else told[1:])

    def rows(self) -> list[dict[str, float]]:
        """Return the loading as rows, SI, each value with its uncertainty."""
        c, u = self.solution.loading, self.uncertainty
        R = self.solution.problem.pair.R
        return [
            {
                "delta_over_R": float(c.delta[i] / R),
                "force_N": float(c.force[i]), "force_N_uncertainty": float(u.force[i]),
                "contact_radius_m": float(c.radius[i]),
                "contact_radius_m_uncertainty": float(u.radius[i]),
                "sphere_share": float(c.sphere_share[i]),
            }
            for i in range(len(c.delta))
        ]  # fmt: skip

    def frame(self) -> Any:
        """Return the loading as a pandas data frame."""
        return frame(self.rows())

    def plot(self) -> Figure:
        """Return force, contact radius, the sphere's share and the mean pressure."""
        made, grid = figure(2, 2, size=(9.0, 6.6))
        pair, c, u = self.solution.problem.pair, self.solution.loading, self.uncertainty
        strength = self._scales["Sy_min"]
        over = "weaker strength" if pair.Sy_min < float("inf") else "E'"
        panels: tuple[tuple[Any, Any, str, list[Any]], ...] = (
            (c.force, u.force, "force [N]", [one.curve.force for one in self.solution.unloadings]),
            (1e3 * c.radius, 1e3 * u.radius, "contact radius [mm]",
             [1e3 * one.curve.radius for one in self.solution.unloadings]),
            (c.sphere_share, u.sphere_share, "sphere's share of the approach [-]", []),
            (c.hardness / strength, u.hardness / strength, f"mean pressure over {over} [-]", []),
        )  # fmt: skip
        for k, (axis, (y, error, label, back)) in enumerate(zip(grid.flat, panels, strict=True)):
            x = c.delta / pair.R
            axis.plot(x, y, "C0", label="loading")
            axis.fill_between(x, y - error, y + error, color="C0", alpha=0.25, lw=0.0,
                              label="uncertainty of the mesh")  # fmt: skip
            for n, curve in enumerate(back):
                axis.plot(self.solution.unloadings[n].curve.delta / pair.R, curve, "C1--",
                          label="unloading" if n == 0 else None)  # fmt: skip
            axis.set(xlabel="approach over R [-]", ylabel=label, xscale="linear" if back else "log")
            axis.grid(alpha=0.3)
            if k == 0:
                axis.legend(fontsize=8)
        if self.remark:
            made.suptitle(self.remark, fontsize=10)
        return made

    def plot_fields(self) -> Figure:
        """Return stress and plastic strain at the largest approach."""
        from ..fem.results.fields import section

        if not self.solution.snapshots:
            raise InputError("no depth was reached", key="plot_fields", allowed="a solved pair")
        return section(self.solution.snapshots[-1], **self._scales)

    @property
    def _scales(self) -> dict[str, float]:
        """Of pictures of the fields: the stress that counts as one, and half the width; SI."""
        pair = self.solution.problem.pair
        strength = pair.Sy_min if pair.Sy_min < float("inf") else pair.E_reduced
        return {"Sy_min": strength, "extent": 2.5 * float(self.solution.loading.radius[-1])}

    def draw_fields(self, folder: str | Path, *, cut: bool = False) -> list[Path]:
        """Draw stress and plastic strain at the largest approach; return the files written.

        `fields-*.png`, `fields-*.vtu` for ParaView; with `cut` the bodies cut open, too.
        """
        from ..fem.results.cutaway import draw_cutaway
        from ..fem.results.fields import section, write_vtu

        Path(folder).mkdir(parents=True, exist_ok=True)
        made: list[Path | None] = []
        for one in self.solution.snapshots:
            name = str(Path(folder) / f"fields-{one.depth:.4g}")
            made.append(write_vtu(one, Path(f"{name}.vtu")))
            picture, path = section(one, **self._scales), Path(f"{name}.png")
            made.append(write_figure(picture, path, dpi=140, bbox_inches="tight"))
            if cut:
                made.append(draw_cutaway(one, Path(f"{name}-cut.png"), **self._scales))
        return [path for path in made if path is not None]

    def _shown(self) -> list[list[str]]:
        rows = self.rows()
        cells = [[f"{x:.4g}" for x in rows[i].values()] for i in thinned(len(rows))]
        return [list(rows[0]), *cells] if rows else [["no depth was reached"]]

    def __repr__(self) -> str:
        told = f"{self.solution.outcome} {self.remark}".rstrip()
        return f"{told}\n{text_table(self._shown(), numbers=True)}"

    def _repr_html_(self) -> str:
        head, *cells = self._shown()
        return html_table(head, cells, title=f"{self.solution.outcome} {self.remark}")


def case(
    pair: Pair | str | Path,
    *,
    level: Level | None = None,
    max_delta_over_R: float | None = None,
    unload_from: Sequence[float] = (),
    speed_m_s: float | None = None,
    friction: float | None = None,
) -> Solved:
    """Solve a pair by finite elements; `plot()`, `plot_fields()`, `frame()` show it.

    Parameters
    ----------
    pair
        The two bodies, or a CASE.toml as `dentscope case --new` writes it.
    level
        How finely; by default the file's, and `quick` for a pair.
    max_delta_over_R, unload_from, speed_m_s, friction
        Largest approach over R (0.01 for a pair), approaches over R from which the sphere is drawn
        back, speed of the approach [m/s], coefficient of friction; in place of the file's.

    Raises
    ------
    InputErrors
        One line for each mistake: file, key, value, what is allowed.
    """
    load: dict[str, Any] = {"max_delta_over_R": _DEPTH}
    rubs, source = FrictionTable(), "case"
    if not isinstance(pair, Pair):
        source = str(pair)
        content, pair = read_pair(path_of(pair, key="pair", allowed="a pair, or CASE.toml"))
        load, rubs = content.load.model_dump(exclude_unset=True), content.friction
        level = level or content.accuracy.level
    given = {"max_delta_over_R": max_delta_over_R, "speed_m_s": speed_m_s}
    load |= {k: one_number(x, key=k, source=source) for k, x in given.items() if x is not None}
    back = numbers(unload_from, key="unload_from", allowed="numbers", source=source).ravel()
    if len(back):
        load["unload_from"] = back.tolist()
    if friction is not None:
        rubs = parse_model({"coefficient": friction}, FrictionTable, source=source)
    problem, accuracy = case_of(
        pair, parse_model(load, LoadTable, source=source), value_of(rubs.coefficient, 0.0),
        level=level or "quick", source=source,
    )  # fmt: skip
    return solved(problem, accuracy)


def solved(
    problem: fem.ContactProblem, accuracy: fem.Accuracy,
    report: Callable[[float], None] = lambda _: None,
) -> Solved:  # fmt: skip
    """Solve a pair and state its uncertainty; `report` is told how far it is, from 0 to 1."""
    solution = fem.solve(problem, accuracy=accuracy, progress=report)
    if len(solution.loading.delta) == 0:
        return Solved(solution, None, accuracy.level)
    found = fem.discretisation_uncertainty(solution.loading, problem, accuracy)
    return Solved(solution, found, accuracy.level)
