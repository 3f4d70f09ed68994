"""A tension or compression test: the flow curve of a metal from stress over strain."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...core.arrays import Array, Indices
from ...core.errors import InputError
from ...core.inputs.flow_curve import PROOF_STRAIN, MeasuredFlow
from ..measured import Measured
from ..regression import robust_regression
from ..rules import RULES


@dataclass(frozen=True)
class TensionReduction:
    """True stress over true strain [Pa, -], the modulus, and the flow curve."""

    strain: Array
    stress: Array
    modulus: Measured
    flow: MeasuredFlow
    values: dict[str, Measured]
    notes: tuple[str, ...]


def reduce_tension(
    strain: Array, stress: Array, *, strain_is: str, E: float | None, source: str
) -> TensionReduction:
    """Return the flow curve, up to where a specimen begins to neck.

    Engineering values are made true ones, e = ln(1 + e_n), s = s_n (1 + e_n), up to the largest
    engineering stress (Considere); the plastic strain is e - s/E. Compression counts as positive.

    Parameters
    ----------
    strain, stress
        (n,) in the order of loading [-, Pa].
    strain_is
        `"engineering"` or `"true"`; the stress likewise.
    E
        Modulus [Pa]; None reads it from the curve.
    source
        The file.

    Raises
    ------
    InputError
        Too few rows, no elastic part, or no yield.
    """
    wild = np.flatnonzero(
        (np.abs(strain) > RULES.absurd_strain) | (np.abs(stress) > RULES.absurd_stress)
    )
    if wild.size:
        k = wild[0]
        raise InputError(
            f"strain {strain[k]:.3g}, stress {stress[k]:.3g} Pa in data row {k + 1}",
            source=source, allowed=f"strains up to {RULES.absurd_strain:g}, "
            f"stresses up to {RULES.absurd_stress:g} Pa",
        )  # fmt: skip
    whole = np.isfinite(strain) & np.isfinite(stress)
    strain, stress = strain[whole], stress[whole]
    if strain.size < RULES.table_rows:
        raise InputError(
            f"{strain.size} rows",
            source=source,
            allowed=f"{RULES.table_rows} or more of strain and stress",
        )
    sign = math.copysign(1.0, float(stress[np.argmax(np.abs(stress))]))
    strain, stress = sign * strain, sign * stress
    notes = []
    top = int(np.argmax(stress))
    if strain_is == "engineering":
        if top + 1 < stress.size:
            notes.append(f"cut at the largest stress, strain {strain[top]:.3g}: the specimen necks")
        strain, stress = strain[: top + 1], stress[: top + 1]
        shrunk = 1.0 + sign * strain
        if not (shrunk > 0.0).all():
            raise InputError(
                f"strain {sign * strain.max():.3g}", source=source, allowed="strains, not percent"
            )
        strain, stress = sign * np.log(shrunk), stress * shrunk
    modulus, zero = _modulus(strain, stress, source)
    used = modulus.value if E is None else E
    told = modulus if E is None else Measured(E, 0.0)
    if E is not None and abs(modulus.value / E - 1.0) > 0.2:
        notes.append(
            f"the curve rises with {modulus.value / 1e9:.3g} GPa, not {E / 1e9:.3g}: the machine "
            "gives way; the plastic strain is counted from the curve's own line"
        )
        used, told = modulus.value, modulus.widened(modulus.value - E)
    plastic = strain - zero - stress / used
    flow = _rows(plastic, stress, source)
    values = {
        "E_Pa": told, "Sy_Pa": Measured(flow.strength, 0.02 * flow.strength),
        "largest_stress_Pa": Measured(float(flow.stress[-1]), math.nan),
        "largest_plastic_strain": Measured(float(flow.strain[-1]), math.nan),
    }  # fmt: skip
    return TensionReduction(strain - zero, stress, modulus, flow, values, tuple(notes))


def _modulus(strain: Array, stress: Array, source: str) -> tuple[Measured, float]:
    """Return the slope of the first rise [Pa] and the strain at which it meets zero stress."""
    rise = _elastic(strain, stress)
    if rise.size < 3 or np.ptp(strain[rise]) <= 0.0:
        raise InputError(
            f"{rise.size} rows of the elastic rise", source=source,
            allowed="three or more between a tenth and four tenths of the largest stress",
        )  # fmt: skip
    middle = float(strain[rise].mean())
    design = np.stack([np.ones(rise.size), strain[rise] - middle], axis=1)
    fit = robust_regression(design, stress[rise])
    slope = float(fit.coefficients[1])
    if not slope > 0.0:
        raise InputError("the stress does not rise", source=source, allowed="a loading curve")
    return Measured(slope, math.sqrt(float(fit.covariance[1, 1]))), middle - float(
        fit.coefficients[0]
    ) / slope


def _elastic(strain: Array, stress: Array) -> Indices:
    """Return the rows of the highest straight rise: a metal that hardens much yields low."""
    peak, found = float(stress.max()), np.arange(0)
    for high in RULES.elastic_parts:
        first = int(np.argmax(stress > high * peak)) + 1
        rise = np.flatnonzero(stress[:first] > 0.25 * high * peak)
        if found.size and rise.size < RULES.fewest:
            break
        found = rise
        if rise.size < RULES.fewest:
            continue
        middle = np.median(stress[rise])
        low, up = (
            np.polyfit(stress[part], strain[part], 1)[0]
            for part in (rise[stress[rise] <= middle], rise[stress[rise] >= middle])
        )
        if low >= RULES.elastic_straight * up:
            break
    return found


def _rows(plastic: Array, stress: Array, source: str) -> MeasuredFlow:
    """Thin the curve out to rows that increase, from the first plastic strain of 0 on."""
    largest = float(plastic.max())
    if not largest > 2.0 * PROOF_STRAIN:
        raise InputError(
            f"a plastic strain of {largest:.2g} at the most", source=source,
            allowed=f"a test beyond {2.0 * PROOF_STRAIN:g}",
        )  # fmt: skip
    # what scatters about the elastic line belongs to it; a gauge that came off at the end does not
    elastic = np.flatnonzero(plastic[: int(plastic.argmax())] <= RULES.yields)
    begin = int(elastic[-1]) + 1 if elastic.size else 0
    plastic, stress = plastic[begin:], stress[begin:]
    edges = np.geomspace(RULES.yields, largest, RULES.tension_kept)
    means = [
        (float(np.mean(plastic[there])), float(np.median(stress[there])))
        for low, high in pairwise(edges)
        if (there := (plastic > low) & (plastic <= high)).any()
    ]
    strain, flow = np.array(means).T
    first = np.concatenate([[0.0], strain]), np.concatenate([[flow[0]], flow])
    nothing = np.full(first[0].size, np.nan)
    return MeasuredFlow(first[0], first[1], nothing, nothing)
