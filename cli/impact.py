"""`dentscope impact`: impacts of a rod or sphere on a flat, every chosen law side by side."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.errors import EXIT_NOT_CONVERGED
from . import studies

if TYPE_CHECKING:
    from ..impact.result import Impact
    from ..models.base import ContactLaw

_DEFAULT = ("hertz", "jackson-green", "ghaednia", "fitted")


def impact(
    setup: Annotated[
        Path | None, typer.Argument(help="Set-up file (TOML); without it, chapter 3 again.")
    ] = None,
    law: Annotated[
        list[str] | None, typer.Option("--law", help="Contact law; repeat for several.")
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder for figures, CSV and HDF5.")] = Path(
        "build/impact"
    ),
) -> None:
    """Simulate impacts and compare contact laws.

    Without a file: the thesis's rod dropped on the thesis's flat (chapter 3), restitution and
    residual depth of each law beside the measured values. With a file (the keys of a recording
    set's set.toml and [impact]): all observables of each law, histories, CSV and HDF5.
    """
    if setup is None:
        studies.needed_for("`dentscope impact` without a set-up file")
        _chapter3(law or [], out)
    else:
        _from_file(setup, law or [], out)


def laws_named(names: list[str], *, source: str = "command line", key: str = "--law") -> Any:
    """Return the laws of these names; an unknown one is an error that lists the known."""
    from ..core.errors import InputError
    from ..models import LAWS

    for name in names:
        if name not in LAWS:
            raise InputError(f"no law {name!r}", source=source, key=key, allowed=", ".join(LAWS))
    return [LAWS[name] for name in names]


def _default_laws() -> list[ContactLaw]:
    from ..models import LAWS

    return [LAWS[name] for name in _DEFAULT if name in LAWS]


def _chapter3(names: list[str], out: Path) -> None:
    from rich.console import Console
    from rich.table import Table

    from ..impact.tables import impact_row, write_csv
    from ..studies.thesis import chapter3

    console = Console()
    found = chapter3.bench()
    laws = laws_named(names) if names else _default_laws()
    masses = (found.striker.mass, found.mass_that_fits)
    curves = chapter3.curves(found, laws, masses=masses)
    console.print(
        "Chapter 3: the upright rod dropped on the flat, as a rigid body; every law beside the "
        "measured values (deviation in brackets).",
        soft_wrap=True,
    )
    for mass in masses:
        stated = mass == found.striker.mass
        label = "as stated" if stated else "not stated: makes depths and restitution agree"
        table = Table(title=f"mass {mass:g} kg ({label})", title_justify="left")
        table.add_column("law", no_wrap=True)
        for row in found.measured:
            unit = "e" if row["observable"] == "restitution" else "depth, um,"
            table.add_column(f"{unit}\nat {row['drop_height_m']:.2f} m", justify="right")
        table.add_row("measured", *(_shown(row, row["value"]) for row in found.measured))
        for curve in (c for c in curves if c.mass == mass):
            cells = []
            for row in found.measured:
                ours, off = chapter3.deviation(curve, row)
                cells.append(f"{_shown(row, ours)} ({off:+.0%})")
            table.add_row(curve.law.name, *cells)
        console.print(table)
    console.print("The stated inputs contradict each other:")
    for line in chapter3.contradictions(found):
        console.print(f"  {line}", soft_wrap=True, highlight=False)
    rows = [
        {"law": c.law.name, "mass_kg": c.mass, "drop_height_m": float(h), **impact_row(i)}
        for c in curves
        for h, i in zip(c.heights, c.impacts, strict=True)
    ]
    write_csv(out / "chapter3.csv", rows)
    chapter3.draw_chapter3(found, curves, out / "chapter3.png")
    console.print(f"written: {out / 'chapter3.csv'}, {out / 'chapter3.png'}", soft_wrap=True)
    _leave_if_unfinished([i for c in curves for i in c.impacts])


def _shown(row: Any, value: float) -> str:
    return f"{value:.3f}" if row["observable"] == "restitution" else f"{value * 1e6:.1f}"


def _from_file(path: Path, names: list[str], out: Path) -> None:
    from rich.console import Console
    from rich.table import Table

    from ..impact.draw import draw_histories, draw_sweep
    from ..impact.integrate import strike
    from ..impact.reference import reference_impact
    from ..impact.setup import read_setup
    from ..impact.tables import SHOWN, impact_row, write_csv, write_hdf5

    console = Console()
    setup = read_setup(path)
    laws = (
        laws_named(names)
        if names
        else laws_named(list(setup.laws), source=str(path), key="impact.laws")
    )
    traces, rows = {}, []
    for law in laws:
        scene = setup.scene(law)
        for number in range(1, setup.repeats + 1):
            impact_here = strike(scene, setup.settings)
            rows.append({"law": law.name, "repeat": number, **impact_row(impact_here)})
            trace = reference_impact(scene, setup.settings, points=200)
            # The next blow falls on the same spot: hardened crater, flattened tip.
            scene = scene.with_(spot=impact_here.spot)
        traces[law.name] = trace
    table = Table(title=setup.name)
    table.add_column("observable")
    for name in traces:
        table.add_column(name, justify="right")
    table.add_column("unit")
    for label, key, factor, unit in SHOWN:
        values = [getattr(t.impact, key) for t in traces.values()]
        # a tip that comes straight down has no tangential speed to be given back
        table.add_row(
            label, *("none" if math.isnan(v) else f"{factor * v:.4g}" for v in values), unit
        )
    console.print(table)
    write_csv(out / f"{path.stem}.csv", rows)
    write_hdf5(out / f"{path.stem}.h5", traces)
    draw_histories(list(traces.items()), out / f"{path.stem}.png")
    written = [out / f"{path.stem}{end}" for end in (".csv", ".h5", ".png")]
    if setup.sweep:
        sweeps = [
            (law.name, [strike(setup.scene(law, speed=v), setup.settings) for v in setup.sweep])
            for law in laws
        ]
        draw_sweep(setup.sweep, sweeps, out / f"{path.stem}-sweep.png")
        written.append(out / f"{path.stem}-sweep.png")
    console.print("written: " + ", ".join(str(w) for w in written), soft_wrap=True)
    _leave_if_unfinished([t.impact for t in traces.values()])


def _leave_if_unfinished(impacts: list[Impact]) -> None:
    stopped = [i for i in impacts if not i.outcome.completed]
    if stopped:
        typer.echo(f"{len(stopped)} of {len(impacts)} impacts: {stopped[0].outcome}", err=True)
        raise typer.Exit(EXIT_NOT_CONVERGED)
