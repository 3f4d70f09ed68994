"""Ye and Komvopoulos 2003: indentation in four phases of Q = E' delta/(S r') (4.23-4.27).

Logarithms are natural, and the square in 4.26 is that of ln Q: only so do the phases meet. The
paper has no unloading; the thesis takes Jackson's residual depth for it (4.2.4), and so do we.
"""

from __future__ import annotations

import math

from ..base import Domain, Kernels, PublishedLaw, Standing
from ..kernel import N_COMMON, ONSET, Common, S, kernel
from .kogut_komvopoulos import ELASTIC, SMALLEST, truncated, truncated_hertz
from .residual import jackson, recover, to_weaker

_SMALL, _MEDIUM = 21.0, 400.0  # Q at the end of small and of medium deformation
_FULL = 2.9  # mean pressure over S from there on
_Q = N_COMMON


def _numbers(common: Common) -> tuple[float]:
    return (float(common.E / common.S),)


@kernel
def _area_ratio(par, Q):
    """Truncated over real area (4.26, the square being that of ln Q)."""
    if Q <= ELASTIC:
        return 2.0
    if Q > _MEDIUM:
        return SMALLEST
    log_Q = math.log(Q)
    return (0.05 * log_Q - 0.57) * log_Q + 2.41


@kernel
def _loading(par, depth):
    square, strain = truncated(par, depth)
    Q = par[_Q] * strain
    if Q <= ELASTIC:
        return truncated_hertz(par, square, depth)
    pressure = 0.70 * math.log(Q) + 0.66 if Q <= _SMALL else _FULL
    return math.pi * square / _area_ratio(par, Q) * pressure * par[S]


@kernel
def _radius(par, depth, peak):
    square, strain = truncated(par, depth)
    return math.sqrt(square / _area_ratio(par, par[_Q] * strain))


@kernel
def _residual(par, peak):
    return to_weaker(par, jackson(peak / par[ONSET]) * peak)


@kernel
def _unloading(par, depth, peak):
    return recover(_loading, _residual, par, depth, peak)


YE_KOMVOPOULOS = PublishedLaw(
    name="ye-komvopoulos",
    title="Ye and Komvopoulos 2003, residual depth of Jackson et al.",
    source="J. Tribol. 125 (2003) 685; residual depth as for Jackson and Green",
    equations="4.12, 4.14, 4.23-4.27",
    standing=Standing.THESIS,
    domain=Domain(note="indentation by a rigid sphere"),
    breaks=(
        ("force falls at Q = 1.78", 5.2),
        ("force jumps at Q = 21", 4.0),
        ("force jumps at Q = 400", 11.2),
        ("radius falls at Q = 1.78", 2.4),
        ("radius jumps at Q = 400", 5.5),
        ("not Hertz: the truncated radius, -delta/(4 R) at D = 0.01", 0.26),
    ),
    regime="indentation",
    read="the thesis only",
    own=Kernels(_loading, _radius, _unloading, _residual),
    numbers=_numbers,
)
