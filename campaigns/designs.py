"""The sweeps, a few lines each.

A design is a name and a function that gives its cases, in the order in which they are computed: a
run that is stopped early has first what the thesis shows, then every range from coarse to fine. The
parts of each large design are designs themselves: a part can be published when it is done.
Strengths follow the thesis: Sy_min is held and Sy* = S_ys/S_yf sets the stronger body. All but
`smoke` go to Delta/R = 0.1 or a/R = 0.5, whichever comes later, in 48 depths from below first yield
through the thesis's 0.04, and unload from five of them; `survey` does so at medium resolution, the
others at that of published data.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import product

import numpy as np

from .. import fem
from ..core.errors import InputError
from ..core.material import Material, Pair
from ..core.provenance import file_digest
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


# Sy* of the thesis's sweeps; its steep part, 0.9 to 1.7, in steps of 0.05 and at its dip, 1.07
RATIOS = (
    *(0.1, 0.14, 0.2, 0.28, 0.4, 0.5, 0.6, 0.7, 0.8),
    *(round(0.9 + 0.05 * k, 2) for k in range(17)),
    *(1.07, 1.85, 2.0, 2.5, 3.5, 5.0, 7.0, 10.0),
)

# those of the first part of `thesis`: both ends, equal strengths and the steep part
_FIRST_RATIOS = (0.1, 0.5, 0.9, 1.0, 1.1, 1.25, 1.4, 1.6, 10.0)
_SECOND = 18  # as many more in its second part
_THESIS_DEPTH = 0.04  # Delta/R of the thesis's figures over Sy*


def coarse_to_fine(
    values: tuple[float, ...], *, after: tuple[float, ...] = ()
) -> tuple[float, ...]:
    """Order values so that every beginning of the list covers their range evenly.

    Parameters
    ----------
    values
        All of them.
    after
        Those that come first anyway and are not repeated; by default the two ends are first.

    Examples
    --------
    >>> coarse_to_fine((1.0, 2.0, 3.0, 4.0, 5.0))
    (1.0, 5.0, 3.0, 2.0, 4.0)
    >>> coarse_to_fine((1.0, 2.0, 3.0, 4.0, 5.0), after=(1.0, 2.0))
    (5.0, 3.0, 4.0)
    """
    values = tuple(sorted(values))
    taken = [values.index(value) for value in after] or [0, len(values) - 1]
    while len(taken) < len(values):
        left = (k for k in range(len(values)) if k not in taken)
        taken.append(max(left, key=lambda k: min(abs(k - t) for t in taken)))
    return tuple(values[k] for k in taken[len(after) :])


def _deep_case(
    name: str,
    pair: Pair,
    *,
    deepest: float = 0.1,
    fields: bool = False,
    accuracy: fem.Accuracy = fem.Accuracy.production(),  # noqa: B008 (frozen)
) -> Case:
    """Case to a/R = 0.5: three unloadings below 20 critical depths, two beyond."""
    onset = fem.critical_depth(pair)
    last_light = min(18.0 * onset, 0.5 * deepest)
    light = fem.geometric_depths(1.5 * onset, last_light, 3)
    return standard_case(
        name,
        pair,
        deepest=deepest,
        n_depths=48,
        unload_depths=(*light, (last_light * deepest) ** 0.5, deepest),
        radius_at_least=0.5,
        through=_THESIS_DEPTH,
        fields=fields,
        accuracy=accuracy,
    )


@cache
def _survey() -> tuple[Case, ...]:
    """64 scrambled Sobol points over the ranges of `space`, at twice its element size."""
    from scipy.stats import qmc

    points = qmc.Sobol(6, scramble=True, rng=np.random.default_rng(64)).random_base2(6)
    return tuple(
        _deep_case(f"survey-{k:02}", _drawn_pair(u), accuracy=fem.Accuracy.quick())
        for k, u in enumerate(points)
    )


@cache
def _thesis_first() -> tuple[Case, ...]:
    """The figures' cases, the pairs of chapters 3-5, Table 2.1 at nine Sy*."""
    pictures = [
        _deep_case(
            f"figure-{figure}",
            pair_of(E_s=200.0, E_f=200.0, Sy_min=503.0, ratio=ratio),
            fields=True,
        )
        for figure, ratio in (("2.2", 0.1), ("2.3", 1.0), ("2.4", 10.0))
    ]
    rod = _chapter_3()
    striker = pair_of(E_s=200.0, E_f=200.0, Sy_min=305.0, ratio=760 / 305)
    large = pair_of(E_s=300.0, E_f=300.0, Sy_min=100.0, ratio=10.0)
    return (
        *pictures,
        _deep_case("chapter-3", rod, deepest=2500.0 * fem.critical_depth(rod)),
        _deep_case("chapter-4-5", striker),
        _deep_case("figure-2.17", large),
        *_table_2_1(_FIRST_RATIOS),
    )


def _chapter_3() -> Pair:
    # the thesis states no Poisson ratio for chapter 3; 0.3 as in chapters 4 and 5
    return pair_of(E_s=212.0, E_f=200.0, Sy_min=298.0, ratio=750.0 / 298.0)


@cache
def _thesis_second() -> tuple[Case, ...]:
    """Table 2.1 at 18 more values of Sy*."""
    others = coarse_to_fine(RATIOS, after=_FIRST_RATIOS)[:_SECOND]
    return _without(_table_2_1(others), _thesis_first())


@cache
def _thesis_third() -> tuple[Case, ...]:
    """27 sets of materials at Sy* = 0.1, 1 and 10, the last values of Sy*, figure 2.16, chapter 3.

    The thesis does not print its 27 sets; ours are E_s, E_f from 50, 122, 300 GPa and Sy_min from
    50, 235, 1100 MPa. The pair of chapter 3 is here a second time, to the depth that its mesh
    bears: the path to 2500 critical depths ends at 2473 of them.
    """
    others = coarse_to_fine(RATIOS, after=_FIRST_RATIOS)[_SECOND:]
    rod = _chapter_3()
    deep = _deep_case("chapter-3-to-2450", rod, deepest=2450.0 * fem.critical_depth(rod))
    rest = [*_twenty_seven_sets(), *_table_2_1(others), *_figure_2_16(), deep]
    return _without(rest, (*_thesis_first(), *_thesis_second()))


def _without(cases: Sequence[Case], others: Sequence[Case]) -> tuple[Case, ...]:
    """Cases that are not among the others."""
    there = {case.id for case in others}
    return tuple(case for case in cases if case.id not in there)


def _table_2_1(ratios: tuple[float, ...]) -> list[Case]:
    cases = []
    for ratio, (number, (E_s, E_f, Sy, nu_s, nu_f)) in product(ratios, TABLE_2_1.items()):
        pair = pair_of(E_s=E_s, E_f=E_f, Sy_min=Sy, ratio=ratio, nu_s=nu_s, nu_f=nu_f)
        cases.append(_deep_case(f"table-2.1-case-{number}-Sy*-{ratio:g}", pair))
    return cases


def _twenty_seven_sets() -> list[Case]:
    moduli, strengths = (50.0, 122.0, 300.0), (50.0, 235.0, 1100.0)
    return [
        _deep_case(
            f"set-{E_s:g}-{E_f:g}-{Sy:g}-Sy*-{ratio:g}",
            pair_of(E_s=E_s, E_f=E_f, Sy_min=Sy, ratio=ratio),
        )
        for ratio, E_s, E_f, Sy in product((0.1, 1.0, 10.0), moduli, moduli, strengths)
    ]


def _figure_2_16() -> list[Case]:
    return [
        _deep_case(
            f"figure-2.16-Sy*-{ratio:g}",
            pair_of(E_s=71.7, E_f=200.0, Sy_min=300.0, ratio=ratio),
        )
        for ratio in (0.1, 0.5, 0.9, 1.0, 1.1, 1.3, 2.0, 10.0)
    ]


@cache
def _space() -> tuple[Case, ...]:
    """256 scrambled Sobol points; in every fourth the two moduli are equal."""
    from scipy.stats import qmc

    points = qmc.Sobol(6, scramble=True, rng=np.random.default_rng(20141)).random_base2(8)
    return tuple(
        _deep_case(f"space-{k:03}", _drawn_pair(u, equal_moduli=k % 4 == 0))
        for k, u in enumerate(points)
    )


@cache
def _validation() -> tuple[Case, ...]:
    """48 pairs kept out of every fit: 24 anywhere, 16 at the steep part, 8 of soft, strong bodies.

    The last have E'/Sy_min below 60, where first yield lies deepest.
    """
    draw = np.random.default_rng(77003).random((48, 6))
    return tuple(
        _deep_case(f"validation-{k:02}", pair) for k, pair in enumerate(_for_judging(draw))
    )


def _for_judging(draw: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> list[Pair]:
    """Half of the pairs anywhere, a third at the steep part, the others of soft, strong bodies."""
    half, most = len(draw) // 2, 5 * len(draw) // 6
    pairs = [_drawn_pair(u) for u in draw[:half]]
    pairs += [_drawn_pair(u, ratios=(0.85, 1.7)) for u in draw[half:most]]
    pairs += [_drawn_pair(u, moduli=(50.0, 95.0), strengths=(950.0, 1100.0)) for u in draw[most:]]
    return pairs


def _challenge() -> tuple[Case, ...]:
    from ..models.fitted import COEFFICIENTS_FILE

    return challenge_cases(file_digest(COEFFICIENTS_FILE))


def challenge_cases(digest: str) -> tuple[Case, ...]:
    """24 pairs drawn from a checksum: 12 anywhere, 8 at the steep part, 4 of soft, strong bodies.

    Parameters
    ----------
    digest
        Hexadecimal; its first twelve digits are the seed, and stand in the cases' names.
    """
    draw = np.random.default_rng(int(digest[:12], 16)).random((24, 6))
    name = f"challenge-{digest[:12]}"
    return tuple(_deep_case(f"{name}-{k:02}", pair) for k, pair in enumerate(_for_judging(draw)))


def _drawn_pair(
    u: np.ndarray[tuple[int], np.dtype[np.float64]],
    *,
    moduli: tuple[float, float] = (50.0, 300.0),
    strengths: tuple[float, float] = (50.0, 1100.0),
    ratios: tuple[float, float] = (0.1, 10.0),
    equal_moduli: bool = False,
) -> Pair:
    """Pair from six numbers in [0, 1): moduli [GPa] linear, strength [MPa] and Sy* logarithmic."""
    E_s, E_f = (_digits(moduli[0] + (moduli[1] - moduli[0]) * x) for x in u[:2])
    Sy, ratio = (
        _digits(a * (b / a) ** x) for (a, b), x in zip((strengths, ratios), u[2:4], strict=True)
    )
    nu_s, nu_f = (round(float(0.2 + 0.25 * x), 3) for x in u[4:])
    return pair_of(
        E_s=E_s, E_f=E_s if equal_moduli else E_f, Sy_min=Sy, ratio=ratio, nu_s=nu_s, nu_f=nu_f
    )


@cache
def _robustness() -> tuple[Case, ...]:
    """300 scrambled Sobol points over all that the solver is meant for, at medium resolution.

    E_s/E_f 1/6 to 6, nu 0.1 to 0.45, Sy* 0.05 to 20 and E'/Sy_min 20 to 4000.
    """
    from scipy.stats import qmc

    points = qmc.Sobol(5, scramble=True, rng=np.random.default_rng(300)).random_base2(9)[:300]
    cases = []
    for k, u in enumerate(points):
        stiffness = 6.0 ** (2.0 * u[0] - 1.0)
        nu_s, nu_f = (round(float(0.1 + 0.35 * x), 3) for x in u[1:3])
        pair = pair_of(
            E_s=_digits(100.0 * stiffness**0.5),
            E_f=_digits(100.0 / stiffness**0.5),
            Sy_min=1.0,
            ratio=_digits(0.05 * 400.0 ** u[3]),
            nu_s=nu_s,
            nu_f=nu_f,
        )
        strength = _digits(pair.E_reduced / (20.0 * 200.0 ** u[4]))
        pair = replace(
            pair,
            sphere=replace(pair.sphere, Sy=pair.sphere.Sy / 1e6 * strength),
            flat=replace(pair.flat, Sy=pair.flat.Sy / 1e6 * strength),
        )
        cases.append(
            standard_case(
                f"robustness-{k:03}", pair, deepest=0.1, n_depths=24, accuracy=fem.Accuracy.quick()
            )
        )
    return tuple(cases)


def _digits(x: float) -> float:
    return float(f"{x:.4g}")


def _thesis() -> tuple[Case, ...]:
    return (*_thesis_first(), *_thesis_second(), *_thesis_third())


def _full() -> tuple[Case, ...]:
    return (*_thesis(), *_space(), *_validation())


DESIGNS: dict[str, Design] = {
    design.name: design
    for design in (
        Design("smoke", "12 cases at low resolution to Delta/R = 0.04", _smoke),
        Design("survey", "64 Sobol points at medium resolution, enough for a first fit", _survey),
        Design(
            "thesis", "Table 2.1 over Sy*, 27 sets of materials, figures, chapters 3-5", _thesis
        ),
        Design("thesis-1", "its first part: pictures, chapters, nine Sy*", _thesis_first),
        Design("thesis-2", "its second part: 18 more Sy*", _thesis_second),
        Design("thesis-3", "its third part: the 27 sets, the last Sy*, figure 2.16", _thesis_third),
        Design("space", "256 Sobol points over moduli, Poisson ratios, strengths", _space),
        Design("space-1", "its first 32 points, a Sobol design themselves", lambda: _space()[:32]),
        Design("space-2", "the next 32, a Sobol design with the first", lambda: _space()[32:64]),
        Design("space-3", "the next 64, likewise", lambda: _space()[64:128]),
        Design("space-4", "its other points", lambda: _space()[128:]),
        Design("validation", "48 pairs that no fit may use", _validation),
        Design(
            "challenge",
            "24 pairs drawn from the checksum of the coefficients in use, which no fit may use",
            _challenge,
        ),
        Design("full", "thesis, space and validation", _full),
        Design(
            "robustness",
            "300 Sobol points over the solver's whole range, medium resolution",
            _robustness,
        ),
    )
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
    """Cases of a design by their id, in its order; equal ones are computed once."""
    cases: dict[str, Case] = {}
    for case in design.make():
        cases.setdefault(case.id, case)
    return cases
