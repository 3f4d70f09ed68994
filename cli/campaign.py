"""`dentscope campaign`: run a sweep and see where it stands."""

from __future__ import annotations

import json
import math
import os
import time
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from ..core.errors import EXIT_NOT_CONVERGED
from ..core.output import in_use
from ..core.processes.stopping import STOPS, stopped
from . import campaign_data, studies
from .campaign_data import DEFAULT_DESIGN, PUBLISHED, DesignName, Out, design_of
from .campaign_progress import Progress, duration, judged, remarks, tell
from .shared.groups import group
from .shared.places import misused, one_of, refuse_beside

# With so many cases done the pictures are drawn while a run goes on: the first, and the first
# three, which in the large designs are the figures' pairs, Sy* = 0.1, 1 and 10.
_PICTURED = frozenset((1, *(3 * 2**k for k in range(12))))

app = group("Sweeps of finite-element cases: run, status, show, export, publish.")


@app.command()
def designs() -> None:
    """List the sweeps."""
    from ..campaigns import DESIGNS

    for design in DESIGNS.values():
        typer.echo(f"{design.name:12} {design.about}")
    typer.echo(f"{'FOLDER':12} pairs of your own: a CASE.toml each, as of `dentscope case --new`")


@app.command()
def run(
    context: typer.Context,
    design: DesignName = DEFAULT_DESIGN,
    out: Out = Path("build/campaign"),
    workers: Annotated[int, typer.Option(min=1, help="Worker processes.")] = os.cpu_count() or 1,
    scheduler: Annotated[str, typer.Option(help="Address of a dask scheduler.")] = "",
    case_minutes: Annotated[float, typer.Option(min=0.01, help="Time limit of a case.")] = 60.0,
    retry: Annotated[
        str, typer.Option(help="`failed`: compute failed cases again, more finely.")
    ] = "",
    part: Annotated[
        str, typer.Option(help="`2/3`: of the sweep every third case from the second on.")
    ] = "1/1",
    limit_minutes: Annotated[
        float, typer.Option(min=0.0, help="Stop at the first case that ends after this; 0: never.")
    ] = 0.0,
) -> int:
    """Compute what the sweep lacks; stop it at any time and run it again to go on."""
    from ..campaigns import Store, distinct_cases, run_design, status_of
    from ..campaigns.executor import DaskExecutor, LocalExecutor
    from ..campaigns.run import cases_to_do

    if scheduler:
        refuse_beside(context, "beside --scheduler: it has the workers", "workers")
    share = _share(part)
    chosen = design_of(design)
    store = Store(out)
    again = frozenset({one_of(retry, ("", "failed"), key="--retry")} - {""})
    before = status_of(chosen, store)
    executor: Any = DaskExecutor.connect(scheduler) if scheduler else LocalExecutor(workers=workers)
    cases = distinct_cases(chosen)
    todo = [cases[key] for key in cases_to_do(chosen, store, again=again, share=share)]
    forecast, slower = _forecast(todo, store, executor.workers)
    busy = f" ({slower:.1f} times slower than measured: busy, or slow)" if slower > 1.5 else ""
    typer.echo(
        f"design {design}: {before.designed} cases, {before.done} done, {before.failed} failed, "
        f"{_why(before, out)}{len(todo)} to compute on {executor.workers} workers; about "
        f"{duration(forecast.left_s())} here{busy}. Results go to {out}. Ctrl-C stops, the same "
        "command goes on."
    )
    started = time.monotonic()
    until = started + 60.0 * limit_minutes if limit_minutes else math.inf
    progress = Progress(forecast, len(todo))

    def ended(step: Any) -> None:
        progress.step(step)
        done = step.status.done
        if step.done and done in _PICTURED:
            many = "the first case" if done == 1 else f"{done} cases"
            told = f"picture of {many}, of {step.status.designed}"
            for picture in _draw(chosen, out):
                progress.console.print(f"{told}: {picture}")

    try:
        with in_use(out / "cases") as shared, progress.bar:
            if shared and share.of == 1:
                progress.console.print(
                    "another run computes here: a case may be computed twice; `--part 1/2` and "
                    "`--part 2/2` share them", highlight=False,
                )  # fmt: skip
            after = run_design(
                chosen, out, executor=executor, time_limit_s=60.0 * case_minutes, again=again,
                share=share, until=until, report=ended,
            )  # fmt: skip
        code = 0 if after.done == after.designed else EXIT_NOT_CONVERGED
    except STOPS as stop:
        code, after = stopped(stop), status_of(chosen, store)
        typer.echo("stopped; the same command goes on from here")
    _summary(chosen, out, after, time.monotonic() - started, progress.cpu_s)
    return code


def _why(counts: Any, out: Path) -> str:
    """Where the reasons of failed cases stand."""
    return f"why: `dentscope campaign status --out {out}`, " if counts.failed else ""


def _share(part: str) -> Any:
    from ..campaigns import Share

    number, _, of = part.partition("/")
    if not (number.isdecimal() and of.isdecimal() and 1 <= int(number) <= int(of)):
        allowed = "K/N, this run's number and how many share the sweep: 2/3"
        raise misused(f"{part!r}", key="--part", allowed=allowed)
    return Share(int(number), int(of))


@app.command()
def status(
    design: Annotated[
        str, typer.Option(help="Which sweep. Default: all of which the run holds cases.")
    ] = "",
    out: Out = Path("build/campaign"),
    as_json: Annotated[bool, typer.Option("--json", help="For programs.")] = False,
) -> None:
    """Count done, failed and missing cases, own and published; works while the sweep runs."""
    from ..campaigns import DESIGNS, Store, published_designs, status_of

    store = Store(out)
    stored = store.summaries()
    chosen = [design_of(design)] if design else list(DESIGNS.values())
    counts = {one.name: status_of(one, store) for one in chosen}
    begun = {k: c for k, c in counts.items() if design or c.done or c.failed}
    named = begun or {DEFAULT_DESIGN: counts[DEFAULT_DESIGN]}
    published = published_designs(PUBLISHED)
    found = judged([s for s in stored if s.status == "done" and not s.stale])
    if as_json:
        first = min(named, key=lambda k: named[k].missing)
        content = {
            "design": first, "folder": str(out), **_counts(named[first]), "quality": found,
            "designs": {k: _counts(c) for k, c in named.items()},
            "published": {one.design: asdict(one) for one in published},
        }  # fmt: skip
        typer.echo(json.dumps(content))
        return
    if stored:
        typer.echo(f"Own run, {out}:")
    else:
        typer.echo(f"No run of your own in {out}: `dentscope campaign run` starts one.")
    for name, c in begun.items():
        typer.echo("  ".join([f"design {name}", *(f"{k} {n}" for k, n in _counts(c).items())]))
    for summary in stored:
        typer.echo(f"{summary.id[:12]}  {summary.status:7} {summary.case.name}{remarks(summary)}")
    if stored:
        tell(found)
    for path in store.strays():
        typer.echo(f"{path}: passed over, its name is no case's")
    _tell_published(published)


def _counts(c: Any) -> dict[str, int]:
    return {"designed": c.designed, "done": c.done, "failed": c.failed, "missing": c.missing}


def _tell_published(published: list[Any]) -> None:
    if not published:
        typer.echo(f"Published: nothing yet in {PUBLISHED}.")
        return
    typer.echo(f"Published, {PUBLISHED}:")
    for one in published:
        old = f"; stale: of numerics version {one.numerics_version}" if one.stale else ""
        typer.echo(f"  {one.design:12} {one.done:4} done {one.failed:3} failed{old}")


for command in (
    campaign_data.show, campaign_data.refine, campaign_data.export, campaign_data.publish,
    campaign_data.repair,
):  # fmt: skip
    app.command()(command)
studies.add(app, "campaign reproduction")


def _forecast(todo: list[Any], store: Any, workers: int) -> tuple[Any, float]:
    """What a run will take, and how much slower than measured the machine is."""
    from ..campaigns import Forecast, pace_of_this_machine

    ended = [(s.case, s.cpu_s) for s in store.summaries() if s.status == "done" and not s.stale]
    pace = pace_of_this_machine()
    return Forecast(todo, workers=workers, ended=ended, pace=pace), pace


def _summary(design: Any, out: Path, after: Any, wall_s: float, cpu_s: float) -> None:
    from ..campaigns import Store, distinct_cases, largest_difference, read_published

    typer.echo(
        f"{after.done} done, {after.failed} failed, {_why(after, out)}{after.missing} missing of "
        f"{after.designed}; {duration(wall_s)}, {cpu_s:.0f} processor seconds"
    )
    if not after.done:
        return
    store, keys = Store(out), set(distinct_cases(design))
    tell(judged([s for s in store.summaries() if s.id in keys and s.status == "done"]))
    found = largest_difference(_done(design, store), read_published(PUBLISHED))
    if found.cases:
        finer = "" if found.same else ", which were solved at another resolution"
        typer.echo(
            f"largest difference from {found.cases} published cases{finer}: F {found.force:.2%}, "
            f"a {found.radius:.2%}, delta_s* {found.share:.2%}"
        )
    else:
        typer.echo("no case of these is published: nothing to compare with")
    for picture in _draw(design, out):
        typer.echo(f"picture: {picture}")


def _done(design: Any, store: Any) -> list[Any]:
    from ..campaigns import distinct_cases

    keys = distinct_cases(design)
    return [r for r in store.read_all() if r.id in keys and r.status == "done"]


def _draw(design: Any, out: Path) -> list[Path]:
    """Draw what a run has so far; return the files."""
    from ..campaigns import Store
    from ..campaigns.pictures import draw_campaign

    return draw_campaign(_done(design, Store(out)), out / "pictures")
