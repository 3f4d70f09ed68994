"""`dentscope campaign`: run a sweep, see where it stands, look at a case, export."""

from __future__ import annotations

import csv
import json
import math
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import typer

from ..core.errors import EXIT_NOT_CONVERGED, InputError

app = typer.Typer(help="Sweeps of finite-element cases.", no_args_is_help=True)

_FILE = "campaign.h5"
_TYPICAL_CPU_S = {
    "smoke": 17.0,
    "survey": 45.0,
}  # mean processor seconds a case, measured (docs/performance.md)
_DEEP_CPU_S = 200.0  # the same at production accuracy
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
    from ..campaigns import Store, design_named, run_design, status_of
    from ..campaigns.executor import DaskExecutor, LocalExecutor

    if retry not in ("", "failed"):
        raise InputError(f"{retry!r}", source="command line", key="--retry", allowed="failed")
    chosen = design_named(design)
    path = out / _FILE
    store = Store(path)
    before = status_of(chosen, store)
    executor: Any = DaskExecutor.connect(scheduler) if scheduler else LocalExecutor(workers=workers)
    todo = before.missing + (before.failed if retry else 0)
    guess = todo * _TYPICAL_CPU_S.get(design, _DEEP_CPU_S) / executor.workers / 60.0
    long = f"{guess:.0f} min" if guess < 120.0 else f"{guess / 60.0:.0f} h"
    typer.echo(
        f"design {design}: {before.designed} cases, {before.done} done, {before.failed} failed, "
        f"{before.missing} to compute on {executor.workers} workers; about {long}. "
        f"Results go to {path}."
    )
    started = time.monotonic()
    until = started + 60.0 * limit_minutes if limit_minutes else math.inf
    try:
        with _Progress(todo) as progress:
            after = run_design(
                chosen,
                path,
                executor=executor,
                time_limit_s=60.0 * case_minutes,
                again=frozenset({retry} - {""}),
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
    _summary(store, out, after, time.monotonic() - started, progress.cpu_s)
    return 0 if after.done == after.designed else EXIT_NOT_CONVERGED


@app.command()
def status(
    design: DesignName = "smoke",
    out: Out = Path("build/campaign"),
    as_json: Annotated[bool, typer.Option("--json", help="For programs.")] = False,
) -> None:
    """Count done, failed and missing cases; works while the sweep runs."""
    from ..campaigns import Store, design_named, read_published, status_of

    path = out / _FILE
    counts = status_of(design_named(design), Store(path))
    content = {
        "design": design,
        "file": str(path),
        "designed": counts.designed,
        "done": counts.done,
        "failed": counts.failed,
        "missing": counts.missing,
    }
    if as_json:
        typer.echo(json.dumps(content))
        return
    typer.echo("  ".join(f"{key} {value}" for key, value in content.items()))
    if not path.exists():
        typer.echo("No run here yet: `dentscope campaign run` starts one.")
        typer.echo(f"Published: {len(read_published(_PUBLISHED))} cases in {_PUBLISHED}.")
        return
    for record in Store(path).read_all():
        share = "" if record.status == "done" else f"  {record.message}"
        typer.echo(f"{record.id[:12]}  {record.status:7} {record.case.name}{share}")


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
) -> None:
    """Write all loading curves as one table: CSV, or Parquet where the name ends so."""
    from ..campaigns import read_curves

    records = read_curves(out / _FILE)
    if not records:
        raise InputError("no completed case", source=str(out / _FILE))
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


class _Progress:
    """A bar on a terminal, a line a case in a log."""

    def __init__(self, total: int) -> None:
        from rich.console import Console
        from rich.progress import (
            BarColumn,
            MofNCompleteColumn,
            Progress,
            TextColumn,
            TimeElapsedColumn,
            TimeRemainingColumn,
        )

        self.cpu_s = 0.0
        self.total = total
        self.ended = 0
        self.started = time.monotonic()
        self.console = Console()
        self.bar = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
            console=self.console,
        )
        self.task = self.bar.add_task("cases", total=total)

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
        self.bar.advance(self.task)
        left = (time.monotonic() - self.started) / self.ended * (self.total - self.ended)
        word = "done" if step.done else "FAILED"
        line = f"{word} {step.case.name} ({step.cpu_s:.0f} s) {step.message}"
        if not self.console.is_terminal:
            line = f"[{self.ended}/{self.total}, {left / 60:.1f} min left] {line}"
        self.console.print(line, highlight=False, markup=False)


def _summary(store: Any, out: Path, after: Any, wall_s: float, cpu_s: float) -> None:
    from ..campaigns import largest_difference, read_published
    from ..campaigns.pictures import draw_campaign

    typer.echo(
        f"{after.done} done, {after.failed} failed, {after.missing} missing of {after.designed}; "
        f"{wall_s / 60:.1f} min, {cpu_s:.0f} processor seconds"
    )
    if not after.done:
        return
    records = [r for r in store.read_all() if r.status == "done"]
    worst = max(float(abs(r.curve["energy_defect"]).max()) for r in records)
    deepest = min(float(r.curve["delta"][-1] / r.case.pair.R) for r in records)
    typer.echo(f"every case reaches Delta/R = {deepest:.3g}; largest energy defect {worst:.2%}")
    common, difference = largest_difference(records, read_published(_PUBLISHED))
    if common:
        typer.echo(f"largest difference of F from {common} published cases: {difference:.2%}")
    for picture in draw_campaign(records, out / "pictures"):
        typer.echo(f"picture: {picture}")
