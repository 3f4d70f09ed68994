"""Contact radius, force and mean pressure without units: of a law, of a stored case, compared."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ....campaigns import CaseRecord
from ....campaigns.cases.pairs import table_2_1
from ....core.arrays import Array
from ....core.material import Pair
from ....models.base import ContactLaw
from ....models.published.ghaednia import share_of_sphere
from ...plot import at_depth, laws, same

DEPTH = 0.04
"""Delta/R of the thesis's comparisons."""
RATIOS = np.geomspace(0.1, 10.0, 241)
"""Sy* of its curves."""

Quantity = Callable[[ContactLaw, Pair, Array], Array]


def radius(law: ContactLaw, pair: Pair, D: Array) -> Array:
    """Contact radius over R."""
    return law.contact_radius(pair, D * pair.R) / pair.R


def force(law: ContactLaw, pair: Pair, D: Array) -> Array:
    """Force over E' R^2."""
    return law.loading(pair, D * pair.R) / (pair.E_reduced * pair.R**2)


def pressure(law: ContactLaw, pair: Pair, D: Array) -> Array:
    """Mean pressure over Sy_min."""
    return law.hardness(pair, D * pair.R) / pair.Sy_min


def model_share(pair: Pair, D: float = DEPTH) -> float:
    """The sphere's share of the approach by the thesis's model."""
    return share_of_sphere(D, pair.E_reduced / pair.Sy_min, pair.Sy_ratio, 1.0)


def of_record(quantity: Quantity, record: CaseRecord, D: float) -> float:
    """The same of a stored case; nan beyond its curve."""
    found, pair = at_depth(record, D), record.case.pair
    if not found:
        return float("nan")
    if quantity is radius:
        return found["radius"] / pair.R
    if quantity is force:
        return found["force"] / (pair.E_reduced * pair.R**2)
    return found["hardness"] / pair.Sy_min


def case_records(records: Sequence[CaseRecord], number: int) -> list[tuple[float, CaseRecord]]:
    """Stored cases of table 2.1's case `number`, with their Sy*."""
    found = []
    for record in records:
        ratio = record.case.pair.Sy_ratio
        if 0.05 <= ratio <= 20.0 and same(record, table_2_1(number, ratio)):
            found.append((ratio, record))
    return sorted(found, key=lambda item: item[0])


def along(law: ContactLaw, number: int, quantity: Quantity) -> Array:
    """A quantity over `RATIOS` for case `number` of table 2.1."""
    D = np.array([DEPTH])
    return np.array([float(quantity(law, table_2_1(number, s), D)[0]) for s in RATIOS])


def _compare(law: ContactLaw, points: list[tuple[float, float, Pair]], quantity: Quantity) -> str:
    D = np.array([DEPTH])
    off = [abs(float(quantity(law, p, D)[0]) / y - 1.0) for _, y, p in points]
    return f"{law.name} {np.mean(off):.1%} ({max(off):.1%})"


def beside_points(points: list[tuple[float, float, Pair]], quantity: Quantity) -> str:
    """Deviation of the two laws for both bodies from stored cases, for a note."""
    if not points:
        return "No finite-element case of table 2.1 was found; only the laws are drawn."
    told = ", ".join(_compare(law, points, quantity) for law in laws("ghaednia", "fitted"))
    return f"Mean (largest) deviation from {len(points)} of our points: {told}."
