"""Prove the motion-capture reduction: `python tools/benchmarks/validate_reduce_mocap.py 200 rod`.

Prints the errors of speeds, spin, restitution and friction over recordings with drawn motion,
markers, noise and gaps, and how often the truth lies within the stated uncertainty. Arguments:
number of recordings, `rod` or `ball`, and `body` to give the places of the markers.
"""

import sys

import numpy as np
from dentscope.reduce.mocap.body import Body, centre_of
from dentscope.reduce.mocap.motion import Prior
from dentscope.reduce.mocap.reduction import MocapReduction, MocapScene, reduce_mocap
from dentscope.reduce.mocap.rigid import kabsch, rigid_poses
from dentscope.studies.synthetic.mocap import MocapTruth, random_ball, random_rod, simulate
from honesty import judge

UP = np.array([0.0, 0.0, 1.0])


def reduced(truth: MocapTruth, *, known: bool) -> MocapReduction:
    poses = rigid_poses(simulate(truth))
    # the axis is the rod's; the centre of mass is known to 0.5 mm, or has to be found
    origin, turn = kabsch(np.array(truth.markers), poses.shape)
    axis = turn[:, 2] if truth.shape == "rod" else np.zeros(3)
    random = np.random.default_rng(truth.seed + 10**6)
    centre = centre_of(poses, axis, truth.tip_radius, truth.tip_radius)
    if known:
        centre = Prior(origin + random.normal(0.0, 5e-4, 3), 5e-4)
    body = Body(
        truth.shape, axis, truth.length, truth.tip_radius, truth.inertia_over_mass, centre,
        poses.shape,
    )  # fmt: skip
    return reduce_mocap(poses, body, MocapScene(UP), source=f"recording {truth.seed}")


def main(count: int, shape: str, *, known: bool) -> None:
    errors: dict[str, list[tuple[float, float]]] = {}
    failed = 0
    for seed in range(count):
        truth = random_rod(seed) if shape == "rod" else random_ball(seed)
        try:
            found = reduced(truth, known=known)
        except ValueError as error:
            failed += 1
            print(f"recording {seed}: {error}")
            continue
        if len(found.hits) != 1:
            print(f"recording {seed}: {len(found.hits)} impacts")
        for name, value in truth.values().items():
            measured = found.hits[0].measured[name]
            error = measured.value - value, measured.std
            errors.setdefault(name, []).append(error)
            if abs(value) > 0.0:
                part = error[0] / abs(value), error[1] / abs(value)
                errors.setdefault(f"{name}, relative", []).append(part)
    print(f"{shape}: {count} recordings, {failed} not reduced")
    for name, listed in errors.items():
        judge(name, *np.array(listed).T)


if __name__ == "__main__":
    given = sys.argv[1:]
    main(
        int(given[0]) if given else 200,
        given[1] if len(given) > 1 else "rod",
        known="body" in given[2:],
    )
