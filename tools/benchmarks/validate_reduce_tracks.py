"""Reduce rendered tracks of bouncing balls and compare with what they were made of.

    python tools/benchmarks/validate_reduce_tracks.py [COUNT] [FIRST] [soft]

Each track has drag, a scale that drifts with height and time, a picture that is not level, a
rolling shutter in some, dropped frames, a share of positions that are something else's, and a dip
next to the flat (studies/synthetic/tracks.py). Contacts last as those of a table-tennis ball, a
marble and a rubber ball do; with `soft` from 0.1 to 20 ms, any order as often.
"""

import sys
from collections import Counter

import numpy as np
from dentscope.core.drag import air
from dentscope.reduce.bounces.contacts import find_bounces
from dentscope.reduce.bounces.fall import Ball
from dentscope.reduce.bounces.track import Track
from dentscope.studies.synthetic.tracks import random_track, seen
from honesty import judge


def main(count, first, soft):
    rows, outcome = [], Counter()
    for seed in range(first, first + count):
        given = {"contact_time": 10 ** np.random.default_rng(seed).uniform(-4.0, -1.7)}
        truth = random_track(seed, **given if soft else {})
        track = seen(truth)
        time = track.time + truth.line_time * (track.height.max() - track.height)
        ball = Ball(9.81, truth.mass, truth.diameter, air())
        found = find_bounces(Track(time, track.height), ball, metres=None)
        outcome["tracks without a bounce"] += found is None
        for bounce in found.bounces if found else ():
            k = int(np.argmin(np.abs(track.contacts - bounce.time.value)))
            # a stamp that is a frame early stays so
            if abs(track.contacts[k] - bounce.time.value) > 2.5 / truth.rate:
                outcome["false bounces"] += 1
                continue
            speed = bounce.approach.times(found.scale.metres)
            rows.append((
                seed, bounce.restitution.value - truth.restitution, bounce.restitution.std,
                speed.value / track.speeds[k] - 1.0, speed.std / track.speeds[k], track.speeds[k],
                truth.restitution,
            ))  # fmt: skip
        fast = track.speeds > 0.5
        outcome["bounces faster than 0.5 m/s"] += int(fast.sum())
    a = np.array(rows)
    outcome["found"] = len(a)
    print(f"{count} tracks: " + ", ".join(f"{v} {k}" for k, v in outcome.items()))
    judge("restitution", a[:, 1], a[:, 2])
    good = a[:, 2] < 0.02
    judge("restitution, stated better than 0.02", a[good, 1], a[good, 2])
    judge("approach speed, relative", a[:, 3], a[:, 4])
    worst = np.argsort(-np.abs(a[:, 1] / a[:, 2]))[:8]
    for seed, de, se, dv, sv, v, e in a[worst]:
        print(
            f"  seed {seed:.0f}: e {e:.3f}, off {de:+.4f} ± {se:.4f}; "
            f"v {v:.2f} m/s, off {dv:+.4f} ± {sv:.4f}"
        )


if __name__ == "__main__":
    given = [int(n) for n in sys.argv[1:3]]
    main(*(given + [200, 0][len(given) :]), soft="soft" in sys.argv)
