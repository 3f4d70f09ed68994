"""`dentscope campaign`: what is done with the cases that were computed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from ..core.errors import EXIT_NOT_CONVERGED, InputError
from ..core.output import csv_text, write_file
from ..core.tables import counted, parquet
from .shared.places import file_option, folder_option, misused
from .shared.terminal import new_console, show_table

PUBLISHED = Path(__file__).parents[1] / "data" / "campaign"
"""Folder of the published data: that of `campaigns.parts`, which help must not load."""

DEFAULT_DESIGN = "full"
"""Sweep of a command that names none."""

Out = Annotated[Path, folder_option("Folder of the run.")]
DesignName = Annotated[
    str, typer.Option(help="Which sweep, or a folder of CASE.toml files; see `campaign designs`.")
]


def design_of(name: str) -> Any:
    """Return a design, or that of the CASE.toml files of a folder; refuse what is neither."""
    from ..campaigns import DESIGNS, Case, Design, design_named
    from ..start.case_file import read_case

    folder = Path(name)
    if name in DESIGNS or not folder.is_dir():
        return design_named(name)
    cases = []
    for file in sorted(folder.glob("*.toml")):
        problem, accuracy = read_case(file)
        # fields are what one pair is looked at for, by `dentscope case`
        cases.append(Case(file.stem, replace(problem, snapshots=()), accuracy))
    if not cases:
        raise misused(f"no CASE.toml in {name}", key="--design", allowed="one for each pair")
    return Design(folder.resolve().name, "pairs of your own", lambda: tuple(cases))


def show(
    case: Annotated[str, typer.Argument(help="Name, or id or its beginning.")],
    out: Out = Path("build/campaign"),
) -> None:
    """Print one case of the own run, else of the published data: pair, curve, unloadings."""
    record, source = _found(case, out)
    pair = record.case.pair
    console = new_console()
    console.print(f"{record.case.name}: {record.status} {record.message}".rstrip())
    console.print(f"{source}, {record.case.id[:12]}", soft_wrap=True)
    c = record.curve
    scale, over = (pair.Sy_min, "H/Sy_min") if pair.Sy_min < float("inf") else (1e6, "H [MPa]")
    rows = [
        (
            f"{c['delta'][i] / pair.R:.4g}", f"{c['force'][i]:.4g}", f"{c['radius'][i] * 1e3:.4g}",
            f"{c['sphere'][i] / (c['sphere'][i] + c['flat'][i]):.3f}",
            f"{c['hardness'][i] / scale:.4g}",
        )
        for i in range(0, len(c.get("delta", ())), 3)
    ]  # fmt: skip
    if rows:
        show_table(console, ("Delta/R", "F [N]", "a [mm]", "sphere's share", over), rows)
    for unloading in record.unloadings:
        console.print(
            f"unloaded from Delta/R = {unloading.depth:.4g}: left in the sphere "
            f"{unloading.residual_sphere * 1e6:.3g} um, in the flat "
            f"{unloading.residual_flat * 1e6:.3g} um"
        )


def _found(case: str, out: Path) -> tuple[Any, str]:
    """Return a case by its name or the beginning of its id, and where it was found."""
    from ..campaigns import Store, read_published

    for some, where in ((Store(out).read_all(), str(out)), (None, str(PUBLISHED))):
        some = read_published(PUBLISHED) if some is None else some
        found = [r for r in some if r.case.name == case]
        found = found or [r for r in some if case and r.case.id.startswith(case)]
        if len(found) == 1:
            return found[0], where
        if found:
            raise InputError(
                f"{len(found)} cases begin with {case!r}", source=where, key="CASE",
                allowed="more of the id",
            )  # fmt: skip
    told = f"no case {case!r} in the own run or the published data"
    raise misused(told, key="CASE", allowed="a name or an id of `dentscope campaign status`")


def refine(
    case: Annotated[str, typer.Argument(help="Case id or its beginning.")],
    out: Out = Path("build/campaign"),
) -> int:
    """Solve one case again more finely: which of its steps are the mesh's, how far is it off."""
    from ..campaigns import Store, largest_difference
    from ..campaigns.executor import solve_specification
    from ..campaigns.quality import steps_not_in

    record = Store(out).read(case)
    finer = record.case.refined()
    typer.echo(f"{record.case.name}: elements {finer.accuracy.fine:g} of the contact radius")
    solution = solve_specification(finer.specification(), math.inf)
    again = Store(out / "refined")
    again.put(finer, solution)
    other = again.read(finer.id)
    if not solution.outcome.completed:
        typer.echo(str(solution.outcome))
        return EXIT_NOT_CONVERGED
    found = largest_difference([record], [other])
    steps = steps_not_in(record.curve, other.curve)
    before = (record.quality.force_step, record.quality.radius_step, record.quality.share_step)
    apart = (found.force, found.radius, found.share)
    for name, own, shown, far in zip(("F", "a", "delta_s*"), before, steps, apart, strict=True):
        typer.echo(
            f"{name:9} largest step {own:.2%}, of it not in the finer solve {shown:.2%}; "
            f"largest difference {far:.2%}"
        )
    return 0


def export(
    out: Out = Path("build/campaign"),
    to: Annotated[Path, file_option("File to write, .csv or .parquet.")] = Path(
        "build/campaign/curves.csv"
    ),
    data: Annotated[
        Path | None, typer.Option(help="Another run, or a folder of parts, instead of --out.")
    ] = None,
) -> None:
    """Write all loading curves as one table: CSV, or Parquet where the name ends so."""
    from ..campaigns import read_curves

    source = data or out
    records = read_curves(source)
    if not records:
        raise InputError("no completed case", source=str(source))
    names = list(records[0].curve)
    if to.suffix not in (".csv", ".parquet"):
        raise InputError(
            repr(to.suffix), key="--to", allowed="a name that ends in .csv or .parquet"
        )
    head = ["case", "E_s_Pa", "nu_s", "Sy_s_Pa", "E_f_Pa", "nu_f", "Sy_f_Pa", "R_m", *names]
    if to.suffix == ".parquet":
        columns = zip(*_rows(records, names), strict=True)
        write_file(to, parquet(dict(zip(head, columns, strict=True))))
    else:
        write_file(to, csv_text(_rows(records, names), header=head))
    typer.echo(f"{len(records)} cases -> {to}")


def publish(
    design: DesignName = "full",
    out: Out = Path("build/campaign"),
    to: Annotated[Path, folder_option("Folder of the data set.", name="--to")] = Path(
        "data/campaign"
    ),
) -> None:
    """Make immutable parts below 10 MB from a complete run."""
    from ..campaigns import publish as write_parts

    for part in write_parts(design_of(design), out, to):
        typer.echo(f"{part}: {part.stat().st_size / 1e6:.1f} MB")


def repair(out: Out = Path("build/campaign")) -> int:
    """Set damaged cases of a run aside; the next run computes them again."""
    from ..campaigns import Store

    if not out.is_dir():
        raise misused(str(out), key="--out", allowed="the folder of a run")
    kept, lost = Store(out).repair()
    for line in lost:
        typer.echo(f"set aside: {line}")
    typer.echo(f"{counted(kept, 'case')} whole in {out}")
    return EXIT_NOT_CONVERGED if lost else 0


def _rows(records: list[Any], names: list[str]) -> Iterator[list[Any]]:
    for record in records:
        p = record.case.pair
        start = [record.case.name, p.sphere.E, p.sphere.nu, p.sphere.Sy]
        start += [p.flat.E, p.flat.nu, p.flat.Sy, p.R]
        for row in zip(*(record.curve[name] for name in names), strict=True):
            yield [*start, *row]
