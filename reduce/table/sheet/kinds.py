"""What a header says of its column: a quantity, its unit, or its spread."""

from __future__ import annotations

import re
from difflib import SequenceMatcher
from functools import lru_cache

from ....recordings.columns import CONDITIONS, MEASURED
from ...shared.units import UNITS, quantity_of
from ..heading import in_short
from . import words
from .words import KINDS, SheetKind, bare, letters

_UNIT_WITHIN = re.compile(r"(?:[\[(]\s*(?:(?:in|en)\s)?|\b(?:in|en|w|em)\s)\s*([^\s\]),;]+)")
_BRACKETED = re.compile(r"[\[(][^\])]*([\])]|$)")
_FORMULA = re.compile(r"\s*=[^=()\[\]]*(?=[(\[]|$)")
"""Such as e = Vr/Vi."""
_PER_SECOND = re.compile(r"m[ ·.]?s\^?[-⁻][1¹]|(?<=_)m_s\b")
_UNITS = {unit for known in UNITS.values() for unit in known}
_UNIT_AT_END = re.compile(
    r"[\[(,/]\s*((in|en)\s+)?(?P<a>[^\])(\[,/]{1,6}(?:/s|/sec)?)\s*[\])]?\s*$"
    r"|\b(in|en) (?P<b>\S{1,4})$"
)
_LAST = (re.compile(r"(.*?)[\s/,]+(\S+)"), re.compile(r"(.*?)\s*/([^/]+)"))
_ENDS = r"(?<![a-z]){}(?![a-z])"
SUMMARY = re.compile(
    rf"({words.MEANS}|{letters(words.SPREADS)}|{letters(words.EXTREMES)})"
    r"( (value|wert)| ?\(.*\)| ?\d.*| ?[a-z]? ?[=±].*)?"
)
"""What says that a row sums up others."""
SUMS = re.compile(_ENDS.format(f"({words.MEANS}|{letters(words.SPREADS)})"))
"""The same of what should name a trial."""
MEAN = re.compile(_ENDS.format(f"({words.MEANS})") + f"|{words.DERIVED}")
LEAST, END = (
    re.compile(_ENDS.format(f"({letters(end)})"))
    for end in (words.LEAST, f"{words.LEAST}|{words.MOST}")
)
_WIDE = _ENDS.format(f"({letters(words.SPREADS)}|{letters(words.ERRORS)})")
_SPREAD = re.compile(rf"±|\+/-|{_WIDE}\.?|(?<=[)\]] )[su]$|(?<=\w )[su](?= [\[(])", re.IGNORECASE)
_BESIDE = re.compile(r"(?<=\S)\s*(±|\+/-)\s*\w.*")
"""What stands behind a value in its own cell: mean ± SD."""
_PLAIN = (CONDITIONS.keys() | MEASURED.keys()) - {"striker"}
"""Headers as a set has them; a striker is found by its words, as a ball is: its cells are names."""


@lru_cache(maxsize=4096)
def kind_of(header: str) -> SheetKind | None:
    """Return what a header says, None where it is not understood."""
    if header in _PLAIN and not header.endswith("_std"):  # as a set has it, whatever its words say
        return next((kind for kind in KINDS if kind.name == header), words.plain_kind(header))
    header = _FORMULA.sub("", header)
    text = named(header)
    found = next((kind for kind in KINDS if kind.is_said(text)), None) if text else None
    if found is None or found.quantity == "text":
        return found
    other = words.has(words.RANGE, text) or words.has(words.THEORY, bare(header))
    if other or "²" in without_unit(header):
        return None
    # E (J) is an energy, E (GPa) a modulus, T (ms) no temperature
    unit = said_unit(header).strip("-%1") if len(text) == 1 else ""
    quantity = quantity_of(unit)
    other = quantity != found.quantity if quantity else found.quantity == "number"
    return None if other and re.fullmatch(r"[^\s=]+", unit) else found


def is_spread(header: str) -> bool:
    """Return whether a header says that its column holds standard deviations."""
    return _SPREAD.search(_BESIDE.sub("", letters(header.replace("_", " ")))) is not None


def named(header: str) -> str:
    """Return the words of a header that name a quantity, without unit and spread."""
    text = re.sub(words.CONTACT_TIME, "contact time", _PER_SECOND.sub("m/s", header))
    text = _BESIDE.sub("", re.sub(r"-\s+", "", letters(without_unit(text).replace("_", " "))))
    own = _SPREAD.sub("", text).strip(" .:,/")
    text = own if own == text else re.sub(words.OF, "", own).strip()
    ends = [found for found in (last.fullmatch(text) for last in _LAST) if found]
    known = [found[1] for found in ends if in_short(found[2]) in _UNITS]
    if known:
        text = re.sub(r" (in|en|w|em)$", "", known[0])
    elif in_short(header.strip()) in _UNITS:
        return ""
    text = bare(text).strip(" .:,/")
    # Drop (cm) is a height, Drop alone a number; Rebound 2 (mm) is one of several, a speed in m/s
    ended = [in_short(found[2]) for found in ends if quantity_of(in_short(found[2])) == "length"]
    unit = said_unit(header) or "".join(ended[:1])
    back = words.has(words.REBOUND, text) and quantity_of(unit)
    if back == "speed":
        return f"{text} speed"
    height = back == "length" and not words.has(words.HEIGHT, text)
    return f"{text} height" if height or (text == "drop" and unit) else text


def without_unit(header: str) -> str:
    """Return a header without what stands in brackets."""
    return _BRACKETED.sub(" ", header)


def said_unit(header: str) -> str:
    """Return the last known unit in brackets, or what stands at the end as one."""
    header = _PER_SECOND.sub("m/s", header)
    for said in map(in_short, reversed(_UNIT_WITHIN.findall(header))):
        if said in _UNITS:
            return said
    found = _UNIT_AT_END.search(header.strip())
    return in_short((found["a"] or found["b"]).strip()) if found else ""


def unit_of(header: str, kind: SheetKind) -> str | None:
    """Return the unit in a header; None where it names none that is known."""
    if kind.quantity in ("text", "number"):
        return "%" if "%" in header else ""
    known = UNITS[kind.quantity]
    if (said := said_unit(header)) in known:
        return said
    plain = _SPREAD.sub("", header.replace("_std", "")).strip(" _")
    ends = (u for u in known if re.search(rf"[ _/]{re.escape(u).replace('/', '[/_]')}$", plain))
    return max(ends, key=len, default=None)


def nearest(header: str) -> str:
    """Return what a header may mean, as a question that `--column` answers; empty without one."""
    text, quantity = named(header) or bare(header), quantity_of(said_unit(header))
    kinds = [
        k for k in KINDS
        if k.quantity != "text" and quantity in ("", k.quantity) and not words.has(k.never, text)
    ]  # fmt: skip
    likeness = {k: sum(_like(part, text) for part in k.parts) / len(k.parts) for k in kinds}
    # of a rebound, the height or speed is what is read, hardly ever the spin
    best = max(
        likeness, key=lambda kind: (likeness[kind], kind.name in words.REBOUNDS), default=None
    )
    far = "²" in header or words.has(rf"{words.THEORY}|{words.NOT_NEARLY}", bare(header))
    if best is None or not likeness[best] or far:
        return ""
    unit = "" if quantity or best.quantity == "number" else " UNIT"
    return f"{best.said}? --column {f'{without_unit(header).strip()}={best.said}{unit}'!r}"


def _like(part: str, words: str) -> float:
    """The largest share of one of the stems of a pattern that stands in some words, 0 below 3/5."""
    plain = re.sub(r"\\b|\(\?[!<=]*", " ", letters(part))
    stems = re.findall(r"[^\W\d_]{4,}|[^\x00-\u02ff]{2,}", plain)
    found = ((SequenceMatcher(None, s, words).find_longest_match().size, len(s)) for s in stems)
    return max((n / of for n, of in found if n > 0.6 * of and n >= min(of, 4)), default=0.0)
