"""A tension or compression test: the flow curve of a metal from stress over strain.

Or from the load and the extension of a specimen.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError
from ...core.inputs.flow_curve import PROOF_STRAIN, MeasuredFlow
from ...core.rules import RULES as CORE
from ..gates import Refused
from ..measured import Measured
from ..pictures import drawn_if_refused
from ..reduced import Reduced
from ..rules import RULES
from ..shared.units import LENGTH, UNITS
from .file import Columns
from .options import TableOptions
from .picture import draw_tension
from .rise import elastic_rise
from .series import no_number

_AREA_UNITS = {
    f"{unit}{square}": size**2 for unit, size in LENGTH.items() for square in ("2", "^2", "²")
} | {f"sq {unit}": size**2 for unit, size in LENGTH.items()}

# limit: strain and stress that no metal was measured at [-, Pa]; a slip of the unit
_NO_METAL = (10.0, 1e12)

# limit: rows of a curve that is written [-]: a screen or two
_TENSION_KEPT = 60


@dataclass(frozen=True)
class TensionReduction:
    """True stress over true strain [Pa, -], the modulus, and the flow curve."""

    strain: Array
    stress: Array
    modulus: Measured
    flow: MeasuredFlow
    values: dict[str, Measured]
    notes: tuple[str, ...]


def reduce(path: Path, table: Columns, options: TableOptions) -> Reduced:
    """Return the flow curve of a tension or compression test."""
    at, value = table.find(options.time, key="time"), table.find(options.value, key="value")
    parts, unit = _strain_unit(table, at, options), _stress_unit(table, value, options)
    with np.errstate(over="ignore"):  # what is too large is refused as that
        strain, stress = table.values[:, at] * parts, table.values[:, value] * unit
    with drawn_if_refused(strain, stress, axes=("strain", "stress")):
        found = reduce_tension(
            strain, stress, strain_is=options.strain_is, E=options.E_Pa, source=str(path)
        )
    notes = found.notes
    if options.E_Pa is None and table.unit(at) in LENGTH:
        notes += ("a travel of the machine's head holds its give: state E_Pa if it is one",)
    pair = np.isfinite(table.values[:, [at, value]])
    if (holes := np.flatnonzero(pair.sum(axis=1) == 1)).size:
        marks = {table.cells[int(k)][value if pair[k, 0] else at] for k in holes}
        notes += (f"{no_number(holes.size, sorted(marks))}: their rows are left out",)
    return Reduced(
        source=path, values=found.values, trials=(), notes=notes,
        draw=lambda to: draw_tension(found, to), flow=(options.body, found.flow),
    )  # fmt: skip


def _stress_unit(table: Columns, column: int, options: TableOptions) -> float:
    """Return the stress that one of a column's unit is worth [Pa].

    A column of loads is divided by the specimen's area: as given, or from the header's line `Area`
    or `Diameter`.
    """
    given = options.value_unit
    force = UNITS["force"].get(table.unit(column) if given == "file" else given)
    if force is None:
        return table.factor(column, "stress", given=given, key="value_unit")
    area = 1e-6 * (options.area_mm2 or 0.0) or _said(table, "area", _AREA_UNITS)
    area = area or 0.25 * math.pi * _said(table, "diameter", LENGTH) ** 2
    if not area > 0.0:
        raise InputError(
            f"column {table.names[column]!r} holds a load, and the file names no area",
            source=table.source, key="area_mm2", allowed="the specimen's cross-section",
        )  # fmt: skip
    return force / area


def _said(table: Columns, word: str, units: Mapping[str, float]) -> float:
    """The quantity that a header's line begins with a word [SI]; 0 without one."""
    number, unit = table.heading.quantity(word) or (0.0, "")
    return number * units.get(unit, 0.0)


def _strain_unit(table: Columns, column: int, options: TableOptions) -> float:
    """Return the strain that one of a column's unit is worth.

    A column of extensions is divided by the gauge length: as given in mm, or from the header's line
    `Gauge length` or `Gage length`.
    """
    unit = table.unit(column)
    if unit == "%":
        return 0.01
    if unit not in LENGTH:
        return 1.0
    said = (_said(table, word, LENGTH) for word in ("gauge length", "gage length"))
    length = 1e-3 * (options.gauge_length_mm or 0.0) or next(filter(None, said), 0.0)
    if not length > 0.0:
        raise InputError(
            f"column {table.names[column]!r} holds an extension, and the file names no gauge "
            "length", source=table.source, key="gauge_length_mm", allowed="the extensometer's",
        )  # fmt: skip
    return LENGTH[unit] / length


def reduce_tension(
    strain: Array, stress: Array, *, strain_is: str, E: float | None, source: str
) -> TensionReduction:
    """Return the flow curve, up to where a specimen begins to neck.

    Engineering values are made true ones, e = ln(1 + e_n), s = s_n (1 + e_n), up to the largest
    engineering stress (Considere); the plastic strain is e - s/E. Strain [-] and stress [Pa] have
    shape (n,), in the order of loading; compression counts as positive. Without a modulus E [Pa] it
    is read from the curve. Refused where there are too few rows, no elastic part or no yield, or no
    metal rises so.
    """
    if E is not None and (unit := _other_unit(E)):
        raise InputError(f"{E:g}", key="E_Pa", allowed=f"pascals; {E:g} {unit} would be a metal's")
    strain, stress = _readings(strain, stress, source)
    sign = math.copysign(1.0, float(stress[np.argmax(np.abs(stress))]))
    strain, stress, notes = sign * strain, sign * stress, []
    if strain_is == "engineering":
        if stress.argmax() + 1 < stress.size:
            why = ": the specimen necks" if sign > 0.0 else ""
            notes.append(f"cut at the largest stress, strain {strain[stress.argmax()]:.3g}{why}")
        strain, stress = _true(strain, stress, sign, source)
    rise, zero = elastic_rise(strain, stress, source)
    _no_slip(strain, stress, rise.value, source)
    modulus = rise
    if E is not None:
        modulus, zero, told = _stated(strain, stress, rise, zero, E)
        notes += told
    flow = _rows(strain - zero - stress / modulus.value, stress, source)
    if E is None and (wrong := _no_metal(rise, flow.strength)):
        raise Refused(
            wrong, source=source, key="E_Pa",
            allowed="strain of the specimen alone, without the machine's give and slack, or the "
            "metal's modulus",
        )  # fmt: skip
    values = {
        "E_Pa": modulus, "Sy_Pa": _strength(flow, rise),
        "largest_stress_Pa": Measured(float(flow.stress.max()), math.nan),
        "largest_plastic_strain": Measured(float(flow.strain[-1]), math.nan),
    }  # fmt: skip
    return TensionReduction(strain - zero, stress, rise, flow, values, tuple(notes))


def _readings(strain: Array, stress: Array, source: str) -> tuple[Array, Array]:
    """Return the rows that hold both numbers; refuse what no metal bears, and too few rows."""
    most = _NO_METAL
    wild = np.flatnonzero((np.abs(strain) > most[0]) | (np.abs(stress) > most[1]))
    if wild.size:
        k = wild[0]
        raise InputError(
            f"strain {strain[k]:.3g}, stress {stress[k]:.3g} Pa in data row {k + 1}",
            source=source, allowed=f"strains up to {most[0]:g}, stresses up to {most[1]:g} Pa",
        )  # fmt: skip
    whole = np.isfinite(strain) & np.isfinite(stress)
    if np.count_nonzero(whole) < RULES.table_rows:
        raise InputError(
            f"{np.count_nonzero(whole)} rows", source=source,
            allowed=f"{RULES.table_rows} or more of strain and stress",
        )  # fmt: skip
    return strain[whole], stress[whole]


def _true(strain: Array, stress: Array, sign: float, source: str) -> tuple[Array, Array]:
    """Make engineering values true ones, to the largest stress; `sign` is -1 in compression."""
    end = int(stress.argmax()) + 1
    strain, stress = strain[:end], stress[:end]
    shrunk = 1.0 + sign * strain
    if not (shrunk > 0.0).all():
        raise InputError(
            f"strain {sign * strain.max():.3g}", source=source, allowed="strains, not percent"
        )
    return sign * np.log(shrunk), stress * shrunk


def _stated(
    strain: Array, stress: Array, rise: Measured, zero: float, E: float
) -> tuple[Measured, float, list[str]]:
    """Return slope and zero of the line of a stated modulus [Pa], and what is to be said of it.

    They are the curve's own where that contradicts it.
    """
    if rise.std > RULES.own_error * rise.value:
        offset = (strain - stress / E)[: int(np.argmax(stress > 0.5 * stress.max()))]
        zero = float(np.partition(offset, 2)[2]) if offset.size > 2 else zero
        return Measured(E, 0.0), zero, []
    if abs(rise.value - E) <= max(0.2 * E, 2.0 * rise.std):
        return Measured(E, 0.0), zero, []
    why = (
        "the machine gives way" if rise.value < E else
        "no machine makes it steeper, so E_Pa is too low, or the strain, area or gauge length "
        "is wrong"
    )  # fmt: skip
    note = (
        f"the curve rises with {rise.value / 1e9:.3g} GPa, not {E / 1e9:.3g}: {why}; the "
        "plastic strain is counted from the curve's own line"
    )
    return rise.widened(rise.value - E), zero, [note]


def _no_slip(strain: Array, stress: Array, modulus: float, source: str) -> None:
    """Refuse a load that falls though the strain does not go back, and rises again elastically.

    A metal that yields with a fall (Lueders) goes on flat, and keeps half of its load at least.
    """
    before = np.maximum.accumulate(stress)
    low = int(np.argmax(before - stress))
    fall = float(before[low] - stress[low])
    high = int(np.argmax(stress >= before[low]))
    middle = low + int(np.argmax(stress[low:] >= stress[low] + 0.5 * fall))
    back = strain[high] - strain[low] > 0.5 * fall / modulus
    again = stress[middle] - stress[low] > 0.5 * modulus * (strain[middle] - strain[low])
    deep = fall > 0.5 * before[low]
    if fall > RULES.cycle_depth * stress.max() and (again or deep) and not back:
        as_elastic = " as the metal does elastically" if again else ""
        raise Refused(
            f"the load falls by {fall / before[low]:.0%} at a strain of {strain[low]:.3g} "
            f"and rises again{as_elastic}", source=source,
            allowed="a specimen that does not slip in its grips, and a gauge that stays on it",
        )  # fmt: skip


def _other_unit(E: float) -> str:
    """Return the unit in which a modulus is a metal's that is none in pascals, if there is one."""
    low, high = RULES.metal_moduli
    return next((u for u in ("MPa", "GPa") if E < low <= E * UNITS["stress"][u] <= high), "")


def _no_metal(modulus: Measured, strength: float) -> str:
    """Return why no metal has this modulus [Pa] at this strength [Pa], if so."""
    low, high = RULES.metal_moduli
    told = f"the curve rises with {modulus.value / 1e9:.3g} ± {modulus.std / 1e9:.2g} GPa"
    if modulus.std > RULES.own_error * modulus.value:
        return f"{told}: its elastic part is too short, bent or scattered"
    if not low <= modulus.value <= high:
        return f"{told}, as no engineering metal does"
    yields = strength / modulus.value
    if yields > RULES.elastic_strain:
        return f"{told} up to a strain of {yields:.2g}, as no metal does"
    return ""


def _strength(flow: MeasuredFlow, modulus: Measured) -> Measured:
    """Return the proof strength [Pa]: its error holds the modulus and how far rows lie apart."""
    after = min(int(np.searchsorted(flow.strain, PROOF_STRAIN)), flow.strain.size - 1)
    apart, wide = np.diff(flow.stress)[after - 1], np.diff(flow.strain)[after - 1]
    shift = flow.strength * modulus.std / modulus.value**2
    own = Measured(flow.strength, 0.02 * flow.strength)
    return own.widened(0.25 * apart).widened(apart / wide * min(shift, wide))


def _rows(plastic: Array, stress: Array, source: str) -> MeasuredFlow:
    """Thin the curve out to rows that increase, from the first plastic strain of 0 on."""
    largest = float(plastic.max())
    if not largest > 2.0 * PROOF_STRAIN:
        raise InputError(
            f"a plastic strain of {largest:.2g} at the most", source=source,
            allowed=f"a test beyond {2.0 * PROOF_STRAIN:g}",
        )  # fmt: skip
    # what scatters about the elastic line belongs to it; a gauge that came off at the end does not
    elastic = np.flatnonzero(plastic[: int(plastic.argmax())] <= CORE.strain_seen)
    begin = int(elastic[-1]) + 1 if elastic.size else 0
    plastic, stress = plastic[begin:], stress[begin:]
    edges = np.geomspace(CORE.strain_seen, largest, _TENSION_KEPT)
    means = [
        (float(np.mean(plastic[there])), float(np.median(stress[there])))
        for low, high in pairwise(edges)
        if (there := (plastic > low) & (plastic <= high)).any()
    ]
    strain, flow = np.array(means).T
    if strain.size > 1 and strain[-1] < largest:  # the last rows' middle is not the curve's end
        last = stress[plastic > edges[np.searchsorted(edges, strain[-1]) - 1]]
        ahead = (largest - strain[-1]) / (strain[-1] - strain[-2])
        end = np.clip(flow[-1] + ahead * (flow[-1] - flow[-2]), last.min(), last.max())
        strain, flow = np.append(strain, largest), np.append(flow, end)
    nothing = np.full(strain.size + 1, np.nan)
    return MeasuredFlow(np.append(0.0, strain), np.append(flow[0], flow), nothing, nothing)
