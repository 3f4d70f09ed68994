"""`dentscope export`: a law for other programs, as source or as parameters of their own laws."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..core.errors import InputError
from .laws import laws_named
from .shared.groups import group
from .shared.places import folder_option, misused
from .shared.terminal import new_console, say, show_table

if TYPE_CHECKING:
    from ..dynamics.export.discrete_elements import ExportedRow
    from ..models.base import ContactLaw
    from ..start.ball_file import ExportedBall

# limit: speeds of a range that is exported [-]
_SPEEDS_EXPORTED = 7

app = group("A law for other programs: as source, or as parameters of a discrete-element code.")


@app.command("law")
def export_law(
    law: Annotated[
        str,
        typer.Argument(help="compact, fitted, or a fitted.json of `dentscope fit`."),
    ] = "fitted",
    out: Annotated[Path, folder_option("Folder for the sources.")] = Path("build/law"),
) -> None:
    """Write fitted or compact in Python, C, Fortran, MATLAB, Modelica, JavaScript, for LAMMPS."""
    from ..models import law_named
    from ..models.export import write_sources
    from ..models.fitted import ClosedForm
    from ..models.law_file import is_file

    found = law_named(law) if law in ("compact", "fitted") or is_file(law) else None
    if not isinstance(found, ClosedForm):
        known = "compact, fitted, a fitted.json of `dentscope fit`; any law: `export dem`"
        raise misused(f"{law!r} is no closed form of ours", key="LAW", allowed=known)
    for path in write_sources(found, out):
        typer.echo(str(path))


@app.command("dem")
def export_dem(
    file: Annotated[
        Path, typer.Argument(help="The ball and the flat: a set-up of `impact`, or CASE.toml.")
    ],
    speed: Annotated[str, typer.Option(
        help="Speeds of the impacts: FIRST:LAST or several with commas [m/s]; otherwise those "
        "of the file, or 0.1:10.",
    )] = "",
    mass: Annotated[
        float | None, typer.Option(help="Of the ball [kg]; otherwise the file's.")
    ] = None,
    law: Annotated[str, typer.Option(
        help="A law, or a file of `dentscope case` (law.json) or `fit`; otherwise fitted, with "
        "a flow curve hardening.",
    )] = "",
    out: Annotated[Path, folder_option("Folder for the table and the inputs.")] = Path("build/dem"),
) -> None:  # fmt: skip
    """Give the contact laws of other programs parameters for a pair, by speed.

    LAMMPS, MuJoCo, YADE (inputs that run as they are), Drake, a table for others, and a formula of
    the restitution. Each returns what our law returns; the table says what it misses in depth,
    force and time.
    """
    from ..start.ball_file import read_ball

    ball = read_ball(file, mass=mass)
    _write_dem(ball, law, _speeds(speed) if speed else _of_file(ball.speeds), out)


def _write_dem(ball: ExportedBall, law: str, speeds: list[float], out: Path) -> None:
    """Show what each law of other programs misses, and write its parameters."""
    from ..core.output import csv_text, write_file
    from ..dynamics.export.discrete_elements import HEAD, substitutes, table
    from ..dynamics.export.lammps import lammps_lines
    from ..dynamics.report.band import too_deep
    from ..models.choose import follows_flow

    chosen = ball.by(*laws_named([law or ball.law]))
    rows = substitutes(chosen, ball.pair, mass=ball.mass, speeds=speeds, asked=ball.asked)
    shown, between = new_console(), _between(ball, chosen, speeds)
    show_table(shown, *_misses(rows))
    for line in too_deep(chosen, [(ball.pair, [row.law.depth for row in rows])]):
        say(line)
    for row in rows:
        for name in row.left_out:
            say(row.without(name))
    if not (ball.pair.perfectly_plastic or follows_flow(chosen)):
        say(f"{chosen.name} takes the first strength of each metal, not its flow curve")
    acting = ", ".join(m.name for m in ball.asked.mechanisms)
    if acting:
        say(f"with {acting}" + ("; the lines for two balls are without" if between else ""))
    if ball.unused:
        but = ", but for what these mechanisms take" if acting else ""
        left = ", ".join(ball.unused)
        say(f"not in these parameters{but}: {left}; `dentscope impact` takes them")
    for line in ball.left_open(chosen):
        say(line)
    two = ball.second is not None
    cells = table(rows, law=chosen.name, contact="two spheres" if two else "ball on flat")
    cells += table(between, law=chosen.name, contact="two balls")
    files = {"dem.csv": csv_text(cells, header=HEAD)}
    if ball.second is None or ball.second.radius > 0.0:
        files["lammps.in"] = lammps_lines(
            rows, ball.pair, mass=ball.mass, friction=ball.friction, of_balls=between,
            second=ball.second,
        )  # fmt: skip
    for name, text in (files | _fragments(ball, chosen, rows)).items():
        shown.print(f"written: {write_file(out / name, text)}")


def _fragments(ball: ExportedBall, law: ContactLaw, rows: list[ExportedRow]) -> dict[str, str]:
    """What the other programs read, by file."""
    from ..dynamics.export import simulators as s

    contact = s.BodiesMet(ball.pair.R, ball.mass, ball.friction)
    speeds = [row.law.speed for row in rows]
    formula = s.formula_of(law, ball.pair, mass=ball.mass, speeds=speeds, asked=ball.asked)
    return {
        "yade_drop.py": s.yade_script(rows, contact),
        **s.mujoco_files(rows, contact),
        "drake.py": s.drake_lines(rows, contact),
        "formula.txt": s.formula_lines(formula),
    }


def _between(ball: ExportedBall, law: ContactLaw, speeds: list[float]) -> list[ExportedRow]:
    """Parameters for two such balls; none, with a line, where there are none."""
    from ..dynamics.export.discrete_elements import substitutes, two_balls
    from ..models.turned import similar

    if ball.second is not None:
        if ball.second.radius < 0.0:
            say("no lines for LAMMPS: it knows no concave seat")
        return []
    if ball.pair.sphere.rigid:
        say("no lines for two balls: both would be rigid")
        return []
    pair, half = two_balls(ball.pair, ball.mass)
    try:
        return substitutes(similar(law, 2.0), pair, mass=half, speeds=speeds)
    except InputError as error:
        say(f"no lines for two balls: {error}")
        return []


def _of_file(speeds: tuple[float, ...]) -> list[float]:
    """The file's speeds, as many as a table shows."""
    if not speeds:
        return _speeds("0.1:10")
    if len(speeds) <= _SPEEDS_EXPORTED:
        return list(speeds)
    return _speeds(f"{min(speeds)!r}:{max(speeds)!r}")


def _speeds(text: str) -> list[float]:
    """Read `0.1:10` as a range, `1,2,5` as they are; refuse what no speed may be."""
    import numpy as np

    from ..core.inputs.ranges import SPEEDS

    try:
        numbers = [float(x) for x in text.replace(":", ",").split(",")]
    except ValueError:
        numbers = []
    pair = len(numbers) == 2 and numbers[0] < numbers[1]
    if not numbers or any(map(SPEEDS.wanted, numbers)) or (":" in text and not pair):
        allowed = "FIRST:LAST, the lower first, or numbers with commas, up to 20000 [m/s]"
        raise misused(f"{text!r}", key="--speed", allowed=allowed)
    if ":" in text:
        numbers = np.geomspace(numbers[0], numbers[-1], _SPEEDS_EXPORTED).tolist()
    return numbers


def _misses(rows: list[ExportedRow]) -> tuple[list[str], list[list[str]]]:
    head = ["speed [m/s], law", "e", "depth [um]", "peak [N]", "time [us]"]
    lines = []
    for row in rows:
        b = row.law
        lines.append(
            [f"{b.speed:.3g}  ours", f"{b.restitution:.4f}", f"{b.depth * 1e6:.4g}",
             f"{b.force:.4g}", f"{b.time * 1e6:.4g}"]
        )  # fmt: skip
        for s in row.substitutes:
            depth, force, time, _ = (100.0 * x for x in s.missed(b))
            lines.append(
                [f"  {s.name}", f"{s.blow.restitution:.4f}", f"{depth:+.1f} %", f"{force:+.1f} %",
                 f"{time:+.1f} %"]
            )  # fmt: skip
    return head, lines
