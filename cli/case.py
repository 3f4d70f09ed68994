"""`dentscope case`: the finite-element solve of a user's own pair."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Annotated, Any, Literal

import typer
from pydantic import Field

from ..core.errors import EXIT_NOT_CONVERGED, InputError
from ..core.material import Pair
from ..core.toml_input import InputTable, MaterialTable, read_model


class _Load(InputTable):
    max_delta_over_R: float = Field(gt=0.0, le=0.5)
    unload_from: tuple[float, ...] = ()


class _Accuracy(InputTable):
    level: Literal["production", "quick", "smoke"] = "quick"


class CaseFile(InputTable):
    """The keys of CASE.toml."""

    radius_m: float = Field(gt=0.0)
    sphere: MaterialTable
    flat: MaterialTable
    load: _Load
    accuracy: _Accuracy = _Accuracy()


_COLUMNS = (
    "phase",
    "delta_over_R",
    "force_N",
    "contact_radius_m",
    "contact_radius_last_node_m",
    "sphere_share",
    "hardness_over_Symin",
)


def case(
    file: Annotated[Path, typer.Argument(help="CASE.toml; see examples/case_steel.toml.")],
    out: Annotated[Path, typer.Option(help="Folder for results.")] = Path("build/case"),
    picture: Annotated[bool, typer.Option("--picture", help="Draw the stresses too.")] = False,
) -> int:
    """Solve one pair: table, curves, fields; every mistake in the file is a line."""
    from rich.console import Console
    from rich.progress import Progress

    from .. import fem
    from ..fem.fields import draw_section, write_vtu

    problem, accuracy = read_case(file)
    pair = problem.pair
    console = Console()
    with Progress(console=console, disable=not console.is_terminal) as bar:
        task = bar.add_task(f"solving at level {accuracy.level}", total=1.0)
        solution = fem.solve(
            problem, accuracy=accuracy, progress=lambda done: bar.update(task, completed=done)
        )
    if len(solution.loading.delta) == 0:
        console.print(str(solution.outcome), highlight=False)
        return EXIT_NOT_CONVERGED
    out.mkdir(parents=True, exist_ok=True)
    table = _write_curves(solution, out / "curve.csv")
    _show(console, solution)
    console.print(f"written: {table}", highlight=False)
    for snapshot in solution.snapshots:
        name = f"fields-{snapshot.depth:.4g}"
        console.print(f"written: {write_vtu(snapshot, out / f'{name}.vtu')}", highlight=False)
        if picture:
            extent = 2.5 * float(solution.loading.radius[-1])
            strength = pair.Sy_min if pair.Sy_min < float("inf") else pair.E_reduced
            tool = draw_section(snapshot, out / f"{name}.png", Sy_min=strength, extent=extent)
            console.print(f"written: {out / f'{name}.png'} (drawn by {tool})", highlight=False)
    if not solution.outcome.completed:
        console.print(str(solution.outcome), highlight=False)
        return EXIT_NOT_CONVERGED
    return 0


def read_case(file: Path) -> tuple[Any, Any]:
    """Read CASE.toml into the solver's problem and accuracy.

    Raises
    ------
    InputError
        Every mistake, a line each.
    """
    from .. import fem

    content = read_model(file, CaseFile)
    source = str(file)
    pair = Pair(
        sphere=content.sphere.to_material(source=source, key="sphere"),
        flat=content.flat.to_material(source=source, key="flat"),
        R=content.radius_m,
    )
    last = content.load.max_delta_over_R
    # recorded from below first yield; a body that yields late or never still gets two decades
    first = min(0.3 * fem.critical_depth(pair), 1e-2 * last)
    unload = tuple(sorted(content.load.unload_from))
    for depth in unload:
        if not first < depth <= last:
            raise InputError(
                f"{depth:g}",
                source=source,
                key="load.unload_from",
                allowed=f"Delta/R above {first:.3g} and up to max_delta_over_R = {last:g}",
            )
    problem = fem.ContactProblem(
        pair=pair,
        depths=fem.geometric_depths(first, last, 60),
        unload_from=unload,
        snapshots=(last,),
    )
    levels = {
        "production": fem.Accuracy.production,
        "quick": fem.Accuracy.quick,
        "smoke": fem.Accuracy.smoke,
    }
    return problem, levels[content.accuracy.level]()


def _write_curves(solution: Any, path: Path) -> Path:
    pair = solution.problem.pair
    phases = [("load", solution.loading)]
    phases += [(f"unload-{i}", u.curve) for i, u in enumerate(solution.unloadings, start=1)]
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(_COLUMNS)
        for phase, c in phases:
            share = c.sphere_share
            for i in range(len(c.delta)):
                writer.writerow(
                    [phase, c.delta[i] / pair.R, c.force[i], c.radius[i], c.radius_last_node[i],
                     share[i], c.hardness[i] / pair.Sy_min]
                )  # fmt: skip
    return path


def _show(console: Any, solution: Any) -> None:
    from rich.table import Table

    pair, c = solution.problem.pair, solution.loading
    table = Table("Delta/R", "F [N]", "a [mm]", "sphere's share", "H/Sy_min")
    share = c.sphere_share
    for i in range(0, len(c.delta), max(1, len(c.delta) // 12)):
        table.add_row(
            f"{c.delta[i] / pair.R:.4g}",
            f"{c.force[i]:.5g}",
            f"{c.radius[i] * 1e3:.4g}",
            f"{share[i]:.4f}",
            f"{c.hardness[i] / pair.Sy_min:.3f}",
        )
    console.print(table)
    for u in solution.unloadings:
        console.print(
            f"unloaded from Delta/R = {u.depth:.4g}: left in the sphere "
            f"{u.residual_sphere * 1e6:.4g} um, in the flat {u.residual_flat * 1e6:.4g} um"
        )
    k = solution.counters
    console.print(
        f"{k.dofs} unknowns, {k.steps} steps, {k.iterations} iterations, {k.cpu_s:.0f} processor "
        f"seconds; largest energy defect {abs(c.energy_defect).max():.2%}"
    )
