"""`dentscope inverse`: duration and mean force of an oblique impact from what it left behind."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from ..core.inputs.templates import INVERSE, write_new
from ..core.output import write_csv
from .shared.places import folder_option, misused, refuse_beside
from .shared.terminal import new_console, show_table

_SHOWN = (
    ("alpha", "alpha", 1.0, "{:.4f}"),
    ("to last\nparting [ms]", "duration", 1e3, "{:.3f}"),
    ("mean\nforce [N]", "mean_force", 1.0, "{:.0f}"),
    ("back at\nsurface [ms]", "return_duration", 1e3, "{:.3f}"),
    ("mean\nforce [N]", "return_force", 1.0, "{:.0f}"),
)
"""Head of a column, and what of a trial stands in it: name, scale, form."""


def inverse(
    context: typer.Context,
    file: Annotated[Path | None, typer.Argument(help="TOML with [striker] and [[trial]].")] = None,
    new: Annotated[
        bool, typer.Option("--new", help="Write a file to start from, inverse.toml by default.")
    ] = False,
    out: Annotated[Path, folder_option("Folder for the CSV.")] = Path("build/impact"),
) -> None:
    """Infer duration and mean force from depth, sliding length and restitution (chapter 5)."""
    if new:
        refuse_beside(context, "beside --new", "out")
        typer.echo(write_new(INVERSE, file or Path("inverse.toml"), command="inverse"))
        return
    if file is None:
        needed = "a TOML with [striker] and [[trial]]; --new writes one"
        raise misused("no file", key="FILE", allowed=needed)
    from ..core.inputs.toml_input import read_toml

    read_toml(file)  # what is no TOML is told before the simulation is loaded
    from ..dynamics.files.inverse_file import read_inverse

    console = new_console()
    rows = read_inverse(file)
    show_table(
        console, ("trial", *(head for head, *_ in _SHOWN)),
        [
            (row.name, *(_cell(row, name, scale, form) for _, name, scale, form in _SHOWN))
            for row in rows
        ],
        title="duration and mean force from depth, sliding length and restitution",
    )  # fmt: skip
    console.print(
        "Assumed: one contact, rigid rod, constant angle, sliding to one side throughout."
    )
    for row in rows:
        for line in row.inferred.objections:
            console.print(f"  {row.name}: {line}", soft_wrap=True)
    cells = [_csv_row(row) for row in rows]
    written = write_csv(out / f"{file.stem}-inverse.csv", cells, header=cells[0])
    console.print(f"written: {written}", soft_wrap=True)


def _cell(row: Any, name: str, scale: float, form: str) -> str:
    """A number, and what the standard deviations of the rod make of it."""
    value, std = scale * getattr(row.inferred, name), row.std.get(name, 0.0)
    shown = form.format(value) if value == value else "none"
    return f"{shown} ± {scale * std:.2g}" if std > 0.0 else shown


def _csv_row(row: Any) -> dict[str, Any]:
    i, m = row.inferred, row.measured
    return {
        "trial": row.name, "angle_rad": m.angle, "impact_speed_m_s": m.speed,
        "friction": m.mu, "restitution": m.restitution, "permanent_depth_m": m.depth,
        "sliding_length_m": m.sliding, "alpha": i.alpha, "normal_impulse_Ns": i.impulse,
        "duration_s": i.duration, "mean_force_N": i.mean_force,
        "return_duration_s": i.return_duration, "return_mean_force_N": i.return_force,
        **{f"{name}_std": std for name, std in row.std.items()},
        "objections": "; ".join(i.objections),
    }  # fmt: skip
