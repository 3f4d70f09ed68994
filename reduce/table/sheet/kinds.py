"""What a header says of its column, in five languages: a quantity, its unit, or its spread."""

from __future__ import annotations

import re
import unicodedata
from typing import NamedTuple

from ....core.observables import LOAD
from ...shared.units import UNITS, quantity_of
from ..heading import DROPS, in_short

REBOUNDS = REBOUND_HEIGHT, REBOUND_SPEED = "rebound_height", "rebound_speed"
BODY = BALL_DIAMETER, BALL_MASS = "ball_diameter", "ball_mass"
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
_BALL = r"\b(ball|sphere|kugel|bille|sfera|bola|esfera)"
_DIAMETER = r"diam|\bdia\b|durchm|ø|⌀"
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
         _both(rf"{_REBOUND}|\bafter\b|\bnach\b|\bapres\b|\bdopo\b|despues", _SPEED)
         + "|^v ?(out|reb)$"),
    SheetKind("drop_height_m", "length",
         _both(DROPS, _HEIGHT)
         + r"|^(h|height|hoe?he|hauteur|altezza|altura)$"),
    SheetKind("impact_speed_m_s", "speed",
         _both(r"impact|approach|(auf|an)prall|auftreff|stoss|impatto|before|\bvor\b|avant|prima|antes",
               _SPEED)
         + r"|^(v( ?n)?|speed|velocity|geschwindigkeit|vitesse|velocita|velocidad)$"),
    SheetKind("dent_diameter_m", "length",
         _both(_DENT, _DIAMETER + r"|dm\b|wid|breit|\bd ?[12]?$")),
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
    SheetKind(BALL_DIAMETER, "length", _both(_BALL, _DIAMETER)),
    SheetKind(BALL_MASS, "mass", _both(_BALL, r"mass|masa|weight|gewicht|poids")),
    SheetKind("trial", "text",
         r"^#|^(nr|no|num|number|test|trial|versuch|messung|probe|shot|run|id|drop no|essai|prova|"
         r"ensayo|lfd)\b|^drop$"),
)  # fmt: skip

UNDERSTOOD = (
    "drop height, impact speed, load; rebound height, rebound speed, restitution, dent diameter "
    "(of two: dent d1, dent d2), dent depth, contact time, peak force; angle, temperature, ball "
    "diameter, ball mass, trial, note"
)
"""Names that a header may have, for people."""

_UNIT_WITHIN = re.compile(r"(?:[\[(]\s*(?:(?:in|en)\s)?|\b(?:in|en)\s)\s*([^\s\]),;]+)")
_PER_SECOND = re.compile(r"m[ ·.]?s\^?[-⁻][1¹]")
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
MEAN = re.compile(rf"\b({_MEANS})\b")
_SPREAD = re.compile(rf"±|\+/-|\b({_SPREADS}|{_ERRORS})\b\.?")
_BESIDE = re.compile(r"(?<=\S)\s*(±|\+/-)\s*\w.*")
"""What stands behind a value in its own cell: mean ± SD."""
_ALONG = re.compile("tangent|horizont")
_RANGE = re.compile(r"\b(range|spannweite|varian[cz]\w*|varianza|cv|rsd)\b")


def bare(text: str) -> str:
    """Return a header in small letters without accents, signs and line ends."""
    spread = unicodedata.normalize("NFKD", text.lower().replace("ß", "ss"))
    return " ".join("".join(c for c in spread if not unicodedata.combining(c)).split())


def kind_of(header: str) -> SheetKind | None:
    """Return what a header says, None where it is not understood."""
    words = named(header)
    found = next((kind for kind in _KINDS if re.search(kind.words, words)), None) if words else None
    if found is None or (found.quantity == "speed" and _ALONG.search(words)):
        return None
    if found.quantity != "text" and _RANGE.search(words):
        return None
    # E (J) is an energy, E (GPa) a modulus
    other = len(words) == 1 and re.fullmatch(r"[^\s=]+", said_unit(header).strip("-%1"))
    return None if other and found.name == "restitution" else found


def is_spread(header: str) -> bool:
    """Return whether a header says that its column holds standard deviations."""
    return _SPREAD.search(_BESIDE.sub("", bare(header).replace("_", " "))) is not None


def named(header: str) -> str:
    """Return the words of a header that name a quantity, without unit and spread."""
    words = re.sub(r"-\s+", "", re.sub(r"[\[(].*", "", _PER_SECOND.sub("m/s", header)))
    words = words.replace("_", " ").strip()
    before, _, last = words.rpartition(" ")
    if in_short(last) in _UNITS:
        words = before.removesuffix(" in").removesuffix(" en")
    words = bare(words)
    words = _SPREAD.sub("", _BESIDE.sub("", words)).strip(" .:,/")
    # Drop (cm) is a height, Drop alone a number; Rebound 2 (mm) is one of several, a speed in m/s
    unit = said_unit(header)
    back = re.fullmatch(rf"({_REBOUND}) ?\d*", words) and quantity_of(unit)
    if back == "speed":
        return f"{words} speed"
    return f"{words} height" if back == "length" or (words == "drop" and unit) else words


def said_unit(header: str) -> str:
    """Return the unit in brackets, or what stands at the end as one."""
    header = _PER_SECOND.sub("m/s", header)
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
    if (said := said_unit(header)) in known:
        return said
    ends = (u for u in known if re.search(rf"[ _]{re.escape(u).replace('/', '[/_]')}$", header))
    return max(ends, key=len, default=None)
