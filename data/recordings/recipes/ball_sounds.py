"""Bounces of a rubber ball, timed by a tablet's acoustic stop-watch, as a recording set.

    python data/recordings/recipes/ball_sounds.py FOLDER SET

Raw files: `dentscope recordings fetch ball-bounce-acoustic` (no licence stated, so not shipped). A
workbook holds one run; its name tells the release height in centimetres. Every bounce between two
timed flights becomes a trial, the first one with the speed of the fall. Size and mass of the ball
are not stated, so that the drag of the air stays in.
"""

import re
from functools import partial
from pathlib import Path
from typing import Any

from dentscope.reduce.kinds import load_kind
from dentscope.reduce.output.into_set import store_each
from dentscope.reduce.output.recipe import run_recipe
from dentscope.reduce.output.row import Row
from dentscope.reduce.reduced import Reduced

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


def reduced(file: Path) -> tuple[Reduced, Row, dict[str, Any]]:
    """Reduce one run; its number and height stand in the name of the file."""
    run, centimetres = map(int, re.findall(r"\d+", file.stem)[:2])
    given = {"holds": "bounces", "sheet": "All", "release_height_m": centimetres / 100.0,
             "release_height_m_std": 0.005}  # fmt: skip
    row = Row(striker="ball", trial=f"{centimetres}cm-{run}")
    return load_kind("table").run(file, given, source="recipe"), row, given


def recipe(folder: Path, target: Path) -> tuple[int, list[str]]:
    """Write the set; the number of trials made, and a line for each run left out."""
    items = [(file.name, partial(reduced, file)) for file in sorted(folder.rglob("*blu*.xls"))]
    return store_each(items, target, kind="table", setup=SETUP)


if __name__ == "__main__":
    run_recipe(recipe, __doc__)
