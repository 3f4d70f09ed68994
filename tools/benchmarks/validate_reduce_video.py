"""Prove the reduction of clips on rendered ones.

`python tools/benchmarks/validate_reduce_video.py 100` does so.

Clips of a rod around its contact, or of a ball over whole flights in air, with drawn speeds, lean,
tip, blur, shutter, noise and light, and with every fault of a camera at once: a scale that drifts,
a rolling shutter, reflections in the flat, blur that is not the same everywhere, dropped frames and
frames with something in the way. Arguments: number of clips, `rod` or `sphere`, the first seed,
`clean` for none of the faults. Printed: errors of speeds and restitution, how honest they are, and
the clips with the largest errors in what is stated.
"""

import math
import sys

import numpy as np
from dentscope.core.drag import air
from dentscope.reduce.bounces.fall import Ball
from dentscope.reduce.images.clip import Clip, repeated_frames
from dentscope.reduce.measured import Measured
from dentscope.reduce.video.reduction import Optics, reduce_video
from dentscope.studies.synthetic.clips import random_ball, random_truth, render, with_faults
from dentscope.studies.synthetic.tracks import fly
from honesty import judge


def one(seed: int, shape: str, faults: bool) -> list[list[float]]:
    """Return approach, rebound and restitution less their truth, their errors, and e, by bounce."""
    truth = random_truth(seed) if shape == "rod" else random_ball(seed)
    truth = with_faults(truth) if faults else truth
    frames = render(truth)
    clip = Clip(frames, math.nan, 0, repeated_frames(frames), f"clip {seed}")
    if truth.ball is None:
        optics = Optics(truth.rate, scale=Measured(truth.scale, 0.0), line_time=truth.line_time)
        middle = truth.touch / truth.rate + 0.5 * truth.contact_time
        contacts = np.array([middle + truth.line_time * truth.surface])
        speeds = np.array([truth.approach])
    else:
        ball = Ball(9.81, truth.ball.mass, truth.ball.diameter, air())
        optics = Optics(truth.rate, ball=ball, line_time=truth.line_time)
        _, contacts, speeds = fly(truth.ball)
    e = truth.restitution
    found = reduce_video(clip, optics, shape=shape)
    rows = []
    for bounce in found.bounces:
        k = int(np.argmin(np.abs(contacts - bounce.time.value)))
        if abs(contacts[k] - bounce.time.value) > 2.5 / truth.rate + truth.contact_time:
            print(f"clip {seed}: a bounce at {bounce.time} s that is none")
            continue
        approach, rebound = (v.times(found.scale) for v in (bounce.approach, bounce.rebound))
        rows.append([
            approach.value / speeds[k] - 1.0, approach.std / speeds[k],
            rebound.value / (e * speeds[k]) - 1.0, rebound.std / (e * speeds[k]),
            bounce.restitution.value - e, bounce.restitution.std, e,
        ])  # fmt: skip
    return rows


def report(rows: np.ndarray) -> None:
    """Print bias, spread and honesty of each number, and the bounces furthest off."""
    for k, name in enumerate(("approach, relative", "rebound, relative", "restitution")):
        judge(name, rows[:, 2 * k], rows[:, 2 * k + 1])
    for row in rows[np.argsort(-np.abs(rows[:, 4] / rows[:, 5]))[:8]]:
        print(f"  seed {row[6]:.0f}: e {row[7]:.3f}, off {row[4]:+.4f} ± {row[5]:.4f}; "
              f"approach off {row[0]:+.4f} ± {row[1]:.4f}")  # fmt: skip


def main(count: int, shape: str, first: int, faults: bool) -> None:
    rows, refused = [], 0
    for seed in range(first, first + count):
        try:
            rows += [[*row, seed, e] for *row, e in one(seed, shape, faults)]
        except ValueError as error:
            refused += 1
            print(f"clip {seed}: {error}")
    print(f"{shape}: {count} clips, {refused} refused, {len(rows)} bounces")
    report(np.array(rows))


if __name__ == "__main__":
    given = [word for word in sys.argv[1:] if word != "clean"]
    count, shape, first, *_ = [*given, *["100", "rod", "0"][len(given) :]]
    main(int(count), shape, int(first), "clean" not in sys.argv)
