"""Speed and soundness of the fitted law: a ratio within one run, and a million random draws.

    .venv/bin/python tools/benchmarks/bench_fitted_law.py

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
             ("hertz", "jackson-green", "ghaednia", "fitted")}  # fmt: skip
    base = times["jackson-green"]
    print(f"{COUNT:,} forces of one pair")
    for name, value in times.items():
        print(f"  {name:14s} {value:6.3f} s  {value / base:5.2f} of Jackson-Green")


def drawn(around: float) -> tuple[Bodies, np.ndarray]:
    """Pairs and depths over the domain, each of its bounds taken `around` times as far."""
    u = np.random.default_rng(11).random((7, COUNT))
    E_s, E_f = 50e9 * 6.0 ** u[0], 50e9 * 6.0 ** u[1]
    nu_s, nu_f = 0.1 + 0.35 * u[2], 0.1 + 0.35 * u[3]
    k_s, k_f = (1 - nu_s**2) / E_s, (1 - nu_f**2) / E_f
    weak = 1.0 / (k_s + k_f) / (25.0 / around * (132.0 * around**2) ** u[4])
    ratio = 0.1 / around * (100.0 * around**2) ** u[5]
    Sy_s = np.where(ratio < 1.0, weak, weak * ratio)
    Sy_f = np.where(ratio < 1.0, weak / ratio, weak)
    deepest = 0.18 if around == 1.0 else 1.0
    D = deepest * 10.0 ** (-8.0 * u[6])
    return Bodies(k_s, k_f, nu_s, nu_f, 1 / Sy_s, 1 / Sy_f), D


def random_draws(name: str, around: float) -> None:
    """What no law of ours may do, at a million random pairs and depths."""
    bodies, D = drawn(around)
    numbers = LAWS[name].numbers(bodies)
    F, a, share, left, phi, exponent = contact(D, numbers)
    # slopes by a complex step: exact, where a difference would only show round-off
    slope = contact(D + 1e-30j, numbers)
    bad = {
        "not finite": ~np.isfinite(F + a + share + left + phi + exponent),
        "F not above zero": ~(F > 0.0),
        "F falls": ~(np.imag(slope.F) > 0.0),
        "a falls": ~(np.imag(slope.a) > 0.0),
        "share outside 0 to 1": ~((share >= 0.0) & (share <= 1.0)),
        "permanent part outside 0 to 1": ~((left > -1e-12) & (left < 1.0)),
        "gives back more than it took": gained(numbers, D, F, left, exponent) > 1e-9,
    }
    print(f"{name}, {COUNT:,} pairs and depths, bounds of the domain {around:g} times as far")
    for what, mask in bad.items():
        print(f"  {what:30s} {int(mask.sum())}")
    early = (D < 1e-5) & (numbers.W * D < 0.1)
    off = np.abs(F[early] / (4.0 / 3.0 * D[early] ** 1.5) - 1.0)
    print(f"  largest difference from Hertz below 0.1 delta_c and Delta/R = 1e-5: {off.max():.2%}"
          f" ({int(early.sum()):,} draws)")  # fmt: skip
    # curvature in logarithms, in the second half of the domain's decades: a kink would show here
    h = 1e-3
    around_D = [np.log(contact(D * np.exp(k * h), numbers).F) for k in (-1, 0, 1)]
    bend = np.abs(around_D[0] - 2.0 * around_D[1] + around_D[2]) / h**2
    print(f"  largest second derivative of ln F over ln Delta: {bend.max():.1f}")


def gained(numbers, D, F, left, exponent) -> np.ndarray:
    """Energy given back over that spent, less one, of every hundredth draw; else -1."""
    out = np.full(D.size, -1.0)
    some = np.arange(0, D.size, 100)
    few = type(numbers)(*(np.asarray(x)[some] for x in numbers))
    nodes, weights = np.polynomial.legendre.leggauss(4)
    panels, low = 60, np.log(1e-9)
    work = np.zeros(some.size)
    for k in range(panels):
        for x, w in zip(nodes, weights, strict=True):
            at = D[some] * np.exp(low - low * (k + 0.5 * (x + 1.0)) / panels)
            work += -low / (2 * panels) * w * at * contact(at, few).F
    back = F[some] * D[some] * (1.0 - np.maximum(left[some], 0.0)) / (exponent[some] + 1.0)
    out[some] = back / work - 1.0
    return out


if __name__ == "__main__":
    warnings.simplefilter("ignore", DomainWarning)
    speed()
    for law in ("compact", "fitted"):
        for around in (1.0, 10.0):
            random_draws(law, around)
