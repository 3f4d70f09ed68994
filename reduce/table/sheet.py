"""A laboratory's sheet: a row a drop, headers in its own words, units in headers or cells.

Every column and every cell that is not taken is told: nothing disappears without a line.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ...core.errors import InputError, InputErrors
from ...core.inputs.input_file import checked_file
from ...core.processes.confined import confined
from ...recordings.columns import MEASURED
from ..bounces.options import GRAVITY
from ..measured import Measured, Trial
from ..reduced import Reduced
from ..rules import RULES
from ..units import UNITS
from .cells import plain, value_of
from .file import BOOKS, cells_of, text_lines
from .heading import in_short, is_unit
from .picture import draw_trials
from .trials import TrialsReduction
from .workbook import workbook_rows

_APPROACH = ("drop_height_m", "impact_speed_m_s")
_REBOUND = REBOUND_HEIGHT, REBOUND_SPEED = "rebound_height", "rebound_speed"


class _Kind(NamedTuple):
    """What a column may become: name, quantity of its unit, and the words that say so."""

    name: str
    quantity: str
    words: str


_IN = r"( in \S+)?"  # a unit that follows the name

# The first kind whose words a header holds; accents are taken off before. English, German, French,
# Italian, Spanish.
_KINDS = (
    _Kind("note", "text",
          r"note|remark|comment|bemerkung|kommentar|anmerkung|remarque|osservazion"),
    _Kind("person", "text",
          r"operator|observer|experimenter|student|(measured|tested|done) by|prufer|bediener|"
          r"operateur|operatore|operador"),
    _Kind("temperature_K", "temperature", r"temperatur"),
    _Kind("angle_deg", "angle", r"angle|winkel|angolo|angulo"),
    _Kind("restitution", "number", r"restitution|^e$|^cor$|stoss?zahl|restituzion|restitucion"),
    _Kind(REBOUND_HEIGHT, "length",
          r"(rebound|bounce|ruckprall|rucksprung|abprall|rebond|rimbalzo|rebote).*"
          r"(height|hohe|^h|hauteur|altezza|altura)|ruckprallhohe|rucksprunghohe|sprunghohe|"
          r"(hauteur|altezza|altura) d[ei]l? ?(rebond|rimbalzo|rebote)"),
    _Kind(REBOUND_SPEED, "speed",
          r"(rebound|ruckprall|rucksprung|rebond|rimbalzo|rebote).*(speed|veloc|geschw|vitesse)"),
    _Kind("drop_height_m", "length",
          r"(drop|fall|release|chute|caduta|caida).*(height|hohe|hauteur|altezza|altura)|fallhohe|"
          r"(hauteur|altezza|altura) (de|di) (chute|caduta|caida)|height of fall|^drop$|"
          rf"^(h|height|hohe|hauteur|altezza|altura){_IN}$"),
    _Kind("impact_speed_m_s", "speed",
          r"(impact|approach|auf(prall|treff)|stoss?).*(speed|veloc|geschw)|vitesse d.?impact|"
          r"velocita d.?impatto|velocidad de impacto|"
          rf"^(v|speed|velocity|geschwindigkeit|vitesse|velocita|velocidad){_IN}$"),
    _Kind("dent_diameter_m", "length",
          r"(dent|crater|indent|imprint|impression|eindruck|krater|delle|empreinte|impronta|huella)"
          r".*(diam|durchm|ø|⌀|dm\b|wid|breit)|durchmesser (des|der) (eindruck|krater|delle)|"
          r"diametr?[eo]? .*(empreinte|impronta|huella)"),
    _Kind("permanent_depth_m", "length",
          r"(dent|crater|indent|residual|permanent|eindruck|krater|delle).*(depth|tiefe)|"
          r"eindring(tiefe|ung)|profond|profund"),
    _Kind("contact_time_s", "time",
          r"(contact|kontakt|stoss?|impact).*(time|duration|zeit|dauer)|duree|durata|duracion"),
    _Kind("peak_force_N", "force",
          r"(peak|max|stoss?|impact|spitzen).*(force|kraft|forza|fuerza)|maximalkraft"),
    _Kind("trial", "text",
          r"^(nr|no|num|number|test|trial|versuch|messung|probe|shot|run|id|drop no|essai|prova|"
          r"ensayo|#)\b"),
)  # fmt: skip

_UNIT_AT_END = re.compile(
    r"[\[(,/]\s*(?P<a>[^\])(\[,/]{1,6}(?:/s|/sec)?)\s*[\])]?\s*$|\bin (?P<b>\S{1,4})$"
)
_CELL = re.compile(r"(?P<number>[+-]?[\d.,'’  ]*\d(?:[eE][+-]?\d+)?)\s*(?P<unit>[^\d\s].{0,5})?")
_GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}([.,]\d{3})+")
"""What may be thousands or a number with three decimals: 1.000."""
_DECIMAL = re.compile(r"[+-]?\d+([.,])(\d{1,2}|\d{4,})(?!\d)|[+-]?0([.,])\d+")
_SUMMARY = re.compile(
    r"(mean|average|avg|median|std|s\.?d|standard ?dev\w*|minimum|maximum|min|max|sum|total|"
    r"mittel|mittelwert|mw|stdabw|standardabw\w*|streuung|summe|moyenne|ecart[- ]?type|media|"
    r"promedio|desviacion\w*|deviazione\w*)( (value|wert)| \(.*\))?"
)
"""A row that says something of other rows."""
_CELSIUS, _ICE = ("°C", "C", "degC"), 273.15


@dataclass(frozen=True)
class Sheet:
    """What a sheet became.

    Parameters
    ----------
    trials
        Its rows.
    columns
        Of each column of the sheet its header and what became of it, in words.
    left_out
        Cells and rows that were not taken, a line each.
    """

    trials: tuple[Trial, ...]
    columns: tuple[tuple[str, str], ...]
    left_out: tuple[str, ...]

    def reduced(self, path: Path) -> Reduced:
        """Return it as what every reduction hands on."""
        notes = (*(f"{header!r}: {became}" for header, became in self.columns), *self.left_out)
        seen = self.trials[0].observables
        across = next(n for n in _APPROACH if n in seen)
        up = next(n for n in seen if n in MEASURED)
        x, y = (
            np.array(
                [t.observables[n].value if n in t.observables else np.nan for t in self.trials]
            )
            for n in (across, up)
        )
        values = {"trials": Measured(float(len(self.trials)), math.nan)}
        found = TrialsReduction(values, self.trials, notes, (across, x), (up, y))
        return Reduced(path, values, self.trials, lambda to: draw_trials(found, to), notes)


@dataclass
class _Column:
    place: int
    header: str
    kind: _Kind
    unit: str | None
    taken: int = 0
    unitless: bool = False


def read_sheet(path: Path, *, sheet: str = "") -> Sheet:
    """Read a laboratory's sheet.

    Drop and rebound height give the restitution, the root of their ratio, and one in a column of
    its own says the same once more; a drop height that is written once for several rows holds for
    the rows below; several columns of one quantity are repeats, each a row of its own.

    Parameters
    ----------
    path
        A workbook, or a text table in any usual encoding.
    sheet
        Of a workbook; the first by default.

    Raises
    ------
    InputError
        No row of headers is understood, or a column names no unit.
    """
    checked_file(path, most=RULES.table_bytes, allowed="a sheet")
    if path.suffix.lower() in BOOKS:
        rows = confined(workbook_rows, path, sheet, source=str(path))
    else:
        rows = _cells(text_lines(path.read_bytes(), str(path)), str(path))
    top, columns, told = _headers(rows, str(path))
    return _trials(rows, top, columns, told, str(path))


def _cells(lines: Sequence[str], source: str) -> list[list[str]]:
    """Cells of a text table; units in the cells hide its separator from a guess by numbers."""
    _, rows = cells_of(lines, source)
    for separator in (";", "\t", ","):
        if max(_understood(rows), default=0) < 2:
            _, rows = cells_of(lines, source, separator=separator)
    return rows


def _understood(rows: Sequence[Sequence[str]]) -> list[int]:
    """How many headers are understood in each of the first rows, below their titles."""
    heads = (_under_titles(rows, k) for k in range(len(rows[:40])))
    return [sum(_kind_of(cell) is not None for cell in head) for head in heads]


def _bare(text: str) -> str:
    """A header in small letters without accents, signs and line ends."""
    spread = unicodedata.normalize("NFKD", text.lower().replace("ß", "ss"))
    return " ".join("".join(c for c in spread if not unicodedata.combining(c)).split())


def _kind_of(header: str) -> _Kind | None:
    bare = _bare(re.sub(r"[\[(].*", "", header)).strip(" .:")
    return next((kind for kind in _KINDS if re.search(kind.words, bare)), None) if bare else None


def _headers(
    rows: Sequence[Sequence[str]], source: str
) -> tuple[int, list[_Column], list[tuple[str, str]]]:
    """The first row below the headers, the columns that are understood, and the others."""
    known = _understood(rows)
    best = max(range(len(known)), key=lambda k: known[k], default=0)
    if not known or known[best] < 2:
        raise InputError(
            "no row of headers is understood", source=source,
            allowed="columns such as drop height (cm), rebound height (mm), dent diameter (mm)",
        )  # fmt: skip
    head, top = _under_titles(rows, best), best + 1
    below = list(rows[top]) if top < len(rows) else []
    filled = [cell for cell in below if cell]
    if filled and all(is_unit(cell) or cell.strip("()[] ") in _CELSIUS for cell in filled):
        pairs = zip(head, [*below, *[""] * len(head)], strict=False)
        head, top = [f"{h} ({u.strip('()[] ')})" if u else h for h, u in pairs], top + 1
    columns = []
    told = [
        (" ".join(filter(None, row)), f"row {k}, left out: above the headers")
        for k, row in enumerate(rows[:best], start=1)
        if any(row) and (k < best or head == list(rows[best]))
    ]
    for place, header in enumerate(head):
        kind = _kind_of(header)
        if kind is None:
            if header or any(place < len(row) and row[place] for row in rows[top:]):
                told.append((header or f"column {place + 1}", "left out: not understood"))
            continue
        columns.append(_Column(place, header, kind, _unit(header, kind)))
    return top, columns, told


def _under_titles(rows: Sequence[Sequence[str]], best: int) -> list[str]:
    """The row of headers, each below the title of its columns where the row above holds titles."""
    head = list(rows[best])
    above = list(rows[best - 1])[: len(head)] if best else []
    if sum(map(bool, above)) < 2 or any(map(is_unit, filter(None, above))):
        return head
    title = ""
    for k, own in enumerate([*above, *[""] * (len(head) - len(above))]):
        title = own or title
        joined = f"{title} {head[k]}"
        # a title that spans several columns stands over the first of them alone
        alone = not own and _kind_of(head[k]) is not None
        if head[k] and title and not alone and _kind_of(joined) is not None:
            head[k] = joined
    return head


def _unit(header: str, kind: _Kind) -> str | None:
    """The unit in a header; None where it names none."""
    if kind.quantity in ("text", "number"):
        return "%" if "%" in header else ""
    found = _UNIT_AT_END.search(header.strip())
    said = in_short((found["a"] or found["b"]).strip()) if found else ""
    known = said in UNITS[kind.quantity] or (kind.quantity == "temperature" and said in _CELSIUS)
    return said if known else None


def _trials(
    rows: Sequence[Sequence[str]], top: int, columns: list[_Column],
    told: list[tuple[str, str]], source: str,
) -> Sheet:  # fmt: skip
    left: list[str] = []
    trials: list[Trial] = []
    last: dict[str, float] = {}
    from_above: list[str] = []
    across: list[str] = []
    decimals = _decimals(rows[top:], columns)
    for k, row in enumerate(rows[top:], start=top + 1):
        if not any(row):
            continue
        if summary := _summary(row, columns):
            left.append(f"row {k}: left out, {summary!r} sums up other rows")
            continue
        found, note, unread = _read(row, k, columns, decimals, left)
        if not found and not unread:
            left.append(f"row {k}: left out: {' '.join(filter(None, row))}")
            continue
        last = {name: found[name][0] for name in _APPROACH if name in found} or last
        if unread and not any(name in found for name in _APPROACH):
            left.append(f"row {k}: left out, its drop height or speed is not read")
            continue
        stated = last.keys() & found.keys()
        if not found.keys() - {*_APPROACH, "temperature_K", "angle_deg"}:
            left.append(f"row {k}: nothing measured")
            continue
        if not last:
            left.append(f"row {k}: no drop height or speed")
            continue
        from_above += [] if stated else [str(k)]
        back, crossed = _restitutions(found, last)
        trials += _of_row(found | {"restitution": back}, last, note, k)
        across += [str(k)] if crossed else []
    wrong = tuple(
        InputError(
            "the header names no unit", source=source, key=c.header,
            allowed=", ".join(UNITS[c.kind.quantity]),
        )
        for c in columns
        if c.unitless
    )  # fmt: skip
    if wrong:
        raise InputErrors(wrong)
    if not trials:
        raise InputError(
            "no row with an approach and something measured", source=source,
            allowed=left[0] if left else "a row a drop",
        )  # fmt: skip
    if from_above:
        left.append(f"row {', '.join(from_above)}: the approach is that of the row above")
    if across:
        left.append(f"row {', '.join(across)}: restitution with v^2 = 2 g h, g = {GRAVITY} m/s^2")
    told = [(c.header, _became(c)) for c in columns] + told
    return Sheet(tuple(trials), tuple(told), tuple(left))


def _summary(row: Sequence[str], columns: Sequence[_Column]) -> str:
    """The cell that says that a row sums up others; a note may say of itself what it likes."""
    kinds = {c.place: c.kind.name for c in columns}
    for place, cell in enumerate(row):
        word, kind = _bare(cell).strip(" .:"), kinds.get(place)
        someone = kind == "person" and word in ("max", "min")
        if kind != "note" and not someone and _SUMMARY.fullmatch(word):
            return cell
    return ""


def _read(
    row: Sequence[str], k: int, columns: Sequence[_Column], decimals: str, left: list[str]
) -> tuple[dict[str, list[float]], str, bool]:
    """Numbers of a row by kind, its note, and whether an approach is written but not read."""
    found: dict[str, list[float]] = {}
    note, unread = "", False
    for column in columns:
        cell = row[column.place].strip() if column.place < len(row) else ""
        if not cell:
            continue
        if column.kind.quantity == "text":
            note = f"{note}; {cell}".strip("; ") if column.kind.name == "note" else note
            column.taken += 1
            continue
        value = _value(cell, column, decimals)
        approach = column.kind.name in _APPROACH
        low = value is not None and (
            value <= 0.0 if approach else value < 0.0 and column.kind.name in _REBOUND
        )
        unread |= approach and (low or value is None)
        if low:
            left.append(f"row {k}, {column.header}: {cell!r} is too little")
        elif value is not None:
            column.taken += 1
            found.setdefault(column.kind.name, []).append(value)
        elif decimals == "" and _grouped(cell):
            left.append(f"row {k}, {column.header}: {cell!r}: of thousands, or of decimals?")
        else:
            left.append(f"row {k}, {column.header}: {cell!r} is no {column.kind.quantity}")
    return found, note, unread


def _decimals(rows: Sequence[Sequence[str]], columns: Sequence[_Column]) -> str:
    """The sign before the decimals in the sheet's numbers; empty where none, or both, show it."""
    cells = (
        _CELL.fullmatch(row[c.place].strip()) for row in rows for c in columns
        if c.place < len(row) and c.kind.quantity != "text"
    )  # fmt: skip
    numbers = (found["number"].strip() for found in cells if found)
    signs = {m[1] or m[3] for m in map(_DECIMAL.fullmatch, numbers) if m}
    return signs.pop() if len(signs) == 1 else ""


def _grouped(cell: str) -> bool:
    found = _CELL.fullmatch(cell)
    return found is not None and _GROUPED.fullmatch(found["number"].strip()) is not None


def _value(cell: str, column: _Column, decimals: str) -> float | None:
    """The number in a cell in the SI, by its own unit or the column's; None where it is none.

    1.000 is a thousand where other cells have decimal commas, and no number where none has any.
    """
    found = _CELL.fullmatch(cell)
    if found is None:
        return None
    text = found["number"].strip()
    if _grouped(cell) and decimals not in text:
        text = re.sub("[.,]", "", text)
    elif _grouped(cell) and not decimals:
        return None
    number = value_of(plain(text, ";"))
    own = in_short(found["unit"].strip()) if found["unit"] else ""
    if math.isnan(number):
        return None
    unit = own or column.unit
    if unit is None:
        column.unitless = True
        return None
    if column.kind.quantity == "temperature" and unit in _CELSIUS:
        return number + _ICE
    size = UNITS[column.kind.quantity].get(unit)
    return None if size is None else number * size


def _became(column: _Column) -> str:
    name = column.kind.name
    words = {
        REBOUND_HEIGHT: "restitution, the root of rebound over drop height",
        REBOUND_SPEED: "restitution, over the impact speed", "trial": "left out: rows are numbered",
        "person": "left out: who measured",
    }  # fmt: skip
    return f"{words.get(name, name)} ({column.taken} cells)"


def _of_row(
    found: dict[str, list[float]], last: dict[str, float], note: str, row: int
) -> Iterator[Trial]:
    """Yield the trials of one row: one, or as many as there are repeats."""
    common = {
        k: Measured(v[0], 0.0) for k, v in found.items() if k in ("temperature_K", "angle_deg")
    }
    other = {*common, *last, *_REBOUND}
    measured = {k: v for k, v in found.items() if v and k not in other}
    for k in range(max(map(len, measured.values()), default=0)):
        seen = {n: Measured(v[k], 0.0) for n, v in measured.items() if k < len(v)}
        label = f"{row:03d}" if max(map(len, measured.values())) == 1 else f"{row:03d}-{k + 1}"
        approach = {name: Measured(x, 0.0) for name, x in last.items()}
        yield Trial({**approach, **common, **seen}, label=label, note=note)


def _restitutions(
    found: dict[str, list[float]], last: dict[str, float]
) -> tuple[list[float], bool]:
    """What a row says of the restitution, and whether it takes v^2 = 2 g h.

    Of a rebound that is told more than once like over like comes first: what a sheet works out
    itself comes from the same heights or speeds.
    """
    fallen, speed = (last.get(name) for name in _APPROACH)
    heights, speeds = (found.get(name, []) for name in _REBOUND)
    if fallen and heights:
        return [math.sqrt(h / fallen) for h in heights], False
    if speed and speeds:
        return [v / speed for v in speeds], False
    if own := found.get("restitution", []):
        return own, False
    if speed:
        return [math.sqrt(2.0 * GRAVITY * h) / speed for h in heights], bool(heights)
    if fallen:
        return [v / math.sqrt(2.0 * GRAVITY * fallen) for v in speeds], bool(speeds)
    return [], False
