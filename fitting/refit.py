"""The main path: a campaign's cases in, the laws and the content of their file out.

tables of the cases -> regression -> correction -> left out one by one -> the law of metals that
harden -> judged on cases that no fit reads. `coefficients.write_coefficients` writes the content;
the file is a law wherever one is named (`models.table_file`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..core.errors import InputError
from ..models.coefficients import laws_from
from ..models.fitted import ClosedForm
from ..models.hardening import hardening_law
from .calibrate import misses, within
from .coefficients import coefficients_content, hardening_content
from .hardening import fit_hardening, hardening_records, judged_designs
from .laws import FittedLaws, fit_laws
from .prediction import Errors, errors_of, predict_by
from .report import Within
from .table import ResidualTable, Sources, Table, read_sources, tables_of

Progress = Callable[[str], None]


class Judged(NamedTuple):
    """What unseen pairs say of laws.

    `errors`: of each law, by its name; `within`: share of the misses that each law's stated
    deviations hold, by its name; `names`: of the cases.
    """

    errors: list[tuple[str, Errors]]
    within: Mapping[str, Within]
    names: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Refit:
    """What a fit gives.

    - `laws`: the compact and the fitted law, with their errors.
    - `table`, `turns`: the rows that they were fitted to.
    - `content`: of the file of coefficients.
    - `validation`: errors on the cases that no fit reads; empty where there are none.
    - `hardens`: whether there were metals that harden, and `content` has their law.
    """

    laws: FittedLaws
    table: Table
    turns: ResidualTable
    content: dict[str, Any]
    validation: list[tuple[str, Errors]]
    hardens: bool


def refit(paths: Iterable[Path], *, progress: Progress = lambda _: None) -> Refit:
    """Fit the closed forms to the cases of runs and published parts.

    `progress` is called with a line before each step. Refused where a source is missing or damaged,
    or they hold no two completed elastic-plastic cases that unload.
    """
    sources = read_sources(paths)
    table, turns = tables_of(sources)
    if (unloaded := len(np.unique(turns.case[np.isfinite(turns.exponent)]))) < 2:
        raise InputError(
            f"combinations that unload: {unloaded}", source=", ".join(map(str, sources)),
            allowed="two or more, `unload_depths` beyond first yield in their design",
        )  # fmt: skip
    progress(
        f"{', '.join(map(str, sources))}: {len(table.pairs)} combinations, {len(table.D)} depths, "
        f"{len(turns.D)} unloadings; fitting, then leaving combinations out ..."
    )
    laws = fit_laws(table, turns)
    content = coefficients_content(laws, table, sources)
    hardens = refit_hardening(content, sources, progress=progress)
    try:
        validation = judged(sources, laws_from(content, source="this fit")).errors
    except InputError:  # no such case
        validation = []
    return Refit(laws, table, turns, content, validation, hardens)


def refit_hardening(
    content: dict[str, Any], sources: Sources, *, progress: Progress = lambda _: None
) -> bool:
    """Fit the law of metals that harden to the other laws of a content, and put it there.

    Returns whether the sources hold such metals; else nothing changes.
    """
    records = hardening_records(sources)
    if not records:
        return False
    progress(f"{len(records)} combinations that harden; fitting their law ...")
    fitted = laws_from(content, source="this fit")[1]
    found = fit_hardening(fitted, records)
    unread = judged_designs(hardening_law(fitted, found.correction), sources)
    content["hardening"] = hardening_content(found, sources, judged=unread)
    return True


def judged(sources: Sources, laws: Sequence[ClosedForm]) -> Judged:
    """Return the errors of laws on the cases that no fit reads; sources without one are refused."""
    table, turns = tables_of(sources, held_out=True)
    errors, shares = [], {}
    for law in laws:
        numbers = law.numbers(table.bodies)
        p = predict_by(numbers, table, turns)
        errors.append((law.name, errors_of(p, table, turns)))
        if law.calibration is not None:
            shares[law.name] = within(law.calibration, misses(p, numbers, table, turns))
    return Judged(errors, shares, table.names)
