"""What stands above the numbers of a table: names, units, and what a header says of the record."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from ...core.errors import InputError
from ..shared.units import UNITS

# limit: lines above the numbers among which units are looked for [-]; headers of five
# oscilloscopes
_LINES_ABOVE = 4

_KNOWN_UNITS = {unit for units in UNITS.values() for unit in units if unit} | {"V", "mV", "px"}
_CAPITALS = {unit.upper(): unit for unit in sorted(_KNOWN_UNITS, reverse=True)}
_BRACKETED = re.compile(r"[\[(<]\s*([^\])>]+?)\s*[\])>]")
_AT_END = re.compile(r"(\S+?)\s*(?:[/,\n]|\bin\b)\s*([^\s/,]+(?:/[^\s/,]+)?)\s*$")
_WITHIN = re.compile(r"\s*[,;:=]\s*|\s+(?=[\d.+-])|(?<=\d)\s+")
"""Between name, number and unit of a header line that is one cell."""
WORDS = {
    "sec": "s", "secs": "s", "second": "s", "seconds": "s", "newton": "N", "newtons": "N",
    "volt": "V", "volts": "V", "metre": "m", "metres": "m", "meter": "m", "meters": "m",
    "mm/mm": "-", "m/m": "-", "in/in": "-", "kilonewtons": "kN", "millimeters": "mm",
    "millimetres": "mm", "milliseconds": "ms", "pascal": "Pa", "degrees": "deg", "grad": "deg",
    "msec": "ms", "usec": "us", "µsec": "us", "microseconds": "us", "minutes": "min",
    "nsec": "ns", "lb": "lbf", "lbs": "lbf", "kp": "kgf", "g's": "g", "gn": "g", "g_n": "g",
    "m/s/s": "m/s2", "m/s**2": "m/s2", "m/sec2": "m/s2", "m/sec^2": "m/s2", "ms-2": "m/s2",
    "m s-2": "m/s2", "m s^-2": "m/s2", "m*s^-2": "m/s2", "m·s⁻²": "m/s2", "m s⁻²": "m/s2",
    "n/mm²": "N/mm2", "n/mm^2": "N/mm2", "lbs.": "lbf", "in.": "in", "s⁻¹": "1/s",
    "毫米": "mm", "厘米": "cm", "微米": "um", "米": "m", "毫秒": "ms", "微秒": "us", "秒": "s",
    "牛": "N", "千牛": "kN", "克": "g", "千克": "kg", "米/秒": "m/s", "度": "deg", "sek": "s",
}  # fmt: skip
"""Units in words, as they are written in a recording set."""


@dataclass(frozen=True)
class Heading:
    """Names of the columns, the unit in brackets where a line of its own gives it, and more.

    `said` is every header line of a name, a value and perhaps a unit; `step_s` the time between two
    rows, where the column of the time is empty [s]; `separator` that of the cells, where it is
    named.
    """

    names: tuple[str, ...] = ()
    said: tuple[tuple[str, ...], ...] = ()
    step_s: float | None = None
    separator: str = ""

    def quantity(self, word: str) -> tuple[float, str] | None:
        """Return number and unit of the first header line whose name begins with a word.

        Examples
        --------
        >>> Heading(said=(("Area: 38.2 mm2",),)).quantity("area")
        (38.2, 'mm2')
        """
        for line in self.said:
            name, *values = line if len(line) > 1 else _WITHIN.split(line[0])
            if name.lower().startswith(word) and values:
                try:
                    return float(values[0]), values[1] if len(values) > 1 else unit_in(name)
                except ValueError:
                    continue
        return None


def unit_in(name: str) -> str:
    """Return the unit that a column's name holds; of brackets any one word, else nothing.

    Examples
    --------
    >>> [unit_in(n) for n in ("x (mm)", "F / N", "F in kN", "t_ms", "a_m_s2", "T [s] (raw)", "F")]
    ['mm', 'N', 'kN', 'ms', 'm/s2', 's', '']
    """
    bracketed = [in_short(found) for found in _BRACKETED.findall(name)]
    if bracketed:
        known = [unit for unit in bracketed if unit in _KNOWN_UNITS]
        return known[-1] if known else bracketed[-1] if " " not in bracketed[-1] else ""
    found = _AT_END.search(name)
    if found is not None and in_short(found.group(2)) in _KNOWN_UNITS:
        return "" if found.group(1) in _KNOWN_UNITS else in_short(found.group(2))  # a speed, m/s
    parts = name.split("_")
    pair = in_short("/".join(parts[-2:]))  # a_m_s2, as a set names it
    if len(parts) > 2 and pair in _KNOWN_UNITS:
        return pair
    return in_short(parts[-1]) if len(parts) > 1 else ""


def heading_of(above: Sequence[Sequence[str]], width: int) -> Heading:
    """Return what the rows above the numbers say of `width` columns.

    The names are the nearest row above that is none of units and has more than one cell; units may
    stand in a row of their own, above or below the names.
    """
    # a marker that was not seen yet is no name
    rows = [list(row) for row in above if {cell.lower() for cell in row} - {"", "nan"}]
    units: list[str] = []
    for row in reversed(rows[-_LINES_ABOVE:]):
        filled = [cell for cell in row if cell]
        several = len(filled) > 1 or (row is rows[-1] and len(rows) > 1)
        if several and all(map(is_unit, filled)):
            units = row
            rows.remove(row)
            break
    head = next((r for r in reversed(rows) if len([c for c in r if c]) > 1 or width == 1), [])
    if units and head:
        padded = [*units, *[""] * len(head)]
        head = [
            f"{name} [{in_short(unit)}]" if unit else name
            for name, unit in zip(head, padded, strict=False)
        ]
    head = head or units
    said = tuple(tuple(c for c in r if c) for r in rows if r is not head and any(r))
    return Heading(tuple((list(head) + [""] * width)[:width]), said)


def is_unit(cell: str) -> bool:
    """Whether a cell names a unit, `mm`, `(mm)` or `[mm]`."""
    bare, whole = cell.strip("()[] "), cell.strip()
    return in_short(bare) in _KNOWN_UNITS or (whole[:1] in ("(", "[") and len(bare) < 12)


def in_short(unit: str) -> str:
    """Return a unit as it is written in a recording set.

    Examples
    --------
    >>> in_short("(sec)"), in_short("[mm]")
    ('s', 'mm')
    """
    bare = unit.strip("()[] ").replace("Â", "")  # what UTF-8 leaves of µ and ° when read otherwise
    if bare in _KNOWN_UNITS:
        return bare
    return WORDS.get(bare.lower(), _CAPITALS.get(bare, bare))


_END = "***End_of_Header***"


def labview_rows(
    lines: Sequence[str], segment: str = "", source: str = ""
) -> tuple[list[str], Heading] | None:
    """Return the rows below the headers of a LabVIEW measurement (LVM), and its heading.

    Where the first cell of a row is blank, or its times are rounded to the same ones, the header's
    `Delta_X` is the time between two rows. None for the lines of any other file; refuses several
    segments of which none is named, by its number from 1.
    """
    if not lines or not lines[0].startswith("LabVIEW Measurement"):
        return None
    ends = [k for k, line in enumerate(lines) if line.startswith(_END)]
    if not ends or ends[-1] + 1 >= len(lines):
        return None
    if len(ends) > 2:  # each has a header of its own
        which = int(segment) if segment.isdecimal() else 0
        if not 0 < which < len(ends):
            raise InputError(
                f"{len(ends) - 1} segments", source=source, key="sheet",
                allowed=f"1 to {len(ends) - 1}",
            )  # fmt: skip
        ends = [ends[0], ends[which]]
        last = (k for k in range(ends[1], len(lines)) if lines[k].startswith("Channels"))
        lines = lines[: next(last, len(lines))]
    # the line that names the separator has it
    named = (line[len("Separator") :][:1] for line in lines if line.startswith("Separator"))
    between = next(named, "") or "\t"
    said: dict[str, list[str]] = {}
    for line in lines[: ends[-1]]:
        name, *values = [cell.strip() for cell in line.split(between)]
        if values:
            said[name] = [v for v in values if v]
    names = [cell.strip() for cell in lines[ends[-1] + 1].split(between)]
    seconds = said.get("X_Dimension", ["Time"])[0] == "Time"
    first = "X_Value [s]" if seconds else "X_Value"
    each = iter(said.get("Y_Unit_Label", []))
    told = [first]  # of each channel where there are several
    for name in (n for n in names[1:] if n and n != "Comment"):
        unit = "" if name == "X_Value" else next(each, "")
        told.append(first if name == "X_Value" else f"{name} [{in_short(unit)}]" if unit else name)
    step = float(said["Delta_X"][0].replace(",", ".")) if said.get("Delta_X") else None
    return list(lines[ends[-1] + 2 :]), Heading(tuple(told), (), step, between)
