"""`dentscope impact`: impacts of a rod or sphere on a flat, every chosen law side by side."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..core.errors import EXIT_NOT_CONVERGED
from ..core.inputs.templates import template, write_new
from ..core.output import write_csv, write_figure
from ..core.tables import counted
from .laws import laws_named
from .shared.places import folder_option, misused, refuse_beside
from .shared.terminal import new_console, say, show_table, tell_first_use

if TYPE_CHECKING:
    from ..dynamics.files.setup import Setup
    from ..dynamics.result import Impact
    from ..models.base import ContactLaw


def impact(
    context: typer.Context,
    setup: Annotated[Path | None, typer.Argument(help="Set-up file (TOML).")] = None,
    law: Annotated[
        list[str] | None, typer.Option("--law", help="Contact law; repeat for several.")
    ] = None,
    new: Annotated[
        str, typer.Option(help="Write ball, rod or oblique-ball into SETUP, or ./NAME.toml.")
    ] = "",
    exact: Annotated[
        bool, typer.Option("--exact", help="One line a number, without standard deviations.")
    ] = False,
    out: Annotated[Path, folder_option("Folder for figures, CSV, HDF5 and Parquet.")] = Path(
        "build/impact"
    ),
) -> None:
    """Simulate impacts by the fitted law, published ones beside it.

    From a file (the keys of a recording set's set.toml, [impact] and [sweep]): all observables of
    each law, histories, CSV and HDF5; every combination of [sweep] into CSV and Parquet.
    """
    if new:
        refuse_beside(context, "beside --new", "law", "exact", "out")
        target = setup or Path(f"{new}.toml")
        typer.echo(write_new(template(new), target, command="impact"))
    elif setup is None:
        needed = "a TOML with [target], [strikers.NAME] and [impact]; --new writes one"
        raise misused("no file", key="SETUP", allowed=needed)
    else:
        _from_file(setup, law or [], out, exact=exact)


def _from_file(path: Path, names: list[str], out: Path, *, exact: bool) -> None:
    from ..core.inputs.toml_input import read_toml

    read_toml(path)  # what is no TOML, or no law, is told before the simulation is loaded
    laws = laws_named(names) if names else []
    from ..dynamics.files.setup import read_setup

    setup = read_setup(path)
    laws = laws or laws_named(list(setup.laws), source=str(path), key="impact.laws")
    tell_first_use()
    from ..dynamics.files.blow import blow_of
    from ..dynamics.files.tables import write_hdf5
    from ..dynamics.report.picture import picture

    console = new_console()
    blow = blow_of(setup, laws)
    traces, found = blow.traces, blow.impacts
    console.print(setup.name)
    show_table(console, ("", *found), blow.table(exact=exact))
    for name, against in blow.doubts.items():
        console.print(f"{name}: {against}", soft_wrap=True)
    for line in (*([] if exact else blow.rules()), *blow.checks()):
        say(line)
    rows = blow.written(exact=exact)
    write_csv(out / f"{path.stem}.csv", rows, header=rows[0])
    write_hdf5(out / f"{path.stem}.h5", traces, about=setup.about)
    write_figure(picture(blow, exact=exact), out / f"{path.stem}.png", dpi=130)
    written = [out / f"{path.stem}{end}" for end in (".csv", ".h5", ".png")]
    if setup.varied and setup.repeats > 1:
        say(f"the sweep is of first blows: impact.repeats = {setup.repeats} acts above alone")
    unfinished = 0
    if setup.varied:
        files, unfinished, told = _sweep(setup, laws, out / f"{path.stem}-sweep", exact=exact)
        written += files
        if told:
            say(told)
    console.print("written: " + ", ".join(str(w) for w in written), soft_wrap=True)
    if unfinished:
        console.print(
            f"{counted(unfinished, 'impact')} of the sweep did not end: see the column outcome"
        )
    leave_if_unfinished(found)
    if unfinished:
        raise typer.Exit(EXIT_NOT_CONVERGED)


def _sweep(
    setup: Setup, laws: list[ContactLaw], base: Path, *, exact: bool
) -> tuple[list[Path], int, str]:
    """Run `[sweep]` for each law; return files, how many did not end, and what is to be told."""
    from importlib.util import find_spec

    import numpy as np

    from ..dynamics.report.band import MOST_SWEPT, swept_stds, too_deep
    from ..dynamics.report.checks import swept_above_one, swept_walls
    from ..dynamics.report.draw import draw_sweep, swept_in_vain

    curves = {law.name: setup.swept(law) for law in laws}
    first, *others = curves.values()
    stds = {} if exact or len(first) > MOST_SWEPT else swept_stds(setup, laws[0], first)
    first = first.joined(*others).with_stds(stds)
    scenes = [one.scene(laws[0]) for one in setup.rigs or (setup,)]
    depths = np.split(curves[laws[0].name]["peak_depth_m"], len(scenes))
    told = [*too_deep(laws[0], zip((one.pair for one in scenes), depths, strict=True))]
    told += [*swept_above_one(first), *swept_walls(scenes[0], first)]
    table, drawn, parquet = (base.with_name(f"{base.name}.{k}") for k in ("csv", "png", "parquet"))
    first.to_csv(table)
    written = [table]
    if (first["outcome"] == "completed").any():
        write_figure(draw_sweep(setup.varied, curves, stds=stds), drawn, dpi=130)
        written.append(drawn)
    for name in swept_in_vain(setup.varied, curves):
        say(f"sweep.{name} changes nothing here")
    if find_spec("pyarrow"):
        first.to_parquet(parquet)
        written.append(parquet)
    return written, int((first["outcome"] != "completed").sum()), "\n".join(told)


def leave_if_unfinished(impacts: Mapping[str, Impact]) -> None:
    """End with exit code 3 if an impact, by its law, ran out of a budget."""
    stopped = {law: one.outcome for law, one in impacts.items() if not one.outcome.completed}
    if stopped:
        told = f"{len(stopped)} of {len(impacts)} impacts ({', '.join(stopped)})"
        typer.echo(f"{told}: {next(iter(stopped.values()))}", err=True)
        raise typer.Exit(EXIT_NOT_CONVERGED)
