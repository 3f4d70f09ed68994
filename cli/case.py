"""`dentscope case`: the finite-element solve of a user's own pair."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..core.errors import EXIT_NOT_CONVERGED, InputError
from ..core.inputs.templates import CASE, write_new
from ..core.output import csv_text, write_figure, write_file
from ..core.tables import thinned
from .shared.places import folder_option, misused, refuse_beside
from .shared.terminal import new_console, say, show_table

if TYPE_CHECKING:
    from ..start.measured import MeasuredContact

_COLUMNS = (
    "force_N", "contact_radius_m", "contact_radius_last_node_m", "sphere_share", "hardness_Pa",
    "hardness_over_Symin",
)  # fmt: skip
_FIELDS = {
    "points": "m", "quads": "1", "displacement": "m", "von_mises": "Pa", "plastic_strain": "1",
    "mean_stress": "Pa", "stress": "Pa",
}  # fmt: skip
"""Units of the fields."""


def case(
    context: typer.Context,
    file: Annotated[
        Path | None, typer.Argument(help="CASE.toml: two bodies, how far, how finely.")
    ] = None,
    new: Annotated[
        bool, typer.Option("--new", help="Write a file to start from, case.toml by default.")
    ] = False,
    out: Annotated[Path, folder_option("Folder for results.")] = Path("build/case"),
    picture: Annotated[bool, typer.Option("--picture", help="Draw the bodies cut open.")] = False,
) -> int:
    """Solve your own pair by finite elements: curves, pressures, dent, stress fields.

    The uncertainty is what the level of accuracy was found to be off on fifteen pairs.
    """
    if new:
        refuse_beside(context, "beside --new", "out", "picture")
        typer.echo(write_new(CASE, file or Path("case.toml"), command="case"))
        return 0
    if file is None:
        raise misused("no file", key="FILE", allowed="CASE.toml; --new writes one")
    from rich.progress import Progress

    from ..start.case_file import read_case, read_pair

    problem, accuracy = read_case(file)
    # loaded after the file is read: a mistake in it is told at once
    from ..start.pair import solved

    console = new_console()
    with Progress(console=console, disable=not console.is_terminal) as bar:
        task = bar.add_task("solving", total=1.0)
        found = solved(problem, accuracy, lambda done: bar.update(task, completed=done))
    solution, uncertainty = found.solution, found.uncertainty
    if uncertainty is None:
        console.print(str(solution.outcome))
        return EXIT_NOT_CONVERGED
    _show(console, solution, uncertainty)
    told = found.measured
    console.print("\n".join(told.lines(read_pair(file)[0].ball_mass)))
    tell_unused(file)
    if found.remark:
        console.print(found.remark)
    for path in (
        _write_curves(solution, uncertainty, out / "curve.csv"),
        write_figure(found.plot(), out / "curve.png", dpi=130),
        *_write_measured(solution, told, out),
        _write_result(file.stem, solution, uncertainty, out / "result.h5"),
    ):
        console.print(f"written: {path}")
    console.print(_write_law(solution, uncertainty, out / "law.json"))
    for path in found.draw_fields(out, cut=picture):
        console.print(f"written: {path}")
    if not solution.outcome.completed:
        console.print(str(solution.outcome))
        return EXIT_NOT_CONVERGED
    return 0


def tell_unused(file: Path) -> None:
    """Say what the file states and a solve has no use for."""
    from ..core.inputs.toml_input import read_toml
    from ..core.inputs.unused_keys import unused_keys

    content = read_toml(file)
    if "speed_m_s" in content["load"] and not any("rate" in content[k] for k in ("sphere", "flat")):
        say("load.speed_m_s does nothing here: neither body has a rate")
    unused = [
        one for one in unused_keys(content, ())
        if one.partition(" = ")[0].endswith((".std", "flat.density_kg_m3"))
    ]  # fmt: skip
    if unused:
        say(f"not in this solve: {', '.join(unused)}; `dentscope impact` takes them")


def _write_measured(solution: Any, told: MeasuredContact, out: Path) -> Iterator[Path]:
    """Write what people measure; write and draw the surfaces that the last unloading leaves."""
    from ..fem.results.dent import draw_dent, write_dent

    yield write_file(out / "measured.json", json.dumps(told.to_dict(), indent=1) + "\n")
    if not solution.unloadings:
        return
    last, R = solution.unloadings[-1], solution.problem.pair.R
    loaded = next((one.profile for one in solution.snapshots if one.depth == last.depth), None)
    yield write_dent(last, out / "dent.csv")
    yield draw_dent(last, out / "dent.png", R=R, under_load=loaded, rim=told.dents[-1].rim_diameter)


def _write_law(solution: Any, uncertainty: Any, path: Path) -> str:
    """Write the pair as a contact law where there are unloadings enough; say so, or why not."""
    from ..fitting.case_table import pair_table
    from ..models.table_file import write_table

    try:
        table = pair_table(solution, uncertainty)
    except InputError as error:
        return f"no law.json: {error}"
    return f"written: {write_table(table, path)} (a contact law: --law {path})"


def _write_curves(solution: Any, uncertainty: Any, path: Path) -> Path:
    pair = solution.problem.pair
    phases = [("load", solution.loading)]
    phases += [(f"unload-{i}", u.curve) for i, u in enumerate(solution.unloadings, start=1)]
    named = [name for column in _COLUMNS for name in (column, f"{column}_uncertainty")]
    rows: list[tuple[Any, ...]] = []
    for phase, c in phases:
        values = _columns(c, pair.Sy_min)
        # the table of mesh errors is of loading only
        none = [[""] * len(c.delta)] * len(values)
        errors = _columns(uncertainty, pair.Sy_min) if phase == "load" else none
        pairs = chain.from_iterable(zip(values, errors, strict=True))
        rows += [(phase, *row) for row in zip(c.delta / pair.R, *pairs, strict=True)]
    return write_file(path, csv_text(rows, header=["phase", "delta_over_R", *named]))


def _columns(of: Any, Sy_min: float) -> tuple[Any, ...]:
    """The columns of `_COLUMNS`, from a curve or from its uncertainty."""
    # a pair that never yields has no strength to be measured by
    over = [""] * len(of.hardness) if Sy_min == float("inf") else of.hardness / Sy_min
    return (of.force, of.radius, of.radius_last_node, of.sphere_share, of.hardness, over)


def _write_result(name: str, solution: Any, uncertainty: Any, path: Path) -> Path:
    """Write everything into one file: a run's file of a case, with uncertainties and fields."""
    from ..campaigns import Case
    from ..campaigns.case_file import case_image
    from ..campaigns.schema import CURVE

    # the fields lie beside the case in this file, not in files of their own
    case = Case(name, replace(solution.problem, snapshots=()), solution.accuracy)

    def add(group: Any) -> None:
        for key in ("force", "radius", "radius_last_node", "sphere_share", "hardness"):
            values = getattr(uncertainty, key)
            data = group.create_dataset(f"loading/{key}_uncertainty", data=values)
            data.attrs["unit"] = CURVE[key].unit if key in CURVE else "1"
        for snapshot in solution.snapshots:
            part = group.create_group(f"fields-{snapshot.depth:.6g}")
            part.attrs["depth"] = snapshot.depth
            part.attrs["n_sphere_quads"] = snapshot.n_sphere_quads
            packed = {"compression": "gzip", "shuffle": True, "fletcher32": True}
            for key, unit in _FIELDS.items():
                data = part.create_dataset(key, data=getattr(snapshot, key), **packed)
                data.attrs["unit"] = unit

    return write_file(path, case_image(case, replace(solution, snapshots=()), also=add))


def _show(console: Any, solution: Any, u: Any) -> None:
    pair, c = solution.problem.pair, solution.loading
    scale, over = (pair.Sy_min, "H/Sy_min") if pair.Sy_min < float("inf") else (1e6, "H [MPa]")
    rows = [
        (
            f"{c.delta[i] / pair.R:.4g}", f"{c.force[i]:.5g} ± {u.force[i]:.1g}",
            f"{c.radius[i] * 1e3:.4g} ± {u.radius[i] * 1e3:.1g}",
            f"{c.sphere_share[i]:.4f} ± {u.sphere_share[i]:.1g}",
            f"{c.hardness[i] / scale:.3g} ± {u.hardness[i] / scale:.1g}",
        )
        for i in thinned(len(c.delta))
    ]  # fmt: skip
    show_table(console, ("Delta/R", "F [N]", "a [mm]", "sphere's share", over), rows)
    k = solution.counters
    console.print(
        f"{k.dofs} unknowns, {k.steps} steps, {k.iterations} iterations, {k.cpu_s:.0f} processor "
        f"seconds; largest energy defect {abs(c.energy_defect).max():.2%}"
    )
