"""Prove the reduction of scans on rendered ones.

`python tools/benchmarks/validate_reduce_scan.py 200` prints error and coverage of depth, width and
rim, and of the sliding length of scars, over scans with drawn size, rim, tilt, roughness, noise,
spikes and holes.
"""

import sys

import numpy as np
from dentscope.reduce.measured import Measured
from dentscope.reduce.scan.crater import reduce_scan
from dentscope.studies.synthetic.scans import ScanTruth, random_truth, render
from honesty import judge


def _stated_blur(truth: ScanTruth) -> Measured:
    """What a data sheet says of the instrument: the blur, off by up to 20 %."""
    off = np.random.default_rng(truth.seed + 10_000).uniform(0.8, 1.2)
    return Measured(truth.blur * off, 0.12 * truth.blur * off)


def main(count: int) -> None:
    scores: dict[str, list[tuple[float, float]]] = {}
    for seed in range(count):
        truth = random_truth(seed)
        found = reduce_scan(render(truth), blur=_stated_blur(truth))
        rows = [
            ("depth", found.depth, truth.depth),
            ("width", found.width, 2.0 * truth.radius),
            ("length", found.length, 2.0 * truth.radius),
            ("pile-up", found.pile_up, truth.pile_up),
        ]
        scar = random_truth(seed, sliding=4e-4)
        slid = reduce_scan(render(scar), blur=_stated_blur(scar))
        rows += [("depth of scar", slid.depth, scar.depth), ("sliding", slid.sliding, scar.sliding)]
        for name, value, known in rows:
            scores.setdefault(name, []).append((value.value / known - 1.0, value.std / known))
    for name, listed in scores.items():
        judge(f"{name}, relative", *np.array(listed).T)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 200)
