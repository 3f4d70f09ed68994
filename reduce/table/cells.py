"""Cells of a table: numbers as instruments, spreadsheets and languages write them, and clocks.

| cell | is |
| --- | --- |
| `1 234,5`, `1.234,5`, `1'234.5`, `"1,234.5"` | a number with separators of thousands |
| `0,25` where commas do not separate, or are quoted | a number |
| `1.234D-03`, `1,234E-03` | a number with an exponent, of Fortran too |
| `12:04:26.746`, `04:26.7`, `2024-05-17T12:04:26.746Z`, `17.05.24 12:04:26` | an instant |
| `OL`, `∞`, `******`, `#N/A`, `NaN`, 9.9e37 | no number: out of range, or not measured |
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from datetime import date

import numpy as np

from ...core.arrays import Array
from ...core.inputs.csv_table import number

OUT_OF_RANGE = 9.8e37
"""Instruments that speak SCPI write 9.9e37 for more than they can show (SCPI-1999, 7.2.1)."""

UNSEEN = ("", "nan", "-", "na")
"""What stands for a point that was not seen, in small letters."""

_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+([eEdD][+-]?\d+)?")
_COUNT = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+")
_THOUSANDS = (
    (re.compile(r"[+-]?\d{1,3}([ \u00a0\u2009\u202f'’]\d{3})+([.,]\d+)?"), " \u00a0\u2009\u202f'’"),
    (re.compile(r"[+-]?\d{1,3}(\.\d{3})+,\d+"), "."),
    (re.compile(r"[+-]?\d{1,3}(,\d{3})+\.\d+"), ","),
)
_SEPARATORS = re.compile("[, \u00a0\u2009\u202f'’]")
"""Without one of them a number is plain."""
_CLOCK = re.compile(
    r"(?:(?P<date>\d{4}[-/.]\d{1,2}[-/.]\d{1,2}|\d{1,2}[./]\d{1,2}[./]\d{2}(?:\d{2})?"
    r"|\d{1,2}[- ](?:Jan|Feb|Mar|Apr|May|Jun|Jul|Aug|Sep|Oct|Nov|Dec)[- ]\d{4})[T ,]\s*)?"
    r"(?P<h>\d{1,2}):(?P<m>\d{2})(?::(?P<s>\d{2}(?:[.,:]\d+)?))?\s*(?P<half>[AaPp][Mm])?"
    r"(?:Z|[+-]\d{2}:?\d{2})?"
)
_MINUTES = re.compile(r"\d{1,2}:\d{2}[.,]\d+")
DAY = 86400.0
"""In seconds."""


def plain(cell: str, separator: str) -> str:
    """Return a number with a decimal point and without separators of thousands.

    `cell`: as the file has it; `separator`: of the file's cells; where it is a comma, a comma in a
    cell separates thousands.

    Examples
    --------
    >>> [plain(c, ";") for c in ("0,25", "1.234,5", "1 234,5", "left")]
    ['0.25', '1234.5', '1234.5', 'left']
    """
    if not _SEPARATORS.search(cell):
        return cell
    for form, dividers in _THOUSANDS:
        if form.fullmatch(cell):
            for divider in dividers:
                cell = cell.replace(divider, "")
            return cell.replace(",", ".")
    if separator != "," and _DECIMAL_COMMA.fullmatch(cell):
        return cell.replace(",", ".")
    return cell


def commas_between(cells: Iterable[str], separator: str) -> str:
    """Return what `plain` takes for the separator: of quoted decimal commas between commas `;`.

    Quoted commas are decimal where one of them can part no thousands.

    Examples
    --------
    >>> commas_between(["0,25", "1,234"], ","), commas_between(["1,234", "0.5"], ",")
    (';', ',')
    """
    if separator != ",":
        return separator
    quoted = (c for c in cells if "," in c and _DECIMAL_COMMA.fullmatch(c))
    return "," if all(map(_COUNT.fullmatch, quoted)) else ";"


def value_of(cell: str) -> float:
    """Return the number in a cell, NaN for what is none or stands for 'out of range'."""
    found = number(cell)
    return found if abs(found) < OUT_OF_RANGE else np.nan


def instant(cell: str, since: float = 0.0) -> float:
    """Return an instant in seconds from midnight, or from the year 1 where a date stands before.

    Minutes and seconds with a fraction count from the hour. NaN for what is no clock; `since` a
    number of days, of both, fewer.

    Examples
    --------
    >>> instant("12:04:26.746")
    43466.746
    """
    found = _CLOCK.fullmatch(f"00:{cell}" if _MINUTES.fullmatch(cell) else cell)
    if found is None:
        return np.nan
    hour, minute = int(found["h"]), int(found["m"])
    second = float((found["s"] or "0").replace(",", ".").replace(":", "."))
    if found["half"]:
        hour = hour % 12 + 12 * (found["half"].lower() == "pm")
    if hour > 23 or minute > 59 or second >= 61.0:
        return np.nan
    return (_days(found["date"]) - since) * DAY + 3600.0 * hour + 60.0 * minute + second


def _days(day: str | None) -> float:
    if day is None:
        return 0.0
    months = "JanFebMarAprMayJunJulAugSepOctNovDec"
    parts = [int(p) if p.isdigit() else 1 + months.index(p) // 3 for p in re.split(r"[-/. ]", day)]
    if parts[-1] < 100 and parts[0] < 1000:
        parts[-1] += 2000
    if parts[0] < 1000:  # day first, as where points separate; month first where it must be
        parts = [parts[2], *((parts[1], parts[0]) if parts[1] <= 12 else (parts[0], parts[1]))]
    try:
        return float(date(*parts).toordinal())
    except ValueError:
        return np.nan


def since_first(instants: Array) -> Array:
    """Return instants as seconds after the first one; a clock without a date passes midnight."""
    known = np.flatnonzero(np.isfinite(instants))
    if known.size == 0:
        return instants
    after: Array = instants - instants[known[0]]
    if np.nanmax(np.abs(instants)) <= DAY:
        after[known] += DAY * np.cumsum(np.diff(after[known], prepend=0.0) < -0.5 * DAY)
    return after
