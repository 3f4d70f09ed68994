"""A marble on stacks of paper, tracked from video by its authors, as a recording set.

    python data/recordings/recipes/marble_paper.py FOLDER SET

Raw files: `dentscope recordings fetch marble-on-paper` (no licence stated, so not shipped). The
name of a file tells repeat and number of sheets; its second and third column are the place of the
marble in pixels, downwards, at 200 frames a second by the authors' script. Gravity gives the size
of a pixel. Files that the authors put aside ("-niet") are left out here too.
"""

import sys
from dataclasses import replace
from pathlib import Path

from dentscope.core.errors import InputError
from dentscope.recordings import Setup
from dentscope.recordings.reduce.into_set import Row, store
from dentscope.recordings.reduce.kinds import load_kind

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
    "description": "a marble dropped on stacks of A4 paper; the trial's name tells the sheets",
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


def recipe(folder: Path, target: Path) -> tuple[int, list[str]]:
    """Write the set: the first bounce of each file; a line for each file left out."""
    kind, made, left_out = load_kind("table"), 0, []
    for file in sorted(folder.glob("[0-9]*-M.csv")):
        repeat, sheets, _ = file.stem.split("-")
        try:
            reduced = kind.run(file, OPTIONS, source="recipe")
            first = replace(reduced, trials=(replace(reduced.trials[0], label=""),))
            store(
                first, target, Row(striker="marble", trial=f"{sheets}-sheets-{repeat}"),
                kind="table", options=OPTIONS,
                setup=Setup.model_validate(SETUP) if made == 0 else None,
            )  # fmt: skip
            made += 1
        except InputError as error:
            left_out.append(f"{file.name}: {error}")
    return made, left_out


if __name__ == "__main__":
    done, missing = recipe(Path(sys.argv[1]), Path(sys.argv[2]))
    sys.stdout.write(f"{done} trials in {sys.argv[2]}\n" + "".join(f"{m}\n" for m in missing))
