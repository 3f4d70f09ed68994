"""Cases drawn over all materials: for a first fit, for the whole space, for judging a fit."""

from __future__ import annotations

from functools import cache

import numpy as np

from ... import fem
from ...core.arrays import Array
from ...core.material import Pair
from ..case import Case, standard_case
from .pairs import deep_case, digits, pair_of, sobol, widest_pair


@cache
def survey() -> tuple[Case, ...]:
    """64 scrambled Sobol points over the ranges of `space`, at twice its element size."""
    return tuple(
        deep_case(f"survey-{k:02}", _drawn_pair(u), accuracy=fem.Accuracy.quick())
        for k, u in enumerate(sobol(6, seed=64, power=6))
    )


@cache
def space() -> tuple[Case, ...]:
    """256 scrambled Sobol points; in every fourth the two moduli are equal."""
    return tuple(
        deep_case(f"space-{k:03}", _drawn_pair(u, equal_moduli=k % 4 == 0))
        for k, u in enumerate(sobol(6, seed=20141, power=8))
    )


@cache
def validation() -> tuple[Case, ...]:
    """48 pairs kept out of every fit: 24 anywhere, 16 at the steep part, 8 of soft, strong bodies.

    The last have E'/Sy_min below 60, where first yield lies deepest.
    """
    draw = np.random.default_rng(77003).random((48, 6))
    return tuple(deep_case(f"validation-{k:02}", pair) for k, pair in enumerate(_for_judging(draw)))


@cache
def near_equal() -> tuple[Case, ...]:
    """128 scrambled Sobol points at Sy* 0.75 to 1.35, where the share jumps; both nu free."""
    points = sobol(6, seed=20142, power=7)
    return tuple(deep_case(f"near-equal-{k:03}", _near_pair(u)) for k, u in enumerate(points))


@cache
def validation_2() -> tuple[Case, ...]:
    """48 more pairs kept out of every fit: 24 as in `near_equal`, 16 anywhere, 8 of soft, strong.

    Both kinds from the first to the last, so that a part of them is of use.
    """
    near, other = np.random.default_rng(77004).random((2, 24, 6))
    pairs = [
        pair
        for u, v, k in zip(near, other, range(24), strict=True)
        for pair in (_near_pair(u), _soft_pair(v) if k % 3 == 2 else _drawn_pair(v))
    ]
    return tuple(deep_case(f"validation-2-{k:02}", pair) for k, pair in enumerate(pairs))


def _near_pair(u: Array) -> Pair:
    """Pair from six numbers in [0, 1) as `_drawn_pair`, but by Sy* 0.75-1.35, E'/Sy 150-3300."""
    E_s, E_f = (digits(50.0 + 250.0 * x) for x in u[:2])
    ratio = digits(0.75 * 1.8 ** u[2])
    nu_s, nu_f = (round(float(0.2 + 0.25 * x), 3) for x in u[4:])
    stiff = pair_of(E_s=E_s, E_f=E_f, Sy_min=1.0, ratio=ratio, nu_s=nu_s, nu_f=nu_f).E_reduced
    Sy = digits(stiff / 1e6 / (150.0 * 22.0 ** u[3]))
    return pair_of(E_s=E_s, E_f=E_f, Sy_min=Sy, ratio=ratio, nu_s=nu_s, nu_f=nu_f)


def _soft_pair(u: Array) -> Pair:
    return _drawn_pair(u, moduli=(50.0, 95.0), strengths=(950.0, 1100.0))


def _for_judging(draw: Array) -> list[Pair]:
    """Half of the pairs anywhere, a third at the steep part, the others of soft, strong bodies."""
    half, most = len(draw) // 2, 5 * len(draw) // 6
    pairs = [_drawn_pair(u) for u in draw[:half]]
    pairs += [_drawn_pair(u, ratios=(0.85, 1.7)) for u in draw[half:most]]
    pairs += [_soft_pair(u) for u in draw[most:]]
    return pairs


def challenge() -> tuple[Case, ...]:
    """24 pairs drawn from the checksum of the coefficients in use, kept out of every fit."""
    from ...models.coefficients import drawn_from

    return challenge_cases(drawn_from())


def challenge_cases(digest: str) -> tuple[Case, ...]:
    """24 pairs drawn from a checksum: 12 anywhere, 8 at the steep part, 4 of soft, strong bodies.

    Its first twelve hexadecimal digits are the seed, and stand in the cases' names.
    """
    draw = np.random.default_rng(int(digest[:12], 16)).random((24, 6))
    name = f"challenge-{digest[:12]}"
    return tuple(deep_case(f"{name}-{k:02}", pair) for k, pair in enumerate(_for_judging(draw)))


def _drawn_pair(
    u: Array,
    *,
    moduli: tuple[float, float] = (50.0, 300.0),
    strengths: tuple[float, float] = (50.0, 1100.0),
    ratios: tuple[float, float] = (0.1, 10.0),
    equal_moduli: bool = False,
) -> Pair:
    """Pair from six numbers in [0, 1): moduli [GPa] linear, strength [MPa] and Sy* logarithmic."""
    E_s, E_f = (digits(moduli[0] + (moduli[1] - moduli[0]) * x) for x in u[:2])
    Sy, ratio = (
        digits(a * (b / a) ** x) for (a, b), x in zip((strengths, ratios), u[2:4], strict=True)
    )
    nu_s, nu_f = (round(float(0.2 + 0.25 * x), 3) for x in u[4:])
    return pair_of(
        E_s=E_s, E_f=E_s if equal_moduli else E_f, Sy_min=Sy, ratio=ratio, nu_s=nu_s, nu_f=nu_f
    )


def robust_case(name: str, pair: Pair) -> Case:
    """Case that shows whether the solver bears a pair: 24 depths at medium resolution."""
    return standard_case(name, pair, deepest=0.1, n_depths=24, accuracy=fem.Accuracy.quick())


@cache
def robustness() -> tuple[Case, ...]:
    """300 scrambled Sobol points over all that the solver is meant for, at medium resolution."""
    points = sobol(5, seed=300, power=9)[:300]
    return tuple(robust_case(f"robustness-{k:03}", widest_pair(u)) for k, u in enumerate(points))
