"""`dentscope inverse`: duration and mean force of an oblique impact from what it left behind."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any

import typer

from . import studies


def inverse(
    file: Annotated[
        Path | None, typer.Argument(help="TOML with [striker] and [[trial]]; default: chapter 5.")
    ] = None,
    law: Annotated[
        list[str] | None,
        typer.Option("--law", help="Without a file: laws for tables 5.2-5.4; repeat for several."),
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder for the figure and the CSV.")] = Path(
        "build/impact"
    ),
) -> None:
    """Infer duration and mean force from depth, sliding length and restitution (chapter 5)."""
    if file is None:
        studies.needed_for("`dentscope inverse` without a file")
    from rich.console import Console
    from rich.table import Table

    from ..impact.draw import draw_alpha
    from ..impact.files.inverse_file import read_inverse
    from ..impact.files.tables import write_csv

    console = Console()
    if file is None:
        from ..studies.thesis.chapter5 import thesis_rows

        rod, rows = thesis_rows()
    else:
        rod, rows = read_inverse(file)
    table = Table(title="duration and mean force from depth, sliding length and restitution")
    for column in (
        "trial", "alpha", "to last\nparting\n(ms)", "mean\nforce\n(N)",
        "back at\nsurface\n(ms)", "mean\nforce\n(N)", "printed\n(ms)", "printed\n(N)",
    ):  # fmt: skip
        table.add_column(column, justify="right")
    for row in rows:
        i = row.inferred
        table.add_row(
            row.name, f"{i.alpha:.4f}", f"{i.duration * 1e3:.3f}", f"{i.mean_force:.0f}",
            f"{i.return_duration * 1e3:.3f}", f"{i.return_force:.0f}",
            _or_dash(row.printed_duration * 1e3, "{:.2f}"), _or_dash(row.printed_force, "{:.0f}"),
        )  # fmt: skip
    console.print(table)
    console.print(
        "Assumed: one contact, rigid rod, constant angle, sliding to one side throughout."
    )
    for row in rows:
        for line in row.inferred.objections:
            console.print(f"  {row.name}: {line}", soft_wrap=True, highlight=False)
    stem = "chapter5" if file is None else f"{file.stem}-inverse"
    write_csv(out / f"{stem}.csv", [_csv_row(row) for row in rows])
    draw_alpha(rod, (0.0, 0.1, 0.2, 0.5, 1.0), out / f"{stem}-alpha.png")
    if file is None:
        _tables(console, law or ["ghaednia"])
    console.print(f"written: {out / f'{stem}.csv'}, {out / f'{stem}-alpha.png'}", soft_wrap=True)


def _tables(console: Any, names: list[str]) -> None:
    """Tables 5.2-5.4: our rigid impacts at the stated mass and at the mass that fits."""
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    from ..core.toml_input import read_toml
    from ..studies.thesis.chapter3 import REFERENCE
    from ..studies.thesis.chapter5 import simulate_experiment, thesis_rod
    from .laws import laws_named

    data = read_toml(REFERENCE / "chapter45.toml")
    masses = (data["rod"]["mass_kg"], data["mass_that_fits"]["value_kg"])
    angles = data["simulation"][0]["angle_deg"]
    for place, (angle, experiment) in enumerate(zip(angles, data["experiment"], strict=True)):
        table = Table(
            title=f"table 5.{place + 2}: {angle} degrees, rigid rod",
            box=SIMPLE_HEAD,
            pad_edge=False,
        )
        for column in ("", "dent\n(um)", "e", "contact\n(ms)", "back at\nsurface\n(ms)",
                       "mean\nforce\n(N)", "sliding\n(um)", "later\n(um)"):  # fmt: skip
            table.add_column(column, justify="right", no_wrap=column == "")
        table.add_row(
            "measured", f"{-experiment['depth_m'] * 1e6:.0f}", f"{experiment['restitution']:.2f}",
            "-", "-", "-", f"{-experiment['sliding_m'] * 1e6:.0f}", "-",
        )  # fmt: skip
        for row in data["simulation"]:
            table.add_row(
                f"thesis: {row['law']}", f"{-row['depth_m'][place] * 1e6:.0f}",
                f"{row['restitution'][place]:.2f}", "-", f"{row['duration_s'][place] * 1e3:.2f}",
                f"{row['mean_force_N'][place]:.0f}", "-",
                f"{-row['sliding_m'][place] * 1e6:.0f}",
            )  # fmt: skip
        for law in laws_named(names):
            for mass in masses:
                i = simulate_experiment(experiment, law, mass=mass)
                arm = thesis_rod(mass=mass).arm(math.radians(angle))[1]
                leaving = abs(i.tangential_rebound_m_s + i.rebound_spin_rad_s * arm)
                later = i.sliding_length_m + leaving * (i.return_time_s - i.contact_time_s)
                table.add_row(
                    f"{law.name}, {mass:g} kg", f"{i.residual_flat_m * 1e6:.0f}",
                    f"{i.restitution:.2f}", f"{i.contact_time_s * 1e3:.3f}",
                    f"{i.return_time_s * 1e3:.3f}", f"{i.mean_force_N:.0f}",
                    f"{i.sliding_length_m * 1e6:.0f}", f"{later * 1e6:.0f}",
                )  # fmt: skip
        console.print(table)
    console.print(
        f"The stated {masses[0]:g} kg is 20 % below the rod's size times its density "
        f"({masses[1]:g} kg), which the thesis's own dents need.\n"
        "The thesis's durations and sliding lengths end with the tip back at the surface (later), "
        "its mean forces\nwith the last parting; its Ghaednia row at 45 degrees repeats the dent "
        "and sliding length of 20 degrees.",
        soft_wrap=True,
    )


def _or_dash(value: float, form: str) -> str:
    return form.format(value) if value == value else "-"


def _csv_row(row: Any) -> dict[str, Any]:
    i, m = row.inferred, row.measured
    return {
        "trial": row.name, "angle_rad": m.angle, "impact_speed_m_s": m.speed,
        "friction": m.mu, "restitution": m.restitution, "permanent_depth_m": m.depth,
        "sliding_length_m": m.sliding, "alpha": i.alpha, "normal_impulse_Ns": i.impulse,
        "duration_s": i.duration, "mean_force_N": i.mean_force,
        "return_duration_s": i.return_duration, "return_mean_force_N": i.return_force,
        "objections": "; ".join(i.objections),
    }  # fmt: skip
