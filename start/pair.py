"""`dentscope.case(...)`: a pair solved by finite elements, twice for the uncertainty."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import fem
from ..core.tables import frame, html_table
from .case_file import read_case

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Steps(Enum):
    """What a solve consists of."""

    solving = 0
    uncertainty = 1


Report = Callable[[Steps, float], None]


def _silent(step: Steps, done: float) -> None:
    """Tell nobody."""


@dataclass(frozen=True)
class Solved:
    """A solved pair.

    Parameters
    ----------
    solution
        Curves, unloadings, fields.
    uncertainty
        Of the loading, from a second solve with larger elements; none where the solve did not
        begin.
    """

    solution: fem.Solution
    uncertainty: Any

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
        """Return force and contact radius over the approach."""
        from matplotlib.figure import Figure

        rows = self.rows()
        made = Figure(figsize=(8.0, 3.4), layout="constrained")
        x = [row["delta_over_R"] for row in rows]
        for axis, (key, label, scale) in zip(
            made.subplots(1, 2),
            (("force_N", "force [N]", 1.0), ("contact_radius_m", "contact radius [mm]", 1e3)),
            strict=True,
        ):
            axis.errorbar(
                x, [scale * row[key] for row in rows],
                yerr=[scale * row[f"{key}_uncertainty"] for row in rows],
            )  # fmt: skip
            axis.set(xlabel="approach over R [-]", ylabel=label, xscale="log", yscale="log")
            axis.grid(alpha=0.3)
        return made

    def _repr_html_(self) -> str:
        rows = self.rows()
        head = tuple(rows[0]) if rows else ()
        step = max(1, len(rows) // 12)
        cells = ([f"{x:.4g}" for x in row.values()] for row in rows[::step])
        return html_table(head, cells, title=str(self.solution.outcome))


def case(file: str | Path, *, level: str = "") -> Solved:
    """Solve the pair of a CASE.toml by finite elements.

    Parameters
    ----------
    file
        As `dentscope case --new` writes it.
    level
        `smoke`, `quick` or `production`, instead of the file's.

    Raises
    ------
    InputErrors
        One line for each mistake in the file.
    """
    problem, accuracy = read_case(Path(file), level=level)
    return solved(problem, accuracy)


def solved(problem: fem.ContactProblem, accuracy: fem.Accuracy, report: Report = _silent) -> Solved:
    """Solve a pair, and again with larger elements.

    Parameters
    ----------
    problem, accuracy
        From `read_case`.
    report
        Told which step is how far, from 0 to 1.
    """
    solution = fem.solve(
        problem, accuracy=accuracy, progress=lambda done: report(Steps.solving, done)
    )
    rough = fem.solve(
        replace(problem, unload_from=(), snapshots=(), profiles=()),
        accuracy=fem.coarser(accuracy),
        progress=lambda done: report(Steps.uncertainty, done),
    )
    if len(solution.loading.delta) == 0:
        return Solved(solution, None)
    return Solved(solution, fem.discretisation_uncertainty(solution.loading, rough.loading))
