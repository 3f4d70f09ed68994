"""`dentscope.diagnose(...)`: what physics a folder of recordings shows to be missing."""

from __future__ import annotations

import html
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.inputs.input_file import path_of
from ..core.observables import OBSERVABLES
from ..core.output import panels
from ..core.tables import frame, html_table
from ..discrepancy import Mechanism, Verdict
from ..discrepancy import diagnose as verdict_of
from ..discrepancy.report import Story, lines, story_of, write_report
from ..recordings import read
from ..recordings.shipped import set_folder

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..discrepancy.baseline.laws import LawChoice


@dataclass(frozen=True)
class Diagnosis:
    """A verdict and how it is told.

    - `verdict`: all numbers: `verdict.verdict`, `verdict.probabilities`, `verdict.to_dict()`, ...
    - `story`: the same in sentences and tables, as the report has them.
    """

    verdict: Verdict
    story: Story

    @property
    def finding(self) -> str:
        """The finding in one sentence."""
        return self.story.finding

    @property
    def mechanisms(self) -> tuple[str, ...]:
        """Names of the mechanisms that are missing, as the best explanation has them."""
        return self.verdict.mechanisms

    def frame(self) -> Any:
        """Return measured beside simulated as a pandas data frame, in units for people."""
        return frame(point.row() for point in self.story.points)

    def plot(self) -> Figure:
        """Return measured beside simulated, a panel an observable."""
        story = self.story
        names = list(dict.fromkeys(point.observable for point in story.points))
        figure, axes = panels(len(names))
        against = story.against[0]
        stated, without, found = story.series
        for axis, name in zip(axes, names, strict=True):
            points = sorted(
                (p for p in story.points if p.observable == name), key=lambda p: p.x[against.key]
            )
            x = [p.x[against.key] for p in points]
            bars = [[p.measured - p.low for p in points], [p.high - p.measured for p in points]]
            axis.errorbar(x, [p.measured for p in points], bars, fmt="ko", ms=4, label="measured")
            axis.plot(x, [p.as_stated for p in points], ".", c="0.6", label=stated)
            axis.plot(x, [p.best_without for p in points], "C0s", ms=4, mfc="w", label=without)
            if any(math.isfinite(p.with_verdict) for p in points):
                axis.plot(x, [p.with_verdict for p in points], "C3^", ms=4, mfc="w", label=found)
            axis.set(xlabel=against.label, ylabel=OBSERVABLES[name].axis)
            axis.grid(alpha=0.3)
        handles, labels = axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", fontsize=8)
        # the legend's lines are longer than one panel is wide; of the finding its first sentence
        figure.set_figwidth(max(figure.get_figwidth(), 7.5))
        figure.suptitle(f"{story.finding.partition('. ')[0].rstrip('.')}.", fontsize=10, wrap=True)
        return figure

    def report(self, path: str | Path = "report.html") -> Path:
        """Write the report, with its numbers as JSON and CSV beside it."""
        return write_report(self.verdict, Path(path))[0]

    def __repr__(self) -> str:
        return "\n".join(lines(self.verdict))

    def _repr_html_(self) -> str:
        parts = ((bar.told, bar.name) for bar in self.story.parts)
        table = html_table(("probability that it takes part", ""), parts)
        return f"<p><b>{html.escape(self.finding)}</b></p>{table}"


def diagnose(
    folder: str | Path,
    *,
    seed: int = 0,
    law: LawChoice | None = None,
    cautious: bool = False,
    assume: Sequence[str] = (),
    mechanisms: Sequence[Mechanism] = (),
) -> Diagnosis:
    """Say what physics is missing in the simulation of a recording set.

    The answer has `finding`, `mechanisms`, `verdict` with all numbers, `plot()`, `frame()`,
    `report(path)`.

    Parameters
    ----------
    folder
        A folder with set.toml and trials.csv, or the name of a shipped set.
    seed
        Same seed, same answer.
    law
        `fitted`, or `table` for finite elements of the set's own pair. Left out: `table` where a
        body has a flow curve, or where the set asks for it. No law of one's own: its error, which
        is not known, would pass for missing physics.
    cautious
        Say only what has four fifths of the probability, not half.
    assume
        Names of mechanisms that act whatever is found, with published numbers; set.toml's `assume`
        names others.
    mechanisms
        One's own, tried beside those of the library and of other packages; example 8 has one.

    Raises
    ------
    InputErrors
        One line for each mistake in the set.
    """
    place = path_of(folder, key="folder", allowed="a recording set")
    verdict = verdict_of(
        read(set_folder(place)), seed=seed, law=law, cautious=cautious,
        assume=[assume] if isinstance(assume, str) else assume, mechanisms=mechanisms,
    )  # fmt: skip
    return Diagnosis(verdict, story_of(verdict))
