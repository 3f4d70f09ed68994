"""The sweeps, a few lines each.

A design is a name and a function that gives its cases. Strengths follow the thesis: Sy_min is held
and Sy* = S_ys/S_yf sets the stronger body.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .. import fem
from ..core.errors import InputError
from ..core.material import Material, Pair
from .case import Case, standard_case


@dataclass(frozen=True)
class Design:
    """A named set of cases."""

    name: str
    about: str
    make: Callable[[], tuple[Case, ...]]


def pair_of(
    *, E_s: float, E_f: float, Sy_min: float, ratio: float, nu_s: float = 0.3, nu_f: float = 0.3
) -> Pair:
    """Pair from moduli [GPa], the weaker strength [MPa] and Sy* = S_ys/S_yf; R = 1 mm."""
    s, f = (Sy_min, Sy_min / ratio) if ratio < 1.0 else (Sy_min * ratio, Sy_min)
    return Pair(
        sphere=Material(E=E_s * 1e9, nu=nu_s, Sy=s * 1e6),
        flat=Material(E=E_f * 1e9, nu=nu_f, Sy=f * 1e6),
        R=1e-3,
    )


# Table 2.1 of the thesis: E_s, E_f [GPa], Sy_min [MPa], nu_s, nu_f
TABLE_2_1 = {
    1: (200.0, 200.0, 200.0, 0.30, 0.30),
    2: (200.0, 200.0, 300.0, 0.33, 0.30),
    3: (71.7, 200.0, 300.0, 0.33, 0.30),
    4: (71.7, 200.0, 503.0, 0.30, 0.30),
    5: (200.0, 200.0, 503.0, 0.33, 0.30),
}


def _smoke() -> tuple[Case, ...]:
    """Cases 1, 3 and 5 of Table 2.1 at four strength ratios."""
    cases = []
    for number in (1, 3, 5):
        E_s, E_f, Sy, nu_s, nu_f = TABLE_2_1[number]
        for ratio in (0.1, 1.0, 1.5, 10.0):
            pair = pair_of(E_s=E_s, E_f=E_f, Sy_min=Sy, ratio=ratio, nu_s=nu_s, nu_f=nu_f)
            cases.append(
                standard_case(
                    f"table-2.1-case-{number}-Sy*-{ratio:g}",
                    pair,
                    deepest=0.04,
                    n_depths=40,
                    unload_w=(5.0, 20.0),
                    unload_depths=(0.01, 0.04),
                    accuracy=fem.Accuracy.smoke(),
                )
            )
    return tuple(cases)


DESIGNS: dict[str, Design] = {
    design.name: design
    for design in (Design("smoke", "12 cases at low resolution to Delta/R = 0.04", _smoke),)
}
"""Every design by name."""


def design_named(name: str) -> Design:
    """Return a design.

    Raises
    ------
    InputError
        There is none of that name; the message lists the known ones.
    """
    if name not in DESIGNS:
        raise InputError(f"{name!r}", key="design", allowed=", ".join(DESIGNS))
    return DESIGNS[name]


def distinct_cases(design: Design) -> dict[str, Case]:
    """Cases of a design by their id; equal ones are computed once."""
    return {case.id: case for case in design.make()}
