"""What the columns of a laboratory's sheet are, by the words above them, in five languages."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from ....core.errors import InputError
from ....core.observables import LOAD
from ....recordings.columns import CONDITIONS
from ...shared.units import UNITS
from ..heading import in_short, is_unit

REBOUNDS = REBOUND_HEIGHT, REBOUND_SPEED = "rebound_height", "rebound_speed"
APPROACHES = ("drop_height_m", "impact_speed_m_s", LOAD)
CELSIUS = ("°C", "C", "degC")


class SheetKind(NamedTuple):
    """What a column may become: name, quantity of its unit, and the words that say so."""

    name: str
    quantity: str
    words: str


def _both(*words: str) -> str:
    """All of some words, in any order: the height of fall, the fall's height."""
    return "^" + "".join(f"(?=.*({one}))" for one in words)


_HEIGHT = r"height|hoe?he|hauteur|altezza|altura|\bh\b"
_SPEED = r"speed|veloc|geschw|vitesse"
_REBOUND = r"rebound|bounce|rue?ck(prall|sprung)|abprall|sprunghoe?he|rebond|rimbalzo|rebote"
_DENT = (
    r"\bdent|crater|indent(?!er|eur|ador|atore)|imprint|impression|eindruck|krater|delle|"
    r"empreinte|impronta|huella"
)
_BLOW = r"contact|kontakt|stoss|impact|beruhr|contatto"
_SINK = r"indent|eindring|penetr"

# The first kind whose words a header holds; accents are taken off before. English, German, French,
# Italian, Spanish.
_KINDS = (
    SheetKind("note", "text",
         r"note|remark|comment|bemerkung|kommentar|anmerkung|remarque|osservazion|observa[ct]ion"),
    SheetKind("person", "text",
         r"operator|observer|experimenter|student|(measured|tested|done) by|prue?fer|bediener|"
         r"operateur|operatore|operador"),
    SheetKind("temperature_K", "temperature", r"temperatur"),
    SheetKind("angle_deg", "angle",
         rf"^(?!.*({_REBOUND}|contact|kontakt|tilt|neigung)).*(angle|winkel|angolo|angulo)"),
    SheetKind("restitution", "number", r"restitu[tcz]ion|^e ?n? ?\d*$|^cor ?\d*$|stoss?zahl"),
    SheetKind(REBOUND_HEIGHT, "length",
         "^(?!.*(drop height|fallhoe?he))" + _both(_REBOUND, _HEIGHT)),
    SheetKind(REBOUND_SPEED, "speed",
         _both(rf"{_REBOUND}|\bafter\b|\bnach\b|\bapres\b|\bdopo\b|despues", _SPEED)),
    SheetKind("drop_height_m", "length",
         _both(r"drop|fall|release|chute|caduta|caida", _HEIGHT)
         + r"|^(h|height|hoe?he|hauteur|altezza|altura)$"),
    SheetKind("impact_speed_m_s", "speed",
         _both(r"impact|approach|(auf|an)prall|auftreff|stoss|impatto|before|\bvor\b|avant|prima|antes",
               _SPEED)
         + r"|^(v( ?n)?|speed|velocity|geschwindigkeit|vitesse|velocita|velocidad)$"),
    SheetKind("dent_diameter_m", "length",
         _both(_DENT, r"diam|durchm|ø|⌀|dm\b|wid|breit")),
    # the largest depth under load is not what stays
    SheetKind("permanent_depth_m", "length",
         rf"^(?!(?=.*\bmax)(?=.*({_SINK})))((?=.*({_DENT}|residual|permanent))(?=.*(depth|tiefe))|"
         r".*(eindring(tiefe|ung)|profond|profund))"),
    SheetKind("contact_time_s", "time",
         r"^(?!.*(between|zwischen|entre|time of|zeitpunkt))"
         + _both(_BLOW, r"time|duration|zeit|dauer|temps|tempo|tiempo") + "|duree|durata|duracion"),
    SheetKind("peak_force_N", "force",
         _both(r"peak|max|massim|spitze|stoss|impact", r"force|kraft|forza|fuerza")),
    SheetKind(LOAD, "force",
         r"^(load|last|charge|carico|carga)\b|test (force|load)|prue?f(kraft|last)"),
    SheetKind("trial", "text",
         r"^#|^(nr|no|num|number|test|trial|versuch|messung|probe|shot|run|id|drop no|essai|prova|"
         r"ensayo|lfd)\b|^drop$"),
)  # fmt: skip

_UNIT_WITHIN = re.compile(r"(?:[\[(]\s*(?:(?:in|en)\s)?|\b(?:in|en)\s)\s*([^\s\]),;]+)")
_UNITS = {unit for known in UNITS.values() for unit in known} | set(CELSIUS)
_UNIT_AT_END = re.compile(
    r"[\[(,/]\s*((in|en)\s+)?(?P<a>[^\])(\[,/]{1,6}(?:/s|/sec)?)\s*[\])]?\s*$"
    r"|\b(in|en) (?P<b>\S{1,4})$"
)
_MEANS = r"mean|average|avg|median|mittel\w*|mw|moyenne?|media|promedio"
_SPREADS = (
    r"std(\.? ?dev\w*)?|stdev|s\.?d|standard ?(dev|abw)\w*|stdabw|ecart[- ]?type|"
    r"desviacion\w*|deviazione\w*|streuung"
)
_ERRORS = (
    r"sem|sigma|σ|error|uncertainty|fehler|unsicherheit|erreur|incertitude|incertezza|incertidumbre"
)
SUMMARY = re.compile(
    rf"({_MEANS}|{_SPREADS}|minimum|maximum|min|max|sum|total|summe)( (value|wert)| \(.*\))?"
)
"""What says that a row sums up others."""
_MEAN = re.compile(rf"\b({_MEANS})\b")
_SPREAD = re.compile(rf"±|\+/-|\b({_SPREADS}|{_ERRORS})\b\.?")
_BESIDE = re.compile(r"(?<=\S)\s*(±|\+/-)\s*\w.*")
"""What stands behind a value in its own cell: mean ± SD."""
_NUMBER = re.compile(r"[+-]?\s*\d[\d.,' ]*\D{0,6}")
_ALONG = re.compile("tangent|horizont")
_RANGE = re.compile(r"\b(range|spannweite|varian[cz]\w*|varianza|cv|rsd)\b")
_LATER = re.compile(
    r"\b([2-9](nd|rd|th)|second[oa]?|third|fourth|zweite\w*|dritte\w*|deuxieme|troisieme|terz[oa]|"
    r"segund[oa]|tercer\w*)\b"
)
_NORMAL = re.compile(r"(from|to)( the)? (normal|vertical)|\blot\b|senkrecht")


@dataclass
class SheetColumn:
    """A column that is understood.

    Parameters
    ----------
    place
        In the row, from 0.
    header
        As the sheet has it.
    kind
        What it is.
    unit
        Of its numbers; None where the header names none.
    spread
        Whether it holds the standard deviations of a column to its left.
    taken
        Cells that were read.
    unitless
        Whether a cell asked for the unit.
    """

    place: int
    header: str
    kind: SheetKind
    unit: str | None
    spread: bool = False
    taken: int = 0
    unitless: bool = False

    @property
    def no_unit(self) -> str:
        """What is wrong with the header's unit."""
        said = _said_unit(self.header)
        return f"{said!r} is no unit of {self.kind.quantity} that is known" if said else (
            "the header names no unit"
        )  # fmt: skip


def bare(text: str) -> str:
    """Return a header in small letters without accents, signs and line ends."""
    spread = unicodedata.normalize("NFKD", text.lower().replace("ß", "ss"))
    return " ".join("".join(c for c in spread if not unicodedata.combining(c)).split())


def kind_of(header: str) -> SheetKind | None:
    """Return what a header says, None where it is not understood."""
    words = _named(header)
    found = next((kind for kind in _KINDS if re.search(kind.words, words)), None) if words else None
    if found is None or (found.quantity == "speed" and _ALONG.search(words)):
        return None
    if found.quantity != "text" and _RANGE.search(words):
        return None
    # E (J) is an energy, E (GPa) a modulus
    other = found.name == "restitution" and len(words) == 1 and _said_unit(header) not in _RATIOS
    return None if other else found


def _named(header: str) -> str:
    """The words of a header that name a quantity, without unit and spread."""
    words = re.sub(r"-\s+", "", re.sub(r"[\[(].*", "", header)).replace("_", " ").strip()
    before, _, last = words.rpartition(" ")
    if in_short(last) in _UNITS:
        words = before.removesuffix(" in").removesuffix(" en")
    words = bare(words)
    words = _SPREAD.sub("", _BESIDE.sub("", words)).strip(" .:,")
    # Drop (cm) is a height, Drop alone a number
    return "drop height" if words == "drop" and _said_unit(header) else words


_RATIOS = ("", "-", "%", "1")


def understood(rows: Sequence[Sequence[str]]) -> list[int]:
    """Return how many headers are understood in each of the first rows, below their titles."""
    heads = (_under_titles(rows, k) for k in range(len(rows[:40])))
    return [sum(kind_of(cell) is not None for cell in head) for head in heads]


def headers_of(
    rows: Sequence[Sequence[str]], source: str
) -> tuple[int, list[SheetColumn], list[tuple[str, str]]]:
    """Return the first row below the headers, the columns that are understood, and the others.

    Raises
    ------
    InputError
        No row of headers is understood, or two columns hold the approach of one row.
    """
    known = understood(rows)
    best = max(range(len(known)), key=lambda k: known[k], default=0)
    if not known or known[best] < 2:
        raise InputError(
            "no row of headers is understood", source=source,
            allowed="columns such as drop height (cm), rebound height (mm), dent diameter (mm)",
        )  # fmt: skip
    head, top = _under_titles(rows, best), best + 1
    below = list(rows[top]) if top < len(rows) else []
    filled = [cell for cell in below if cell]
    if filled and all(is_unit(cell) or cell.strip("()[] ") in CELSIUS for cell in filled):
        pairs = zip(head, [*below, *[""] * len(head)], strict=False)
        head, top = [f"{h} ({u.strip('()[] ')})" if u else h for h, u in pairs], top + 1
    told = [
        (" ".join(filter(None, row)), f"row {k}, left out: above the headers")
        for k, row in enumerate(rows[:best], start=1)
        if any(row) and (k < best or head == list(rows[best]))
    ]
    columns: list[SheetColumn] = []
    for place, header in enumerate(head):
        spread = _SPREAD.search(_BESIDE.sub("", bare(header).replace("_", " "))) is not None
        kind = columns[-1].kind if spread and columns and not _named(header) else kind_of(header)
        if kind is not None and (kind.quantity == "text" or not spread):
            columns.append(SheetColumn(place, header, kind, unit_of(header, kind)))
        elif kind is not None and any(c.kind == kind for c in columns):
            left = next(c for c in reversed(columns) if c.kind == kind)
            unit = unit_of(header, kind)
            columns.append(SheetColumn(place, header, kind, unit or left.unit, spread=True))
        elif header or any(place < len(row) and row[place] for row in rows[top:]):
            why = "not understood" if header else "no header"
            told.append((header or f"column {place + 1}", f"left out: {why}"))
    kept = []
    for column in columns:
        why = _left_out(column, columns, source)
        told += [(column.header, f"left out: {why}")] if why else []
        kept += [] if why else [column]
    return top, kept, told


def _left_out(column: SheetColumn, columns: Sequence[SheetColumn], source: str) -> str:
    """Why a column is not taken beside the others; empty where it is."""
    words, name = bare(column.header), column.kind.name
    if name == "angle_deg" and _NORMAL.search(words):
        raise InputError(
            "an angle from the normal", source=source, key=column.header,
            allowed="that between velocity and flat, or axis and flat: 90 for a normal impact",
        )  # fmt: skip
    if column.kind.quantity == "text":
        return ""
    if name in REBOUNDS and _LATER.search(words):
        return "of a later bounce"
    same = [c for c in columns if c.kind == column.kind and not c.spread]
    if column.spread:
        alone = sum(c.kind == column.kind and c.spread for c in columns) < len(same)
        return "sums up its neighbours" if alone else ""
    if same[0] is not column and name in APPROACHES:
        raise InputError(
            f"{name} stands in {same[0].header!r} already", source=source, key=column.header,
            allowed="one such column; a table beside another in a file of its own",
        )  # fmt: skip
    if same[0] is not column and name in CONDITIONS:
        return f"{name} stands in {same[0].header!r} already"
    means = [c for c in same if _MEAN.search(bare(c.header))]
    return "sums up its neighbours" if column in means and len(means) < len(same) else ""


def _under_titles(rows: Sequence[Sequence[str]], best: int) -> list[str]:
    """The row of headers, each below the title of its columns where the row above holds titles."""
    head = list(rows[best])
    filled = [cell for cell in head if cell]
    if 2 * sum(_NUMBER.fullmatch(cell) is not None for cell in filled) > len(filled):
        return []  # of numbers
    above = list(rows[best - 1])[: len(head)] if best else []
    if sum(map(bool, above)) < 2 or any(map(is_unit, filter(None, above))):
        return head
    title = ""
    for k, own in enumerate([*above, *[""] * (len(head) - len(above))]):
        title = own or title
        joined = f"{title} {head[k]}"
        # a title that spans several columns stands over the first of them alone
        alone = not own and kind_of(head[k]) is not None
        if head[k] and title and not alone and kind_of(joined) is not None:
            head[k] = joined
    return head


def _said_unit(header: str) -> str:
    """The unit in brackets, or what stands at the end as one."""
    for said in map(in_short, _UNIT_WITHIN.findall(header)):
        if said in _UNITS:
            return said
    found = _UNIT_AT_END.search(header.strip())
    return in_short((found["a"] or found["b"]).strip()) if found else ""


def unit_of(header: str, kind: SheetKind) -> str | None:
    """Return the unit in a header; None where it names none that is known."""
    if kind.quantity in ("text", "number"):
        return "%" if "%" in header else ""
    known = UNITS[kind.quantity].keys() | (CELSIUS if kind.quantity == "temperature" else ())
    if (said := _said_unit(header)) in known:
        return said
    ends = (u for u in known if re.search(rf"[ _]{re.escape(u).replace('/', '[/_]')}$", header))
    return max(ends, key=len, default=None)
