"""What `dentscope campaign` shows of a run: the time left, and how good the cases are."""

from __future__ import annotations

import time
from typing import Any

import typer


class Progress:
    """A bar on a terminal, a line a case in a log; both with the time that is left."""

    def __init__(self, forecast: Any, total: int) -> None:
        from rich import progress
        from rich.console import Console

        self.cpu_s = 0.0
        self.forecast = forecast
        self.started = time.monotonic()
        self.console = Console()
        self.bar = progress.Progress(
            progress.TextColumn("{task.description}"), progress.BarColumn(),
            progress.MofNCompleteColumn(), progress.TimeElapsedColumn(),
            progress.TextColumn("{task.fields[left]} left"),
            console=self.console, disable=not self.console.is_terminal,
        )  # fmt: skip
        self.task = self.bar.add_task("cases", total=total, left=duration(forecast.left_s()))

    def step(self, step: Any) -> None:
        """Show one case that ended."""
        self.cpu_s += step.cpu_s
        gone = time.monotonic() - self.started
        self.forecast.end(step.case, gone)
        left = duration(self.forecast.left_s(gone))
        self.bar.update(self.task, advance=1, left=left)
        word = "done" if step.done else "FAILED"
        line = f"{word} {step.case.name} ({step.cpu_s:.0f} s) {step.message}"
        if not self.console.is_terminal:
            (task,) = self.bar.tasks
            line = f"[{task.completed:.0f}/{task.total:.0f}, {left} left] {line}"
        self.console.print(line, highlight=False, markup=False)


def duration(seconds: float) -> str:
    """Return a duration in words, no finer than it is known."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = seconds / 60.0
    return f"{minutes:.0f} min" if minutes < 120.0 else f"{minutes / 60.0:.0f} h"


def remarks(summary: Any) -> str:
    """Return what is to be said of one case: why it failed, or which mark it misses."""
    from ..campaigns import RULES

    if summary.status != "done":
        return f"  {summary.message}"
    if summary.stale:
        return "  (stale: another version of the numerics)"
    quality, told = summary.quality, []
    if quality.energy_defect > RULES.energy_defect:
        told.append(f"energy defect {quality.energy_defect:.2%}")
    if quality.largest_step > RULES.step:
        told.append(f"step of {quality.largest_step:.1%}")
    return f"  ({', '.join(told)})" if told else ""


def judged(done: list[Any]) -> dict[str, float]:
    """Return what the completed cases keep: reach, energy balance, smoothness."""
    from ..campaigns import RULES

    if not done:
        return {}
    qualities = [summary.quality for summary in done]
    return {
        "cases": len(done),
        "least_depth": min(q.depth_reached for q in qualities),
        "energy_defect": max(q.energy_defect for q in qualities),
        "energy_defect_above_mark": sum(q.energy_defect > RULES.energy_defect for q in qualities),
        "largest_step": max(q.largest_step for q in qualities),
        "steps_above_mark": sum(q.largest_step > RULES.step for q in qualities),
        "cpu_s_a_case": sum(summary.cpu_s for summary in done) / len(done),
    }


def tell(found: dict[str, float]) -> None:
    """Print what `judged` found."""
    from ..campaigns import RULES

    if not found:
        return
    typer.echo(
        f"{found['cases']} completed cases, {found['cpu_s_a_case']:.0f} processor seconds each: "
        f"every one reaches Delta/R = {found['least_depth']:.3g}; largest energy defect "
        f"{found['energy_defect']:.2%} ({found['energy_defect_above_mark']} cases above "
        f"{RULES.energy_defect:.1%}); largest step of F, a or delta_s* along a case "
        f"{found['largest_step']:.1%} ({found['steps_above_mark']} cases above {RULES.step:.0%})"
    )
