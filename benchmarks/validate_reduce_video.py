"""Prove the video reduction on rendered clips: `python benchmarks/validate_reduce_video.py 200`.

Prints the error of speed and tip position over clips with drawn speeds, lean, tip, blur, shutter,
noise and light, the coverage of the stated uncertainty, and any bias in units of its own error.
Arguments: number of clips, `rod` or `sphere`, and a CSV file for the result of each clip.
"""

import csv
import math
import sys
from pathlib import Path

import numpy as np
from dentscope.recordings.reduce.images.clip import Clip
from dentscope.recordings.reduce.measured import Measured
from dentscope.recordings.reduce.video.reduction import Optics, reduce_video
from dentscope.studies.synthetic.clips import random_truth, render

SPHERE = {
    "shape": "sphere", "columns": 72, "middle": 35.2, "half_width": 12.0, "tip_radius": 12.0,
}  # fmt: skip
SPEEDS = ("approach", "rebound", "restitution")


def one(seed: int, shape: str) -> dict[str, float]:
    truth = random_truth(seed, **({} if shape == "rod" else SPHERE))
    clip = Clip(render(truth), math.nan, 0, np.empty(0, np.int64), f"clip {seed}")
    optics = Optics(truth.rate, scale=Measured(truth.scale, 0.0))
    found = reduce_video(clip, optics, shape=shape)
    _, row = truth.tip(found.frame)
    if shape == "sphere":
        row = row - truth.tip_radius
    bounce = found.bounces[0]
    result = {
        "seed": seed,
        "place_rms": float(np.sqrt(np.mean((found.row - row) ** 2))),
        "place_worst": float(np.max(np.abs(found.row - row))),
        "place_mean": float(np.mean(found.row - row)),
    }
    for name, value, known in (
        ("approach", bounce.approach.times(found.scale), truth.approach),
        ("rebound", bounce.rebound.times(found.scale), truth.rebound),
        ("restitution", bounce.restitution, truth.restitution),
    ):
        result[f"{name}_error"] = value.value / known - 1.0
        result[f"{name}_std"] = value.std / known
    return result


def report(rows: list[dict[str, float]], count: int, shape: str) -> None:
    def column(name: str) -> np.ndarray:
        return np.array([row[name] for row in rows])

    place = column("place_rms")
    print(f"{shape}: {count} clips, {count - len(rows)} not reduced")
    print(f"tip position: rms {np.sqrt(np.mean(place**2)):.4f} px, worst clip "
          f"{place.max():.4f} px, worst frame {column('place_worst').max():.4f} px, "
          f"mean offset {column('place_mean').mean():+.4f} px")  # fmt: skip
    for name in SPEEDS:
        e = column(f"{name}_error")
        z = e / column(f"{name}_std")
        print(
            f"{name}: rms error {100 * np.sqrt(np.mean(e**2)):.3f} %, "
            f"worst {100 * abs(e).max():.3f} %, "
            f"mean {100 * e.mean():+.4f} ± {100 * e.std() / np.sqrt(e.size):.4f} %; "
            f"within 2 std {np.mean(abs(z) < 2.0):.1%}, z {z.mean():+.2f} ± {z.std():.2f}"
        )


def main(count: int, shape: str, save: Path | None) -> None:
    rows = []
    for seed in range(count):
        try:
            rows.append(one(seed, shape))
        except ValueError as error:
            print(f"clip {seed}: {error}")
            continue
        if save is not None:
            with save.open("w", newline="", encoding="utf-8") as file:
                writer = csv.DictWriter(file, list(rows[0]))
                writer.writeheader()
                writer.writerows(rows)
    report(rows, count, shape)


if __name__ == "__main__":
    given = sys.argv[1:]
    main(
        int(given[0]) if given else 200,
        given[1] if len(given) > 1 else "rod",
        Path(given[2]) if len(given) > 2 else None,
    )
