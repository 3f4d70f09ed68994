"""`dentscope campaign`: run a sweep, see where it stands, look at a case, export, publish, draw."""

from __future__ import annotations

import csv
import json
import math
import os
import time
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from ..core.errors import EXIT_NOT_CONVERGED, InputError

app = typer.Typer(help="Sweeps of finite-element cases.", no_args_is_help=True)

_FILE = "campaign.h5"
_PUBLISHED = Path(__file__).parents[1] / "data" / "campaign"

Out = Annotated[Path, typer.Option(help="Folder of the run.")]
DesignName = Annotated[str, typer.Option(help="Which sweep; see `campaign designs`.")]


@app.command()
def designs() -> None:
    """List the sweeps."""
    from ..campaigns import DESIGNS

    for design in DESIGNS.values():
        typer.echo(f"{design.name:12} {design.about}")


@app.command()
def run(
    design: DesignName = "smoke",
    out: Out = Path("build/campaign"),
    workers: Annotated[int, typer.Option(min=1, help="Worker processes.")] = os.cpu_count() or 1,
    scheduler: Annotated[str, typer.Option(help="Address of a dask scheduler.")] = "",
    case_minutes: Annotated[float, typer.Option(min=0.01, help="Time limit of a case.")] = 60.0,
    retry: Annotated[
        str, typer.Option(help="`failed`: compute failed cases again, more finely.")
    ] = "",
    limit_minutes: Annotated[
        float, typer.Option(min=0.0, help="Stop at the first case that ends after this; 0: never.")
    ] = 0.0,
) -> int:
    """Compute what the sweep lacks; stop it at any time and run it again to go on."""
    from ..campaigns import Store, design_named, distinct_cases, run_design, status_of
    from ..campaigns.executor import DaskExecutor, LocalExecutor
    from ..campaigns.run import cases_to_do

    if retry not in ("", "failed"):
        raise InputError(f"{retry!r}", source="command line", key="--retry", allowed="failed")
    chosen = design_named(design)
    path = out / _FILE
    store = Store(path)
    again = frozenset({retry} - {""})
    before = status_of(chosen, store)
    executor: Any = DaskExecutor.connect(scheduler) if scheduler else LocalExecutor(workers=workers)
    cases = distinct_cases(chosen)
    todo = [cases[key] for key in cases_to_do(chosen, store, again=again)]
    forecast = _forecast(todo, store, executor.workers)
    typer.echo(
        f"design {design}: {before.designed} cases, {before.done} done, {before.failed} failed, "
        f"{len(todo)} to compute on {executor.workers} workers; about "
        f"{_long(forecast.left_s())} here. Results go to {path}."
    )
    started = time.monotonic()
    until = started + 60.0 * limit_minutes if limit_minutes else math.inf
    try:
        with _Progress(forecast, len(todo)) as progress:
            after = run_design(
                chosen,
                path,
                executor=executor,
                time_limit_s=60.0 * case_minutes,
                again=again,
                until=until,
                report=progress.step,
            )
    except KeyboardInterrupt:
        now = status_of(chosen, store)
        typer.echo(
            f"stopped: {now.done} done, {now.failed} failed, {now.missing} missing; "
            "the same command goes on from here"
        )
        return 130
    _summary(chosen, out, after, time.monotonic() - started, progress.cpu_s)
    return 0 if after.done == after.designed else EXIT_NOT_CONVERGED


@app.command()
def status(
    design: DesignName = "smoke",
    out: Out = Path("build/campaign"),
    as_json: Annotated[bool, typer.Option("--json", help="For programs.")] = False,
) -> None:
    """Count done, failed and missing cases; works while the sweep runs."""
    from ..campaigns import Store, design_named, published_designs, status_of

    path = out / _FILE
    store = Store(path)
    counts = status_of(design_named(design), store)
    published = published_designs(_PUBLISHED)
    content = {
        "design": design,
        "file": str(path),
        "designed": counts.designed,
        "done": counts.done,
        "failed": counts.failed,
        "missing": counts.missing,
    }
    stored = store.summaries()
    judged = _judged([s for s in stored if s.status == "done"])
    if as_json:
        told = {one.design: asdict(one) for one in published}
        typer.echo(json.dumps({**content, "quality": judged, "published": told}))
        return
    typer.echo("  ".join(f"{key} {value}" for key, value in content.items()))
    if not stored:
        typer.echo("No run here yet: `dentscope campaign run` starts one.")
    for summary in stored:
        typer.echo(f"{summary.id[:12]}  {summary.status:7} {summary.case.name}{_remarks(summary)}")
    _tell(judged)
    if not published:
        typer.echo(f"Published: nothing yet in {_PUBLISHED}.")
    for one in published:
        old = f", of numerics version {one.numerics_version}: stale" if one.stale else ""
        typer.echo(
            f"Published: {one.design}, {one.done} cases done, {one.failed} failed, "
            f"{one.parts} parts in {_PUBLISHED}{old}."
        )


@app.command()
def show(
    case: Annotated[str, typer.Argument(help="Case id or its beginning.")],
    out: Out = Path("build/campaign"),
) -> None:
    """Print one case: its pair, its curve, its unloadings."""
    from rich.console import Console
    from rich.table import Table

    from ..campaigns import Store

    record = Store(out / _FILE).read(case)
    pair = record.case.pair
    console = Console()
    console.print(f"{record.case.name}  [{record.status}] {record.message}")
    table = Table("Delta/R", "F [N]", "a [mm]", "share", "H/Sy_min")
    c = record.curve
    for i in range(0, len(c.get("delta", ())), 3):
        share = c["sphere"][i] / (c["sphere"][i] + c["flat"][i])
        table.add_row(
            f"{c['delta'][i] / pair.R:.4g}",
            f"{c['force'][i]:.4g}",
            f"{c['radius'][i] * 1e3:.4g}",
            f"{share:.3f}",
            f"{c['hardness'][i] / pair.Sy_min:.3f}",
        )
    console.print(table)
    for unloading in record.unloadings:
        console.print(
            f"unloaded from Delta/R = {unloading.depth:.4g}: left in the sphere "
            f"{unloading.residual_sphere * 1e6:.3g} um, in the flat "
            f"{unloading.residual_flat * 1e6:.3g} um"
        )


@app.command()
def export(
    out: Out = Path("build/campaign"),
    to: Annotated[Path, typer.Option(help="File to write.")] = Path("build/campaign/curves.csv"),
    data: Annotated[
        Path | None, typer.Option(help="Campaign file or folder of parts, instead of --out.")
    ] = None,
) -> None:
    """Write all loading curves as one table: CSV, or Parquet where the name ends so."""
    from ..campaigns import read_curves

    source = data or out / _FILE
    records = read_curves(source)
    if not records:
        raise InputError("no completed case", source=str(source))
    names = list(records[0].curve)
    if to.suffix not in (".csv", ".parquet"):
        raise InputError(
            repr(to.suffix), key="--to", allowed="a name that ends in .csv or .parquet"
        )
    head = ["case", "E_s_Pa", "nu_s", "Sy_s_Pa", "E_f_Pa", "nu_f", "Sy_f_Pa", "R_m", *names]
    to.parent.mkdir(parents=True, exist_ok=True)
    if to.suffix == ".parquet":
        try:
            import pandas
            import pyarrow  # noqa: F401 (pandas writes Parquet through it)
        except ImportError as missing:
            raise InputError(
                f"{missing.name} is not installed",
                key="--to",
                allowed="pip install dentscope[tables]",
            ) from None
        pandas.DataFrame(list(_rows(records, names)), columns=head).to_parquet(to, index=False)
    else:
        with to.open("w", newline="", encoding="utf-8") as stream:
            writer = csv.writer(stream)
            writer.writerow(head)
            writer.writerows(_rows(records, names))
    typer.echo(f"{len(records)} cases -> {to}")


def _rows(records: list[Any], names: list[str]) -> Iterator[list[Any]]:
    for record in records:
        p = record.case.pair
        start = [record.case.name, p.sphere.E, p.sphere.nu, p.sphere.Sy]
        start += [p.flat.E, p.flat.nu, p.flat.Sy, p.R]
        for row in zip(*(record.curve[name] for name in names), strict=True):
            yield [*start, *row]


@app.command()
def publish(
    design: DesignName = "full",
    out: Out = Path("build/campaign"),
    to: Annotated[Path, typer.Option(help="Folder of the data set.")] = Path("data/campaign"),
) -> None:
    """Make immutable parts below 10 MB from a complete run."""
    from ..campaigns import design_named
    from ..campaigns import publish as write_parts

    for part in write_parts(design_named(design), out / _FILE, to):
        typer.echo(f"{part}: {part.stat().st_size / 1e6:.1f} MB")


@app.command()
def gallery(
    data: Annotated[
        Path | None,
        typer.Option(help="Campaign file or folder of parts. Default: published, else own run."),
    ] = None,
    fields: Annotated[Path, typer.Option(help="Folder of a run's field files.")] = Path(
        "build/campaign/fields"
    ),
    to: Annotated[Path, typer.Option(help="Folder of the pictures.")] = Path(
        "docs/gallery/campaign"
    ),
) -> None:
    """Draw the campaign: the figures over Sy*, F/F_c of all cases, stress fields."""
    from ..figures.campaign import build

    for picture in build(_data(data), to, fields=fields):
        typer.echo(f"{picture.number:>10}  {picture.title}: {picture.note}")
    typer.echo(f"written: {to / 'README.md'}")


@app.command()
def reproduction(
    data: Annotated[
        Path | None,
        typer.Option(help="Campaign file or folder of parts. Default: published, else own run."),
    ] = None,
    to: Annotated[Path, typer.Option(help="Report to write.")] = Path("docs/reproduction.md"),
) -> None:
    """Check the trends that chapter 2 of the thesis tells, one by one."""
    from ..figures.campaign_reproduction import write

    for trend in write(_data(data), to):
        typer.echo(f"{trend.verdict:>14}  {trend.claim}")
    typer.echo(f"written: {to}")


def _data(given: Path | None) -> Path:
    """What to read: what was named, or the published data, or the own run."""
    from ..campaigns.publish import CHECKSUMS

    if given is not None:
        return given
    return _PUBLISHED if (_PUBLISHED / CHECKSUMS).exists() else Path("build/campaign") / _FILE


def _forecast(todo: list[Any], store: Any, workers: int) -> Any:
    from ..campaigns import Forecast, pace_of_this_machine

    ended = [(s.case, s.cpu_s) for s in store.summaries() if s.status == "done"]
    return Forecast(todo, workers=workers, ended=ended, pace=pace_of_this_machine())


def _long(seconds: float) -> str:
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = seconds / 60.0
    return f"{minutes:.0f} min" if minutes < 120.0 else f"{minutes / 60.0:.0f} h"


class _Progress:
    """A bar on a terminal, a line a case in a log; both with the time that is left."""

    def __init__(self, forecast: Any, total: int) -> None:
        from rich.console import Console
        from rich.progress import (
            BarColumn,
            MofNCompleteColumn,
            Progress,
            TextColumn,
            TimeElapsedColumn,
        )

        self.cpu_s = 0.0
        self.total = total
        self.ended = 0
        self.forecast = forecast
        self.started = time.monotonic()
        self.console = Console()
        self.bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            TextColumn("{task.fields[left]} left"),
            console=self.console,
        )
        self.task = self.bar.add_task("cases", total=total, left=_long(forecast.left_s()))

    def __enter__(self) -> _Progress:
        if self.console.is_terminal:
            self.bar.start()
        return self

    def __exit__(self, *_: object) -> None:
        if self.console.is_terminal:
            self.bar.stop()

    def step(self, step: Any) -> None:
        """Show one case that ended."""
        self.ended += 1
        self.cpu_s += step.cpu_s
        gone = time.monotonic() - self.started
        self.forecast.end(step.case, gone)
        left = _long(self.forecast.left_s(gone))
        self.bar.update(self.task, advance=1, left=left)
        word = "done" if step.done else "FAILED"
        line = f"{word} {step.case.name} ({step.cpu_s:.0f} s) {step.message}"
        if not self.console.is_terminal:
            line = f"[{self.ended}/{self.total}, {left} left] {line}"
        self.console.print(line, highlight=False, markup=False)


def _remarks(summary: Any) -> str:
    from ..campaigns import MOST_ENERGY_DEFECT, MOST_STEP

    if summary.status != "done":
        return f"  {summary.message}"
    quality, told = summary.quality, []
    if quality.energy_defect > MOST_ENERGY_DEFECT:
        told.append(f"energy defect {quality.energy_defect:.2%}")
    if quality.largest_step > MOST_STEP:
        told.append(f"step of {quality.largest_step:.1%}")
    return f"  ({', '.join(told)})" if told else ""


def _judged(done: list[Any]) -> dict[str, float]:
    """What the completed cases keep: reach, energy balance, smoothness."""
    from ..campaigns import MOST_ENERGY_DEFECT, MOST_STEP

    if not done:
        return {}
    qualities = [summary.quality for summary in done]
    return {
        "cases": len(done),
        "least_depth": min(q.depth_reached for q in qualities),
        "energy_defect": max(q.energy_defect for q in qualities),
        "energy_defect_above_mark": sum(q.energy_defect > MOST_ENERGY_DEFECT for q in qualities),
        "largest_step": max(q.largest_step for q in qualities),
        "steps_above_mark": sum(q.largest_step > MOST_STEP for q in qualities),
        "cpu_s_a_case": sum(summary.cpu_s for summary in done) / len(done),
    }


def _tell(judged: dict[str, float]) -> None:
    from ..campaigns import MOST_ENERGY_DEFECT, MOST_STEP

    if not judged:
        return
    typer.echo(
        f"{judged['cases']} completed cases, {judged['cpu_s_a_case']:.0f} processor seconds each: "
        f"every one reaches Delta/R = {judged['least_depth']:.3g}; largest energy defect "
        f"{judged['energy_defect']:.2%} ({judged['energy_defect_above_mark']} cases above "
        f"{MOST_ENERGY_DEFECT:.1%}); largest step of F, a or delta_s* along a case "
        f"{judged['largest_step']:.1%} ({judged['steps_above_mark']} cases above {MOST_STEP:.0%})"
    )


def _summary(design: Any, out: Path, after: Any, wall_s: float, cpu_s: float) -> None:
    from ..campaigns import Store, distinct_cases, largest_difference, read_published
    from ..campaigns.pictures import draw_campaign

    typer.echo(
        f"{after.done} done, {after.failed} failed, {after.missing} missing of {after.designed}; "
        f"{_long(wall_s)}, {cpu_s:.0f} processor seconds"
    )
    if not after.done:
        return
    store, keys = Store(out / _FILE), set(distinct_cases(design))
    _tell(_judged([s for s in store.summaries() if s.id in keys and s.status == "done"]))
    records = [r for r in store.read_all() if r.id in keys and r.status == "done"]
    found = largest_difference(records, read_published(_PUBLISHED))
    if found.cases:
        finer = "" if found.same else ", which were solved at another resolution"
        typer.echo(
            f"largest difference from {found.cases} published cases{finer}: F {found.force:.2%}, "
            f"a {found.radius:.2%}, delta_s* {found.share:.2%}"
        )
    else:
        typer.echo("no case of these is published: nothing to compare with")
    for picture in draw_campaign(records, out / "pictures"):
        typer.echo(f"picture: {picture}")
