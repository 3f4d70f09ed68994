"""A marble on stacks of paper, tracked from video by its authors, as a recording set.

    python data/recordings/recipes/marble_paper.py FOLDER SET

Raw files: `dentscope recordings fetch marble-on-paper` (no licence stated, so not shipped). The
name of a file tells repeat and number of sheets; its second and third column are the place of the
marble in pixels, downwards, at 200 frames a second by the authors' script. Gravity gives the size
of a pixel. Files that the authors put aside ("-niet") are left out here too.
"""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from dentscope.reduce.kinds import load_kind
from dentscope.reduce.output.into_set import store_each
from dentscope.reduce.output.recipe import run_recipe
from dentscope.reduce.output.row import Row
from dentscope.reduce.reduced import Reduced

OPTIONS = {
    "holds": "height",
    "value": "3",
    "value_unit": "px",
    "upwards": "down",
    "rate_hz": 200.0,
}
SETUP = {
    "format": "recording-set/1",
    "name": "marble-on-paper",
    "description": "a marble dropped on stacks of A4 paper of x_sheets sheets",
    "source": "github XS06, 2025-Projects, team 1: Bouncing on Paper",
    "licence": "none stated; not for shipping",
    "target": {"shape": "flat", "material": "stack of paper", "law": "measured-restitution"},
    # glass presumed, 16 mm; neither is stated, and only ratios of speeds are read from the set
    "strikers": {
        "marble": {
            "shape": "sphere",
            "tip_radius_m": {"value": 0.008, "std": 0.001},
            "mass_kg": {"value": 0.0054, "std": 0.002},
            "material": "glass",
        }
    },
}


def reduced(file: Path) -> tuple[Reduced, Row, dict[str, Any]]:
    """Reduce the first bounce of one file."""
    repeat, sheets, _ = file.stem.split("-")
    found = load_kind("table").run(file, OPTIONS, source="recipe")
    first = replace(found, trials=(replace(found.trials[0], label=""),))
    row = Row(striker="marble", trial=f"{sheets}-sheets-{repeat}", x=f"sheets={sheets}")
    return first, row, OPTIONS


def recipe(folder: Path, target: Path) -> tuple[int, list[str]]:
    """Write the set; the number of trials made, and a line for each file left out."""
    items = [(f.name, partial(reduced, f)) for f in sorted(folder.rglob("[0-9]*-M.csv"))]
    return store_each(items, target, kind="table", setup=SETUP)


if __name__ == "__main__":
    run_recipe(recipe, __doc__)
