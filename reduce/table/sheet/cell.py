"""What a cell of a laboratory's sheet says: a number, its standard deviation, its own unit."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from statistics import median

from ....recordings.columns import CONDITIONS, MEASURED
from ...measured import Measured
from ...shared.units import UNITS, ZERO
from ..cells import plain, value_of
from ..heading import in_short
from ..workbook import NumberCell
from .headers import SheetColumn
from .words import SIGNED

_CELL = re.compile(
    r"(?P<number>[+-]?[\d.,'’ ]*\d(?:[eEdD][+-]?\d+)?)"
    r"(\s*(±|\+/-|\+-)\s*(?P<std>[\d.,]+))?\s*(?P<unit>[^\d\s].{0,5})?"
)
_GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}([.,]\d{3})+")
"""What may be thousands or a number with three decimals: 1.000."""
_MILLIONS = re.compile(r"[+-]?\d{1,3}([.,]\d{3}){2,}")
_LONG = re.compile(r"[1-9]\d{3,}")
"""Of one who writes no separators of thousands."""
_DECIMAL = re.compile(
    r"[+-]?\d+(?P<a>[.,])(\d{1,2}|\d{4,})(?!\d)|[+-]?0(?P<b>[.,])\d+"
    r"|[+-]?\d{1,3}(?:(,\d{3})+(?P<c>\.)|(\.\d{3})+(?P<d>,))\d+"
)


def why_not(cell: str, column: SheetColumn, value: Measured | None, decimals: str) -> str:
    """Return why a cell is not taken; empty where it is."""
    if value is None:
        if not (column.decimals or decimals) and _grouped(cell):
            number = _number_of(cell)
            other = "" if _MILLIONS.fullmatch(number) else f", or {number}0"
            whole = re.sub("[.,]", "", number)
            return f"{cell!r}: of thousands, or of decimals? write {whole}{other}"
        return f"{cell!r} is no {column.kind.quantity}"
    if column.unit == "%" and not column.spread and 0.0 < value.value <= 0.01 and "%" not in cell:
        return f"{cell!r}: a part of 1, or of 100?"
    name = column.kind.name
    rule = (CONDITIONS | MEASURED).get(name)
    if value.value < 0.0 if column.spread or rule is None else not rule.accepts(value.value):
        return f"{cell!r} is too {'little' if rule is None or value.value <= rule.low else 'much'}"
    return ""


def decimals_of(
    rows: Sequence[Sequence[str]], columns: Sequence[SheetColumn], between: str = ""
) -> str:
    """Return the sign before the decimals of a sheet's numbers; empty if none, or both, show it.

    Of both each column keeps what its own numbers show, as 0,670 and 0.797 do, but not 1,234.5.
    Where all may be of thousands, in a column that has no other numbers a comma is that sign
    `between` whose cells are semicolons, and each sign is, beside one such as 3000 without.
    """
    measured = [c for c in columns if c.kind.quantity != "text"]
    each = [[n for row in rows if (n := _number_of(row[c.place]))] for c in measured]
    every = [n for numbers in each for n in numbers]
    shown = [
        {m["a"] or m["b"] or m["c"] or m["d"] for m in map(_DECIMAL.fullmatch, numbers) if m}
        for numbers in each
    ]
    signs = set[str]().union(*shown)
    for column, own, numbers in zip(measured, shown, each, strict=True):
        parted = len(own) > 1 and any({".", ","} <= {*n} for n in numbers)
        column.decimals = "".join(own) * (len(signs) > 1 and not parted)
    if not signs and not any(_MILLIONS.fullmatch(n) for n in every):
        alike = any(_LONG.fullmatch(n) for n in every)
        for numbers in each:
            seen = {n[-4] if _GROUPED.fullmatch(n) else "" for n in numbers}
            if len(seen) == 1 and (alike or (seen == {","} and between == ";")):
                signs |= seen
        signs.discard("")
    return signs.pop() if len(signs) == 1 else ""


def _number_of(cell: str) -> str:
    """What a cell has of a number as text."""
    found = None if isinstance(cell, NumberCell) else _CELL.fullmatch(cell)
    return found["number"].strip() if found else ""


def _grouped(cell: str) -> bool:
    return _GROUPED.fullmatch(_number_of(cell)) is not None


def number_in(cell: str, column: SheetColumn, decimals: str) -> Measured | None:
    """Return the number in a cell in the SI, by its own unit or the column's; None if it is none.

    1.000 is a thousand where other cells have decimal commas, and no number where none has any.
    """
    found = _CELL.fullmatch(cell)
    if found is None:
        return None
    text = found["number"].strip()
    if _grouped(cell):
        if not (signs := column.decimals or decimals):
            return None
        if not {*signs} & {*text}:
            text = re.sub("[.,]", "", text)
    number, std = value_of(plain(text, ";")), value_of(plain(found["std"] or "0", ";"))
    own = in_short(found["unit"].strip()) if found["unit"] else ""
    if math.isnan(number) or math.isnan(std):
        return None
    unit = own or column.unit
    if unit is None:
        column.unitless = True
        return None
    if (size := UNITS[column.kind.quantity].get(unit)) is None:
        return None
    zero = 0.0 if column.spread else ZERO.get(unit, 0.0)
    return Measured(column.sign * number + zero, std).scaled(size)


def turn_signs(rows: Sequence[Sequence[str]], columns: Sequence[SheetColumn], sheet: str) -> None:
    """Count downward speeds, and forces of compression, as above zero where most are below it."""
    for column in columns:
        if column.kind.name in SIGNED and not column.spread:
            seen = (number_in(row[column.place], column, sheet) for row in rows)
            if (numbers := [v.value for v in seen if v]) and median(numbers) < 0.0:
                column.sign = -1.0
            column.unitless = False  # only rows that are taken ask for it
