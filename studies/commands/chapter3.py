"""`dentscope impact` without a file: the thesis's chapter 3 beside our own impacts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ...dynamics.result import Impact


def chapter3(names: list[str], out: Path) -> list[Impact]:
    """Print chapter 3 beside our impacts, write its files and return the impacts."""
    from ...cli.laws import laws_named
    from ...cli.shared.terminal import console as new_console
    from ...cli.shared.terminal import show_table
    from ...dynamics.files.setup import DEFAULT_LAWS
    from ...dynamics.files.tables import impact_row, write_csv
    from ..thesis import chapter3 as thesis

    console = new_console()
    found = thesis.bench()
    laws = laws_named(names or list(DEFAULT_LAWS))
    masses = (found.striker.mass, found.mass_that_fits)
    curves = thesis.curves(found, laws, masses=masses)
    console.print(
        "Chapter 3: the upright rod dropped on the flat, as a rigid body; every law beside the "
        "measured values (deviation in brackets).",
        soft_wrap=True,
    )
    for mass in masses:
        stated = mass == found.striker.mass
        label = "as stated" if stated else "not stated: makes depths and restitution agree"
        head = ["law"]
        for row in found.measured:
            unit = "e" if row["observable"] == "restitution" else "depth, um,"
            head.append(f"{unit}\nat {row['drop_height_m']:.2f} m")
        rows = [("measured", *(_shown(row, row["value"]) for row in found.measured))]
        for curve in (c for c in curves if c.mass == mass):
            off = (thesis.deviation(curve, row) for row in found.measured)
            cells = (
                f"{_shown(row, ours)} ({part:+.0%})"
                for row, (ours, part) in zip(found.measured, off, strict=True)
            )
            rows.append((curve.law.name, *cells))
        show_table(console, head, rows, title=f"mass {mass:g} kg ({label})")
    console.print("The stated inputs contradict each other:")
    for line in thesis.contradictions(found):
        console.print(f"  {line}", soft_wrap=True)
    written = [
        {"law": c.law.name, "mass_kg": c.mass, "drop_height_m": float(h), **impact_row(i)}
        for c in curves
        for h, i in zip(c.heights, c.impacts, strict=True)
    ]
    write_csv(out / "chapter3.csv", written)
    thesis.draw_chapter3(found, curves, out / "chapter3.png")
    console.print(f"written: {out / 'chapter3.csv'}, {out / 'chapter3.png'}", soft_wrap=True)
    return [i for c in curves for i in c.impacts]


def _shown(row: Any, value: float) -> str:
    return f"{value:.3f}" if row["observable"] == "restitution" else f"{value * 1e6:.1f}"
