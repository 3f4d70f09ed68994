"""Speed and soundness of the fitted law: a ratio within one run, and a million random draws.

    .venv/bin/python benchmarks/bench_fitted_law.py

Times are processor seconds on one core, the best of several runs; the ratio to Jackson and Green's
formula in the same run is what can be compared between machines.
"""

from __future__ import annotations

import time
import warnings

import numpy as np
from dentscope.core import Material, Pair
from dentscope.models import LAWS
from dentscope.models.base import DomainWarning
from dentscope.models.closed_form import Bodies, contact

COUNT = 1_000_000
PAIR = Pair(Material(E=71.7e9, nu=0.33, Sy=300e6), Material(E=200e9, nu=0.3, Sy=360e6), 1e-3)


def seconds(call, runs: int = 7) -> float:
    best = np.inf
    for _ in range(runs):
        start = time.process_time()
        call()
        best = min(best, time.process_time() - start)
    return best


def speed() -> None:
    d = np.geomspace(1e-8, 1e-4, COUNT)
    times = {name: seconds(lambda law=LAWS[name]: law.loading(PAIR, d)) for name in
             ("hertz", "jackson-green", "fitted")}  # fmt: skip
    base = times["jackson-green"]
    print(f"{COUNT:,} forces of one pair")
    for name, value in times.items():
        print(f"  {name:14s} {value:6.3f} s  {value / base:5.2f} of Jackson-Green")


def random_draws() -> None:
    """F, its rise, a and the permanent parts at a million random pairs and depths."""
    u = np.random.default_rng(11).random((7, COUNT))
    E_s, E_f = 50e9 + 250e9 * u[0], 50e9 + 250e9 * u[1]
    nu_s, nu_f = 0.1 + 0.35 * u[2], 0.1 + 0.35 * u[3]
    weak = 50e6 * 22.0 ** u[4]
    ratio = 0.05 * 400.0 ** u[5]
    Sy_s, Sy_f = (
        np.where(ratio < 1.0, weak, weak * ratio),
        np.where(ratio < 1.0, weak / ratio, weak),
    )
    D = 10.0 ** (-8.0 + 7.0 * u[6])
    law = LAWS["fitted"]
    bodies = Bodies((1 - nu_s**2) / E_s, (1 - nu_f**2) / E_f, nu_s, nu_f, 1 / Sy_s, 1 / Sy_f)
    numbers = law.numbers(bodies)
    F, a, share, left, phi, exponent = contact(D, numbers)
    beyond = contact(D * (1.0 + 1e-6), numbers)
    # the slope by a complex step: exact, where a difference would only show round-off
    slope = np.imag(contact(D + 1e-30j, numbers).F) / 1e-30
    bad = {
        "not finite": ~np.isfinite(F + a + share + left + phi + exponent + slope),
        "F not above zero": ~(F > 0.0),
        "F falls": ~(slope > 0.0),
        "a falls": ~(beyond.a > a),
        "share outside 0 to 1": ~((share >= 0.0) & (share <= 1.0)),
        "permanent part outside 0 to 1": ~((left > -1e-12) & (left < 1.0)),
        "exponent outside 1 to 2": ~((exponent > 1.0) & (exponent < 2.0)),
    }
    print(f"{COUNT:,} random pairs and depths: E 50-300 GPa, Sy_min 50-1100 MPa, Sy* 0.05-20,")
    print("nu 0.1-0.45, Delta/R 1e-8 to 0.1")
    for what, mask in bad.items():
        print(f"  {what:30s} {int(mask.sum())}")
    low = D < 1e-5
    onset = (
        (np.pi / 2 * 1.295) ** 2
        * np.exp(2 * 0.736 * np.minimum(nu_s, nu_f))
        * (weak * (bodies.k_s + bodies.k_f)) ** 2
    )
    low &= D < 0.1 * onset
    off = np.abs(F[low] / (4.0 / 3.0 * D[low] ** 1.5) - 1.0)
    print(f"  largest difference from Hertz below 0.1 delta_c and Delta/R = 1e-5: {off.max():.2%}"
          f" ({int(low.sum()):,} draws)")  # fmt: skip


if __name__ == "__main__":
    warnings.simplefilter("ignore", DomainWarning)
    speed()
    random_draws()
