"""`dentscope verify`: measure the solver against what is known, and write docs/verification.md."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ...cli.shared.places import file_option, folder_option, refuse_beside

EXIT_MISSED = 1
"""Exit code when a mark is missed."""


def verify(
    context: typer.Context,
    only: Annotated[
        list[str] | None, typer.Option(help="Name of a check; can be given more than once.")
    ] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="Solve the long checks at the coarse levels only.")
    ] = False,
    afresh: Annotated[
        bool, typer.Option("--afresh", help="Measure again what is already measured.")
    ] = False,
    known: Annotated[bool, typer.Option("--list", help="List the checks and stop.")] = False,
    folder: Annotated[Path, folder_option("Where measurements are kept.", name="--folder")] = Path(
        "build/verification"
    ),
    report: Annotated[Path, file_option("The report to write.", name="--report")] = Path(
        "docs/verification.md"
    ),
) -> int:
    """Run the checks that are not measured yet and write the report with all that are.

    It can be stopped and started again: every solve and every check is kept. Exit code 1 means
    that a mark is missed.
    """
    from ..verification.checks import CHECKS, check_named

    if known:
        refuse_beside(context, "beside --list", "only", "quick", "afresh", "folder", "report")
        for check in CHECKS:
            typer.echo(f"{check.name:22} {check.title}")
        return 0
    chosen = [check_named(name) for name in only] if only else list(CHECKS)
    from ..verification.bench import Bench, Effort
    from ..verification.report import write_report
    from ..verification.runner import run_checks

    bench = Bench(
        folder=folder,
        effort=Effort.QUICK if quick else Effort.PRODUCTION,
        say=typer.echo,
    )
    results = run_checks(chosen, bench=bench, afresh=afresh)
    missed = [(r.name, m) for r in results for m in r.missed]
    for name, m in missed:
        typer.echo(f"missed: {name}: {m.what}: {m.value:.4g} {m.unit} ({m.mark})")
    typer.echo(f"written: {write_report(report, folder=folder)}")
    return EXIT_MISSED if missed else 0
