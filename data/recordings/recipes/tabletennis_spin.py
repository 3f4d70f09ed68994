"""Table-tennis balls with measured spin as a recording set.

    python data/recordings/recipes/tabletennis_spin.py trajectories.zip SET [COUNT]

Raw file: `dentscope recordings fetch tabletennis-spin` (no licence stated, so not shipped), or
cogsys-tuebingen/spindoe, data/trajectories. Each trajectory (time, x, y, z of the ball in the
table's frame) becomes one trial: `dentscope reduce mocap` of one point, with the spin that the
authors read from dots on the ball as spin before the bounce. The spin after it was not measured.
"""

import sys
import tempfile
import zipfile
from dataclasses import replace
from pathlib import Path

from dentscope.core.errors import InputError
from dentscope.recordings import Setup
from dentscope.recordings.reduce.into_set import Row, store
from dentscope.recordings.reduce.kinds import load_kind
from dentscope.recordings.reduce.reduced import Reduced

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


def recipe(archive: Path, folder: Path, count: int) -> tuple[int, list[str]]:
    """Write the set; the number of trials made, and a line for each trajectory left out."""
    kind, left_out, made = load_kind("mocap"), [], 0
    with zipfile.ZipFile(archive) as raw, tempfile.TemporaryDirectory() as place:
        rows = raw.read("index.csv").decode().split()[1:]
        for line in rows[:count]:
            number, *spin = line.split(",")
            name = f"{int(number):03d}"
            track = Path(place) / f"{name}.csv"
            points = raw.read(f"{name}.csv").decode().replace(";", ",")
            track.write_text("time_s,ball_x_m,ball_y_m,ball_z_m\n" + points)
            given = {"shape": "sphere", "tip_radius_m": 0.02, "spin_before_rad_s": ",".join(spin)}
            try:
                reduced = _on_the_table(kind.run(track, given, source="recipe"), name)
                setup = Setup.model_validate(SETUP) if made == 0 else None
                store(reduced, folder, Row(striker="ball"), kind="mocap", options=given,
                      setup=setup)  # fmt: skip
                made += 1
            except InputError as error:
                left_out.append(f"{name}: {error}")
    return made, left_out


if __name__ == "__main__":
    done, missing = recipe(
        Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3 else 300
    )
    sys.stdout.write(f"{done} trials in {sys.argv[2]}\n" + "".join(f"{m}\n" for m in missing))
