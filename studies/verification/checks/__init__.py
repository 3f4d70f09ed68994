"""Every check, in the order of the report.

Exact solutions, balances, discretisation, numbers of others. Cheap ones come first: a run that is
stopped early has given most of the report.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING

from ....core.errors import InputError

if TYPE_CHECKING:
    from ..bench import Bench
    from ..result import Result


@dataclass(frozen=True)
class Check:
    """A named check; its code is loaded when it is run, so that names and titles cost nothing.

    `name`, `title`: as the command and the report show them; `home`: module of this folder and its
    function, `module.function`; `missed`: why marks of it stand missed, and what was tried.
    """

    name: str
    title: str
    home: str
    missed: str = ""

    def run(self, bench: Bench) -> Result:
        """Measure it."""
        module, function = self.home.rsplit(".", 1)
        found: Result = getattr(import_module(f".{module}", __package__), function)(bench)
        return found


CHECKS: tuple[Check, ...] = (
    Check("patch", "uniform pressure across the contact", "patch.run"),
    Check("rates", "manufactured solution and elastic contact under halved elements", "rates.run"),
    Check("locking", "plastic limit loads, nearly incompressible elasticity", "locking.run"),
    Check("hertz", "elastic contact: F, a, pressure, stresses on the axis", "hertz.run"),
    Check(
        "first-yield",
        "depth and load at first yield",
        "first_yield.run",
        "The load goes as the depth to the power 1.5: its mark asks for the depth within 0.67 %; "
        "integration points scatter about their element's mean by more. The means meet both marks. "
        "Tried: half the elements, extrapolated; both meshes then yield at one depth.",
    ),
    Check("friction", "full stick, Borodich and Keer; what friction adds", "friction.run"),
    Check("truncation", "truncation of the half-space", "truncation.run"),
    Check("penalty", "independence of the contact stiffness", "penalty.run"),
    Check("role-swap", "exchange of the bodies where the problem is symmetric", "role_swap.run"),
    Check("indentation", "slip-line hardness and published indentation", "indentation.run"),
    Check("similarity", "power-law plasticity: Storåkers, Biwa and Larsson", "similarity.run"),
    Check("speed", "a hundred times the speed, exactly by similarity", "similarity.speed"),
    Check(
        "impact-strength",
        "what hardening and rate make of an impact, beside the diagnosis",
        "impact_strength.run",
    ),
    Check("flattening", "Jackson and Green, Kogut and Etsion", "flattening.run"),
    Check(
        "levels",
        "mesh and step over Table 2.1: what the levels state of themselves",
        "level_errors.run",
        "F lies below the limit in all pairs alike: few depths are much nearer to it than the rms. "
        "With ever shorter steps F of plastic contacts rises by up to 0.9 % (first order), a by "
        "0.2 %; half the elements change either by 0.2 %. Tried: flow of second order (BDF2): F "
        "within 0.1 %, a 0.2 % worse, up to half more time. Asked were 0.5 % of F and a: stated "
        "are up to 1.0 and 0.6 %.",
    ),
    Check("independent-code", "the same cases in CalculiX", "independent_code.run"),
    Check(
        "balances",
        "energy and force of every kept solve",
        "balances.run",
        "Energy: only solves with elements twice as large exceed the mark. Force: round-off, as "
        "large with any mesh and step.",
    ),
)
"""In the order of the report."""


def check_named(name: str) -> Check:
    """Return a check.

    Raises `InputError`: there is none of that name; the message lists the known ones.
    """
    for check in CHECKS:
        if check.name == name:
            return check
    known = ", ".join(c.name for c in CHECKS)
    raise InputError(repr(name), source="command line", key="--only", allowed=known)
