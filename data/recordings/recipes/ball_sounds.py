"""Bounces of a rubber ball, timed by a tablet's acoustic stop-watch, as a recording set.

    python data/recordings/recipes/ball_sounds.py FOLDER SET

Raw files: `dentscope recordings fetch ball-bounce-acoustic` (no licence stated, so not shipped). A
workbook holds one run; its name tells the release height in centimetres. Every bounce between two
timed flights becomes a trial, the first one with the speed of the fall. Size and mass of the ball
are not stated, so that the drag of the air stays in.
"""

import re
import sys
from pathlib import Path

from dentscope.core.errors import InputError
from dentscope.recordings import Setup
from dentscope.recordings.reduce.into_set import Row, store
from dentscope.recordings.reduce.kinds import load_kind

SETUP = {
    "format": "recording-set/1",
    "name": "rubber-ball-sounds",
    "description": "a blue rubber ball on a hard floor, bounces timed by sound",
    "source": "github giiulia/LabI-Dynamics-Thermodynamics, Coefficient_of_restitution, 2021",
    "licence": "none stated; not for shipping",
    "target": {"shape": "flat", "material": "hard floor", "law": "measured-restitution"},
    # neither is stated; only ratios of speeds are read from the set
    "strikers": {
        "ball": {
            "shape": "sphere",
            "tip_radius_m": {"value": 0.025, "std": 0.01},
            "mass_kg": {"value": 0.06, "std": 0.03},
            "material": "rubber",
        }
    },
    "environment": {"fluid": "air"},
}


def recipe(folder: Path, target: Path) -> tuple[int, list[str]]:
    """Write the set; the number of trials made, and a line for each run left out."""
    kind, made, left_out = load_kind("table"), 0, []
    for file in sorted(folder.glob("*.xls")):
        run, centimetres = map(int, re.findall(r"\d+", file.stem)[:2])
        given = {"holds": "bounces", "sheet": "All", "release_height_m": centimetres / 100.0,
                 "release_height_m_std": 0.005}  # fmt: skip
        try:
            reduced = kind.run(file, given, source="recipe")
            store(
                reduced, target, Row(striker="ball", trial=f"{centimetres}cm-{run}"), kind="table",
                options=given, setup=Setup.model_validate(SETUP) if made == 0 else None,
            )  # fmt: skip
            made += len(reduced.trials)
        except InputError as error:
            left_out.append(f"{file.name}: {error}")
    return made, left_out


if __name__ == "__main__":
    done, missing = recipe(Path(sys.argv[1]), Path(sys.argv[2]))
    sys.stdout.write(f"{done} trials in {sys.argv[2]}\n" + "".join(f"{m}\n" for m in missing))
