"""The sweeps, a few lines each.

A design is a name and a function that gives its cases, in the order in which they are computed: a
run that is stopped early has first what the thesis shows, then every range from coarse to fine. The
parts of each large design are designs themselves: a part can be published when it is done.
All but `smoke` go to Delta/R = 0.1 or a/R = 0.5, whichever comes later, in 48 depths from below
first yield through the thesis's 0.04, and unload from five of them; `survey` does so at medium
resolution, the others at that of published data.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ..core.errors import InputError
from .case import Case
from .cases.drawn import (
    challenge,
    near_equal,
    robustness,
    space,
    survey,
    validation,
    validation_2,
)
from .cases.hardening import hardening, robustness_hardening, validation_hardening
from .cases.plateau import plateau, validation_plateau
from .cases.thesis import smoke, thesis_first, thesis_second, thesis_third


@dataclass(frozen=True)
class Design:
    """A named set of cases."""

    name: str
    about: str
    make: Callable[[], tuple[Case, ...]]


def _thesis() -> tuple[Case, ...]:
    return (*thesis_first(), *thesis_second(), *thesis_third())


DESIGNS: dict[str, Design] = {
    design.name: design
    for design in (
        Design("smoke", "12 cases at low resolution to Delta/R = 0.04", smoke),
        Design("survey", "64 Sobol points at medium resolution, enough for a first fit", survey),
        Design(
            "thesis", "Table 2.1 over Sy*, 27 sets of materials, figures, chapters 3-5", _thesis
        ),
        Design("thesis-1", "its first part: pictures, chapters, nine Sy*", thesis_first),
        Design("thesis-2", "its second part: 18 more Sy*", thesis_second),
        Design("thesis-3", "its third part: the 27 sets, the last Sy*, figure 2.16", thesis_third),
        Design("space", "256 Sobol points over moduli, Poisson ratios, strengths", space),
        Design("space-1", "its first 32 points, a Sobol design themselves", lambda: space()[:32]),
        Design("space-2", "the next 32, a Sobol design with the first", lambda: space()[32:64]),
        Design("space-3", "the next 64, likewise", lambda: space()[64:128]),
        Design("space-4", "its other points", lambda: space()[128:]),
        Design("near-equal", "128 Sobol points at Sy* 0.75 to 1.35", near_equal),
        Design("hardening", "96 Sobol points over metals that harden", hardening),
        Design("plateau", "48 Sobol points over flow curves that bend: plateaus, knees", plateau),
        Design("validation", "48 pairs that no fit may use", validation),
        Design("validation-2", "48 more, half of them near equal strengths", validation_2),
        Design(
            "validation-hardening", "24 pairs that harden, for no fit either", validation_hardening
        ),
        Design(
            "validation-plateau",
            "24 pairs whose curves bend, six of measured steels, for no fit either",
            validation_plateau,
        ),
        Design(
            "challenge",
            "24 pairs drawn from the checksum of the coefficients in use, which no fit may use",
            challenge,
        ),
        Design(
            "full", "thesis, space and validation", lambda: (*_thesis(), *space(), *validation())
        ),
        Design(
            "robustness",
            "300 Sobol points over the solver's whole range, medium resolution",
            robustness,
        ),
        Design(
            "robustness-hardening",
            "200 Sobol points over metals that harden in three ways, medium resolution",
            robustness_hardening,
        ),
    )
}
"""Every design by name."""


def design_named(name: str) -> Design:
    """Return a design, or refuse a name with those that are known."""
    if name not in DESIGNS:
        raise InputError(
            f"{name!r}", key="design", allowed=f"a folder of CASE.toml files, {', '.join(DESIGNS)}"
        )
    return DESIGNS[name]


def distinct_cases(design: Design) -> dict[str, Case]:
    """Cases of a design by their id, in its order; equal ones are computed once."""
    cases: dict[str, Case] = {}
    for case in design.make():
        cases.setdefault(case.id, case)
    return cases
