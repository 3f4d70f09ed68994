"""Reduce made-up pulses of force, and records that are no pulse, and compare with what they are.

    python tools/benchmarks/validate_reduce_pulse.py [COUNT] [FIRST]

COUNT whole pulses (half-sines and elastic spheres, clean, on another level before, with a soft
foot, with a ringing after) and COUNT records that should be refused: noise, clipped ones, holes,
edges, steps, oscillations, trains of taps or of steps of a walk, pulses over an end of the record.
Half of the feet are a layer's between the bodies, whose contact begins with it and which fades
under the flank; half are something else's and end where the bodies touch. Half of the ringings are
a plate's after the blow, half the sensor's own, all through it. Seeds count from FIRST.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np
from dentscope.core.errors import InputError
from dentscope.reduce.kinds import load_kind
from honesty import judge
from scipy.signal import lsim

RATE = 20_000.0
T = np.arange(0.0, 0.2, 1.0 / RATE)


def pulse(rng, at, long, peak):
    s = np.clip((T - at) / long, 0.0, 1.0)
    return peak * np.sin(np.pi * s) ** rng.uniform(1.0, 1.5)


def sensor(force, period):
    """What a sensor on a spring shows, that rings with a period and fades within three."""
    w, damping = 2.0 * np.pi / period, 1.0 / 18.0
    system = ([w * w], [1.0, 2.0 * damping * w, w * w])
    return lsim(system, force, T)[1]


def whole(rng):
    """A record and the truth: peak, time in contact, area."""
    at, long, peak = rng.uniform(0.05, 0.1), 10 ** rng.uniform(-3.0, -1.8), 10 ** rng.uniform(1, 4)
    clean = pulse(rng, at, long, peak)
    area, value = np.trapezoid(clean, T), clean.copy()
    kind = rng.choice(["clean", "level", "foot", "ringing"])
    if kind == "level":
        value += rng.uniform(-0.5, 0.5) * peak * (at - 2.0 * long > T)
    if kind == "foot":
        reach = rng.uniform(0.3, 1.5) * long
        foot = rng.uniform(0.02, 0.08) * peak * np.clip((T - at + reach) / reach, 0.0, 1.0)
        layer = rng.random() < 0.5
        foot *= np.clip(1.0 - 2.0 * (T - at) / long, 0.0, 1.0) if layer else at > T
        value, long = value + foot, long + layer * reach
        area += np.trapezoid(foot, T)
    if kind == "ringing" and rng.random() < 0.5:
        value = sensor(clean, rng.uniform(0.25, 0.5) * long)
    elif kind == "ringing":
        late = np.maximum(T - at - long, 0.0)
        ring = np.exp(-late / (2.0 * long)) * np.sin(2.0 * np.pi * late / (0.4 * long))
        ring *= rng.uniform(0.12, 0.3) * peak
        value, area = value + ring, area + np.trapezoid(ring, T)
    noise = peak * 10 ** rng.uniform(-3.5, -2.0)
    return kind, value + rng.normal(0.0, noise, T.size), (peak, long, area)


def refused(rng):
    """A record that shows no whole impact."""
    peak, long, at = 100.0, rng.uniform(3e-3, 1e-2), rng.uniform(0.05, 0.1)
    noise = rng.normal(0.0, peak * 10 ** rng.uniform(-3.0, -2.0), T.size)
    clean = pulse(rng, at, long, peak)
    kind = rng.choice(["noise", "clipped", "edge", "step", "swing", "train", "end", "hole"])
    time = T
    if kind == "noise":
        clean = 0.0 * clean
    if kind == "clipped":
        clean, noise = np.minimum(clean, rng.uniform(0.4, 0.9) * peak), 1e-3 * noise
        return kind, time, np.minimum(clean + noise, clean.max())
    if kind == "edge":
        clean *= (at + 0.5 * long) > T
    if kind == "step":
        clean = np.where(at + 0.5 * long > T, clean, peak)
    if kind == "swing":
        clean = peak * np.sin(2.0 * np.pi * T / long) * np.exp(-(((T - 0.1) / 0.04) ** 2))
    if kind == "train":
        clean = sum(pulse(rng, a, long, peak * rng.uniform(0.7, 1.0))
                    for a in np.arange(0.02, 0.16, 2.5 * long))  # fmt: skip
    if kind == "end":
        part = at + rng.uniform(0.2, 0.7) * long > T
        return kind, T[part], (clean + noise)[part]
    if kind == "hole":
        lost = np.abs(T - at - 0.5 * long) < rng.uniform(0.15, 0.3) * long
        return kind, T[~lost], (clean + noise)[~lost]
    return kind, time, clean + noise


def reduced(time, value, path):
    lines = (f"{t:.6f},{v:.7g}" for t, v in zip(time, value, strict=True))
    path.write_text("\n".join(["time_s,force_N", *lines]))
    return load_kind("table").run(path, {"holds": "force"}, source="validation")


def main(count, first, path):
    rows, lost = [], []
    for seed in range(first, first + count):
        kind, value, truth = whole(np.random.default_rng(seed))
        try:
            found = reduced(T, value, path).values
        except InputError as error:
            lost.append((f"{kind} {seed}", error.message))
            continue
        names = ("peak_force_N", "contact_time_s", "impulse_N_s")
        rows.append([kind, *((found[n].value / x - 1.0, found[n].std / x)
                             for n, x in zip(names, truth, strict=True))])  # fmt: skip
    print(f"{count} whole pulses, {len(lost)} refused")
    for kind, why in lost[:12]:
        print(f"    {kind}: {why}")
    for kind in ("clean", "level", "foot", "ringing"):
        for place, name in enumerate(("peak", "time", "impulse"), start=1):
            errors = np.array([r[place] for r in rows if r[0] == kind]).reshape(-1, 2)
            judge(f"{kind} {name}, relative", *errors.T)
    given = []
    for seed in range(first, first + count):
        kind, time, value = refused(np.random.default_rng(10_000 + seed))
        try:
            reduced(time, value, path)
            given.append((str(kind), seed))
        except InputError:
            pass
    print(f"{count} records that are no whole impact, {len(given)} give a number: {given[:12]}")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as made:
        given = [int(n) for n in sys.argv[1:3]]
        main(*(given + [300, 0][len(given) :]), Path(made) / "record.csv")
