"""Table-tennis balls with measured spin as a recording set.

    python data/recordings/recipes/tabletennis_spin.py trajectories.zip SET [COUNT]

Raw file: `dentscope recordings fetch tabletennis-spin` (no licence stated, so not shipped), or
cogsys-tuebingen/spindoe, data/trajectories. Each trajectory (time, x, y, z of the ball in the
table's frame) becomes one trial: `dentscope reduce mocap` of one point, with the spin that the
authors read from dots on the ball as spin before the bounce. The spin after it was not measured.
"""

import tempfile
import zipfile
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from dentscope.core.errors import InputError
from dentscope.reduce.kinds import load_kind
from dentscope.reduce.output.into_set import store_each
from dentscope.reduce.output.recipe import run_recipe
from dentscope.reduce.output.row import Row
from dentscope.reduce.reduced import Reduced

NEAR = 0.03
"""How far from z = 0, the centre of the ball at contact, a bounce may be found [m]."""

BALL = {"shape": "sphere", "tip_radius_m": 0.02, "mass_kg": 0.0027}
# a shell of celluloid or ABS: 2/3 m R2 about its centre
SETUP = {
    "format": "recording-set/1",
    "name": "tabletennis-spin-bounce",
    "description": "table-tennis balls with measured spin on a table, followed by cameras",
    "source": "Gossard, Tebbe, Ziegler, Zell, SpinDOE, 2023 (arXiv 2303.03879), "
    "github cogsys-tuebingen/spindoe, data/trajectories",
    "licence": "none stated; not for shipping",
    "target": {"shape": "flat", "material": "table-tennis table", "law": "measured-restitution"},
    "strikers": {"ball": {**BALL, "material": "hollow ball", "inertia_kg_m2": 7.2e-7}},
    "environment": {"fluid": "air"},
}


def _on_the_table(reduced: Reduced, name: str) -> Reduced:
    """Keep bounces at the height of the table: a ball may also be struck, or bounce off it."""
    kept = []
    for trial in reduced.trials:
        label = f"{trial.label}_" if trial.label else ""
        if abs(reduced.values[f"{label}contact_height_m"].value) < NEAR:
            kept.append(trial)
    if not kept:
        raise InputError("no bounce at the height of the table", source=name)
    return replace(reduced, trials=tuple(kept))


def reduced(raw: zipfile.ZipFile, place: Path, line: str) -> tuple[Reduced, Row, dict[str, Any]]:
    """Reduce the trajectory of one line of the index: its number, and the spin before."""
    number, *spin = line.split(",")
    track = place / f"{int(number):03d}.csv"
    points = raw.read(track.name).decode().replace(";", ",")
    track.write_text("time_s,ball_x_m,ball_y_m,ball_z_m\n" + points)
    given = {"shape": "sphere", "tip_radius_m": 0.02, "spin_before_rad_s": ",".join(spin)}
    found = load_kind("mocap").run(track, given, source="recipe")
    return _on_the_table(found, track.stem), Row(striker="ball"), given


def recipe(archive: Path, folder: Path, count: int = 300) -> tuple[int, list[str]]:
    """Write the set; the number of trials made, and a line for each trajectory left out."""
    if not zipfile.is_zipfile(archive):
        raise InputError("no archive", source=str(archive), allowed="trajectories.zip")
    with zipfile.ZipFile(archive) as raw, tempfile.TemporaryDirectory() as place:
        lines = raw.read("index.csv").decode().split()[1 : count + 1]
        items = [(line.split(",")[0], partial(reduced, raw, Path(place), line)) for line in lines]
        return store_each(items, folder, kind="mocap", setup=SETUP)


if __name__ == "__main__":
    run_recipe(recipe, __doc__)
