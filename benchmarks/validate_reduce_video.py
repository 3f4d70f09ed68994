"""Prove the video reduction on rendered clips: `python benchmarks/validate_reduce_video.py 200`.

Prints the error of speed and tip position over clips with drawn speeds, lean, tip, blur, shutter,
noise and light, the coverage of the stated uncertainty, and any bias in units of its own error.
"""

import math
import sys

import numpy as np
from dentscope.recordings.reduce.clip import Clip
from dentscope.recordings.reduce.measured import Measured
from dentscope.recordings.reduce.synthetic.clips import random_truth, render
from dentscope.recordings.reduce.video import Optics, reduce_video


def main(count: int, shape: str) -> None:
    errors: dict[str, list[float]] = {name: [] for name in ("approach", "rebound", "restitution")}
    scores: dict[str, list[float]] = {name: [] for name in errors}
    place, mean_place, failed = [], [], 0
    for seed in range(count):
        given = {} if shape == "rod" else {"shape": "sphere", "columns": 72, "middle": 35.2,
                                           "half_width": 12.0, "tip_radius": 12.0}  # fmt: skip
        truth = random_truth(seed, **given)
        clip = Clip(render(truth), math.nan, 0, 0, f"clip {seed}")
        optics = Optics(truth.rate, scale=Measured(truth.scale, 0.0))
        try:
            found = reduce_video(clip, optics, shape=shape)
        except ValueError as error:
            failed += 1
            print(f"clip {seed}: {error}")
            continue
        _, row = truth.tip(found.frame)
        if shape == "sphere":
            row = row - truth.tip_radius
        place.append(float(np.sqrt(np.mean((found.row - row) ** 2))))
        mean_place.append(float(np.mean(found.row - row)))
        bounce = found.bounces[0]
        for name, value, known in (
            ("approach", bounce.approach.times(found.scale), truth.approach),
            ("rebound", bounce.rebound.times(found.scale), truth.rebound),
            ("restitution", bounce.restitution, truth.restitution),
        ):
            errors[name].append(value.value / known - 1.0)
            scores[name].append((value.value - known) / value.std)
    print(f"{shape}: {count} clips, {failed} not reduced")
    print(f"tip position: rms {np.sqrt(np.mean(np.square(place))):.4f} px, worst clip "
          f"{max(place):.4f} px, mean offset {np.mean(mean_place):+.4f} px")  # fmt: skip
    for name in errors:
        e, z = np.array(errors[name]), np.array(scores[name])
        print(
            f"{name}: rms error {100 * np.sqrt(np.mean(e**2)):.3f} %, "
            f"worst {100 * abs(e).max():.3f} %, mean {100 * e.mean():+.4f} %; "
            f"within 2 std {np.mean(abs(z) < 2.0):.1%}, "
            f"z {z.mean():+.2f} ± {z.std():.2f}"
        )


if __name__ == "__main__":
    main(
        int(sys.argv[1]) if len(sys.argv) > 1 else 200, sys.argv[2] if len(sys.argv) > 2 else "rod"
    )
