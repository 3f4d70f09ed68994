"""A phone video of a bouncing table-tennis ball as a recording set.

    python data/recordings/recipes/pingpong_video.py pingpongvid2.mov SET

Raw file: `dentscope recordings fetch pingpong-video` (no licence stated, so not shipped). The
container says 60 frames a second, but every other frame repeats the one before: they are found and
left out. The ball is out of the ruler's plane, so that the size of a pixel comes from gravity.
"""

from pathlib import Path

from dentscope.recordings import SetFile
from dentscope.reduce.kinds import load_kind
from dentscope.reduce.output.into_set import store
from dentscope.reduce.output.recipe import run_recipe
from dentscope.reduce.output.row import Row

OPTIONS = {
    "frame_rate_hz": 60.0,
    "shape": "sphere",
    "background": "median",
    "channel": "green",
    "last_frame": 95,
}
# a shell of celluloid or ABS: 2/3 m R2 about its centre
SETUP = {
    "format": "recording-set/1",
    "name": "pingpong-video",
    "description": "one drop of a table-tennis ball on wood, followed by a phone: four bounces",
    "source": "github zakilyawatsonjarrett/PTV-restitution-coefficient-home-experiment",
    "licence": "none stated; not for shipping",
    "target": {"shape": "flat", "material": "wood", "law": "measured-restitution"},
    "strikers": {
        "ball": {
            "shape": "sphere",
            "tip_radius_m": 0.02,
            "mass_kg": 0.0027,
            "inertia_kg_m2": 7.2e-7,
            "material": "hollow ball",
        }
    },
    "environment": {"fluid": "air"},
}


def recipe(video: Path, folder: Path) -> tuple[int, list[str]]:
    """Write the set; the number of trials made, and nothing left out."""
    reduced = load_kind("video").run(video, OPTIONS, source="recipe")
    setup = SetFile.model_validate(SETUP)
    row = Row(striker="ball")
    done = store(reduced, folder, row, kind="video", options=OPTIONS, setup=setup)
    return len(done.trials), []


if __name__ == "__main__":
    run_recipe(recipe, __doc__)
