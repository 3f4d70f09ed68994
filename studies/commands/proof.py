"""`dentscope proof`: concealed impacts, sealed; the diagnosis runs; truths opened and scored."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from ...cli.campaign_progress import duration
from ...cli.shared.groups import group
from ...cli.shared.places import folder_option, one_of, writable_folder
from ...core.errors import InputError
from ..proof.names import KINDS, LISTS

app = group("Blind proof of the diagnosis on concealed impacts.")

_BASE = Path("build/proof")
_Base = Annotated[Path, folder_option("Folder of the runs.")]
_Which = Annotated[str, typer.Option("--list", help="full or small.")]


@app.command()
def run(
    which: _Which = "full",
    out: _Base = _BASE,
    hours: Annotated[float, typer.Option(min=0.0, help="Stop after so many hours.")] = 1e9,
    most: Annotated[int, typer.Option(min=1, help="Stop after so many sets.")] = 10**9,
    limit: Annotated[
        float, typer.Option(min=1.0, help="Longest time of one diagnosis [s].")
    ] = 900.0,
    workers: Annotated[int, typer.Option(min=1, help="Worker processes.")] = os.cpu_count() or 1,
) -> None:
    """Go on with the run of this source tree: draw, seal, diagnose, seal. Stop it at any time."""
    one_of(which, LISTS, key="--list")
    from rich.console import Console
    from rich.progress import Progress

    from ..proof.lists import LISTS as made
    from ..proof.run import carry_on, run_folder, verdicts_of

    folder = run_folder(out, which)
    total, before = len(made[which]()), verdicts_of(folder)
    typer.echo(
        f"{folder}: {total} sets, {before} done; {workers} workers. Ctrl-C stops, the same command "
        "goes on."
    )
    console = Console()
    with (
        _workers(workers) as pool,
        Progress(console=console, disable=not console.is_terminal) as bar,
    ):
        task = bar.add_task("sets", total=total, completed=before)
        for name, event in carry_on(
            folder, which, pool, at_once=workers, hours=hours, most=most, limit_s=limit
        ):
            bar.advance(task)
            state = "sealed" if event["verdict"] else f"no verdict ({event['exit']})"
            console.print(f"  {name}  {state}  {event['wall_s']:.0f} s", highlight=False)


@contextmanager
def _workers(count: int) -> Iterator[Executor]:
    """Worker processes; where the command is stopped they are ended, and it says how to go on."""
    from multiprocessing import active_children

    from ...core.processes.stopping import STOPS, stopped
    from ...core.processes.threads import one_thread_each
    from ..proof.run import local_workers

    one_thread_each()
    pool = local_workers(count)
    try:
        yield pool
    except STOPS as stop:
        code = stopped(stop)
        for worker in active_children():
            worker.terminate()  # a diagnosis may take minutes, and is begun anew
        typer.echo("stopped; the same command goes on from here")
        raise typer.Exit(code) from None
    finally:
        pool.shutdown(cancel_futures=True)


@app.command()
def score(which: _Which = "full", out: _Base = _BASE) -> None:
    """Open the truths of the sets that have a sealed verdict, score, and rewrite docs/proof.md."""
    one_of(which, LISTS, key="--list")
    from ...core.provenance import source_commit
    from ..proof import page as pages
    from ..proof.case import open_run
    from ..proof.lists import LISTS as made
    from ..proof.rivals import read_lines as peer_lines
    from ..proof.run import ROOT, plan_of, run_folder
    from ..proof.seal import Ledger, SealBroken, tree_hash

    folder = run_folder(out, which)
    if not (folder / "ledger.jsonl").exists():
        raise InputError("no run of this source tree", source=str(folder),
                         allowed="dentscope proof run")  # fmt: skip
    try:
        cases = open_run(folder)
    except SealBroken as broken:
        raise InputError(str(broken), source=str(folder), allowed="unbroken seals") from broken
    entry = pages.summary(
        cases, which=which, tree=tree_hash(ROOT), date=datetime.now(UTC).date().isoformat(),
        total=len(made[which]()), commit=source_commit(),
        peers=peer_lines(folder), plan=plan_of(Ledger(folder / "ledger.jsonl")),
    )  # fmt: skip
    _write_page(pages.keep(entry))
    for s in entry["scores"]:
        value = f"{s['value']:.3g}" if not s["of"] else f"{s['hits']} of {s['of']}"
        typer.echo(f"{s['name']:<42} {value:>12}  {s['mark']:<18} {s['state']}")


@app.command()
def page() -> None:
    """Rewrite docs/proof.md from the runs that were scored."""
    import json

    from ..proof.page import RUNS

    _write_page(json.loads(RUNS.read_text()) if RUNS.exists() else [])


def _write_page(runs: list[dict[str, object]]) -> None:
    from ..proof import page as pages
    from ..proof.run import ROOT

    pages.publish(runs, ROOT / "docs")


@app.command()
def sample(
    out: Annotated[Path, typer.Argument(help="Folder for sets/ and truths/.")],
    count: Annotated[int, typer.Option(min=1, help="Number of sets.")] = 4,
    kind: Annotated[
        str, typer.Option(help="null, single, pair or outside; in turn if empty.")
    ] = "",
    name: Annotated[str, typer.Option(help="Effect; every one in turn if empty.")] = "",
    seed: Annotated[int, typer.Option(min=0, help="Seed of the draw.")] = 1,
) -> None:
    """Write sample sets with their truths beside them."""
    one_of(kind, ("", *KINDS), key="--kind")
    writable_folder(out, key="OUT")
    from ..proof.generators.effects import EFFECTS, OUTSIDE
    from ..proof.sample import sample as samples

    known = EFFECTS | OUTSIDE if not kind else (EFFECTS if kind == "single" else OUTSIDE)
    one_of(name, ("", *known), key="--name")
    for label, record in samples(out, count=count, kind=kind, name=name, seed=seed):
        typer.echo(f"{label}  {record['kind']}")


@app.command()
def peers(
    folder: Annotated[
        Path, typer.Argument(help="Folder with sets/ and truths/, or of a run: verdicts too.")
    ],
    most: Annotated[int, typer.Option(min=1, help="So many sets at most.")] = 10**9,
    workers: Annotated[int, typer.Option(min=1, help="Worker processes.")] = os.cpu_count() or 1,
) -> None:
    """Compare the diagnosis with simple rules on the same problems. Stop it at any time."""
    from time import monotonic

    from ..peers.compare import compared
    from ..proof.rivals import read_lines, report, told

    begun, first = monotonic(), None
    with _workers(workers) as pool:
        for line, done, total in compared(folder, pool, at_once=workers, most=most):
            first = done if first is None else first
            left = (monotonic() - begun) / (done - first + 1) * (total - done)
            typer.echo(f"[{done}/{total}, {duration(left)} left] {told(line)}")
    for text in report(read_lines(folder)):
        typer.echo(text)


@app.command()
def interventions(
    raw: Annotated[Path, typer.Option(help="Folder of the fetched recordings.")] = Path(
        "build/recordings"
    ),
    out: Annotated[Path, folder_option("Folder of the sets.")] = Path("build/interventions"),
) -> None:
    """Conceal known effects of real recordings, diagnose, and rewrite docs/interventions.md."""
    from ...core.output import write_file
    from ..interventions.page import PAGE, counted, page
    from ..interventions.plan import read_plan
    from ..interventions.scoring import ask, outcomes

    pairs = read_plan()
    for told in ask(pairs, raw=raw, out=out):
        mark = {True: "right", False: "missed", None: "left out"}[told.right]
        typer.echo(f"{told.pair:<14} {told.side:<8} {mark:<9} {told.said}")
    write_file(PAGE, page(pairs, outcomes()))
    typer.echo(counted(pairs, outcomes()))


@app.command()
def laws() -> None:
    """Solve and fit the pairs that the generators' base laws lack."""
    from ..proof.generators.base_laws import fill
    from ..proof.generators.benches import BEARING_STEEL, CARBIDE, TARGETS

    for line in fill(TARGETS, (BEARING_STEEL, CARBIDE)):
        typer.echo(line)
