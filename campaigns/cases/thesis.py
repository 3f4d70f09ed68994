"""The cases of the thesis: Table 2.1 over Sy*, sets of materials, figures, chapters 3 to 5."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from itertools import product

from ... import fem
from ...core.material import Pair
from ..case import Case, standard_case
from .pairs import RATIOS, TABLE_2_1, deep_case, pair_of, table_2_1

# those of the first part of `thesis`: both ends, equal strengths and the steep part
_FIRST_RATIOS = (0.1, 0.5, 0.9, 1.0, 1.1, 1.25, 1.4, 1.6, 10.0)
_SECOND = 18  # as many more in its second part


def smoke() -> tuple[Case, ...]:
    """Cases 1, 3 and 5 of Table 2.1 at four strength ratios."""
    return tuple(
        standard_case(
            f"table-2.1-case-{number}-Sy*-{ratio:g}",
            table_2_1(number, ratio),
            deepest=0.04,
            n_depths=40,
            unload_w=(5.0, 20.0),
            unload_depths=(0.01, 0.04),
            accuracy=fem.Accuracy.smoke(),
        )
        for number, ratio in product((1, 3, 5), (0.1, 1.0, 1.5, 10.0))
    )


def coarse_to_fine(
    values: tuple[float, ...], *, after: tuple[float, ...] = ()
) -> tuple[float, ...]:
    """Order values so that every beginning of the list covers their range evenly.

    `values`: all of them; `after`: those that come first anyway and are not repeated; by default
    the two ends are first.

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


@cache
def thesis_first() -> tuple[Case, ...]:
    """The figures' cases, the pairs of chapters 3-5, Table 2.1 at nine Sy*."""
    pictures = [
        deep_case(
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
        deep_case("chapter-3", rod, deepest=2500.0 * rod.first_yield),
        deep_case("chapter-4-5", striker),
        deep_case("figure-2.17", large),
        *_table_2_1(coarse_to_fine(_FIRST_RATIOS)),
    )


def _chapter_3() -> Pair:
    # the thesis states no Poisson ratio for chapter 3; 0.3 as in chapters 4 and 5
    return pair_of(E_s=212.0, E_f=200.0, Sy_min=298.0, ratio=750.0 / 298.0)


@cache
def thesis_second() -> tuple[Case, ...]:
    """Table 2.1 at 18 more values of Sy*."""
    others = coarse_to_fine(RATIOS, after=_FIRST_RATIOS)[:_SECOND]
    return _without(_table_2_1(others), thesis_first())


@cache
def thesis_third() -> tuple[Case, ...]:
    """27 sets of materials at Sy* = 0.1, 1 and 10, the last values of Sy*, figure 2.16, chapter 3.

    The thesis does not print its 27 sets; ours are E_s, E_f from 50, 122, 300 GPa and Sy_min from
    50, 235, 1100 MPa. The pair of chapter 3 is here a second time, to the depth that its mesh
    bears: the path to 2500 critical depths ends at 2473 of them.
    """
    others = coarse_to_fine(RATIOS, after=_FIRST_RATIOS)[_SECOND:]
    rod = _chapter_3()
    deep = deep_case("chapter-3-to-2450", rod, deepest=2450.0 * rod.first_yield)
    rest = [*_twenty_seven_sets(), *_table_2_1(others), *_figure_2_16(), deep]
    return _without(rest, (*thesis_first(), *thesis_second()))


def _without(cases: Sequence[Case], others: Sequence[Case]) -> tuple[Case, ...]:
    """Cases that are not among the others."""
    there = {case.id for case in others}
    return tuple(case for case in cases if case.id not in there)


def _table_2_1(ratios: tuple[float, ...]) -> list[Case]:
    return [
        deep_case(f"table-2.1-case-{number}-Sy*-{ratio:g}", table_2_1(number, ratio))
        for ratio, number in product(ratios, TABLE_2_1)
    ]


def _twenty_seven_sets() -> list[Case]:
    moduli, strengths = (50.0, 122.0, 300.0), (50.0, 235.0, 1100.0)
    return [
        deep_case(
            f"set-{E_s:g}-{E_f:g}-{Sy:g}-Sy*-{ratio:g}",
            pair_of(E_s=E_s, E_f=E_f, Sy_min=Sy, ratio=ratio),
        )
        for ratio, E_s, E_f, Sy in product((0.1, 1.0, 10.0), moduli, moduli, strengths)
    ]


def _figure_2_16() -> list[Case]:
    return [
        deep_case(
            f"figure-2.16-Sy*-{ratio:g}",
            pair_of(E_s=71.7, E_f=200.0, Sy_min=300.0, ratio=ratio),
        )
        for ratio in (0.1, 0.5, 0.9, 1.0, 1.1, 1.3, 2.0, 10.0)
    ]
