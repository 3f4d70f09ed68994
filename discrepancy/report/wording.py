"""Words of a report: numbers as people write them, names without keys."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from ...core.observables import OBSERVABLES
from ..locate import Located

_PREFIXES, _UNIT = "qryzafpnµm kMGTPEZYRQ", 10
_PREFIXED = frozenset({"Pa", "m", "s", "N", "J", "Hz", "N/m", "g"})
_WHILE = {
    "approach": "before the touch", "loading": "while the bodies are pressed together",
    "unloading": "while they part", "sliding": "while the tip slides",
    "free-flight": "in the flight",
}  # fmt: skip
_KEYS = {
    "E_Pa": "Young's modulus", "Sy_Pa": "yield strength", "tip_radius_m": "radius of the tip",
    "radius_m": "radius", "mass_kg": "mass", "restitution": "restitution where nothing is missing",
}  # fmt: skip
_WHOLE = {
    "speed.scale": "all speeds, by one factor",
    "angle.offset": "all angles, by one shift",
    "gauge.load_N": "all loads, by one factor",
    "dent.rim": "rim of a dent over its contact circle",
    "friction.coefficient": "friction coefficient",
}


def title_of(name: str, titles: Mapping[str, str]) -> str:
    """Return what a mechanism means, as a clause: by the verdict's `titles`."""
    return titles.get(name, name.replace("-", " "))


def explanation(name: str, titles: Mapping[str, str]) -> str:
    """Return an explanation's name, as the scores know it, in words."""
    if name == "baseline":
        return "nothing is missing"
    if name == "outside-library":
        return "something that dentscope has no name for"
    return " and ".join(title_of(part, titles) for part in name.split("+"))


def number_name(key: str, *, struck: str = "the flat") -> str:
    """Return the name of a number of set.toml in words.

    Examples
    --------
    >>> number_name("target.E_Pa"), number_name("target.E_Pa", struck="the second sphere")
    ("Young's modulus of the flat", "Young's modulus of the second sphere")
    """
    if key in _WHOLE:
        return _WHOLE[key]
    if key.startswith("gauge."):
        return f"all readings of {OBSERVABLES[key.removeprefix('gauge.')].label}, by one factor"
    *place, last = key.split(".")
    what = _KEYS.get(last, last.replace("_", " "))
    if not place:
        return what
    return f"{what} of {struck if place == ['target'] else place[-1]}"


def parameter_name(label: str, unit: str) -> str:
    """Return the name of a mechanism's number in words, without its unit.

    Examples
    --------
    >>> parameter_name("support_stiffness_N_m", "N/m"), parameter_name("tilt.rate_exponent", "-")
    ('support stiffness', 'rate exponent of tilt')
    """
    whose, _, name = label.rpartition(".")
    ending = unit.replace("^", "").replace("/", "_").replace(" ", "_")
    what = name.removesuffix(f"_{ending}").replace("_", " ")
    return f"{what} of {whose}" if whose else what


def quantity(value: float, unit: str) -> str:
    """Return a value of three figures with its unit, the unit prefixed where that is usual.

    Examples
    --------
    >>> quantity(3.0512e8, "Pa"), quantity(2.9e-5, "m"), quantity(40.2, "1/s")
    ('305 MPa', '29 µm', '40.2 1/s')
    """
    short = float(f"{value:.3g}")
    if not math.isfinite(short):
        return "none" if math.isnan(short) else "without bound"
    if unit == "kg":
        short, unit = float(f"{1e3 * value:.3g}"), "g"
    if unit in _PREFIXED:
        third = math.floor(math.log10(abs(short)) / 3.0 + 1e-9) if short else 0
        third = min(max(third, -_UNIT), len(_PREFIXES) - 1 - _UNIT)
        return f"{short / 1e3**third:g} {_PREFIXES[_UNIT + third].strip()}{unit}"
    plain = f"{short:.3g}" if 1e-3 <= abs(short) < 1e5 or short == 0.0 else f"{short:.2e}"
    return plain if unit in ("-", "") else f"{plain} {unit}"


def interval(low: float, high: float, unit: str) -> str:
    """Return an interval with its unit."""
    return f"{quantity(low, unit)} to {quantity(high, unit)}"


def percent(p: float) -> str:
    """Return a probability in words that are no surer than it is.

    Examples
    --------
    >>> percent(0.974), percent(0.9999), percent(0.0004)
    ('97 %', 'more than 99 %', 'less than 1 %')
    """
    if p > 0.99:
        return "more than 99 %"
    if p < 0.01:
        return "less than 1 %"
    return f"{100.0 * p:.0f} %"


def compared(improvement: Mapping[str, float]) -> str:
    """Return what predictions of left-out conditions, with an explanation and without, say of it.

    Examples
    --------
    >>> said = {"log_density_baseline": -3.0, "log_density_extended": -1.5}
    >>> compared(said).split(",")[0], compared(dict.fromkeys(said, -1.5)).split(",")[0]
    ('1.50 nat a number more probable', 'no more probable')
    """
    gain = improvement["log_density_extended"] - improvement["log_density_baseline"]
    if gain >= 0.005:
        return f"{gain:.2f} nat a number more probable, which alone does not prove it"
    if gain > -0.005:
        return "no more probable, so this says nothing for the name"
    return f"{-gain:.2f} nat a number less probable, which speaks against the name"


def joined(parts: Sequence[str], last: str = "and") -> str:
    """Return words as a list within a sentence."""
    if len(parts) < 2:
        return "".join(parts)
    return f"{', '.join(parts[:-1])} {last} {parts[-1]}"


def miss_sentences(located: Located, *, most: int) -> tuple[str, ...]:
    """Return where the simulation misses beyond chance, a sentence an observable, worst first."""
    found, threshold = [], located.threshold
    misses = located.beyond_chance[:most]
    for name in dict.fromkeys(m.observable for m in misses):
        own = [m for m in misses if m.observable == name]
        label, when = OBSERVABLES[name].label, _WHILE.get(own[0].phase, own[0].phase)
        trends = "; ".join(
            f"{m.trend}, {abs(m.z) / threshold:.1f} times the largest miss of chance alone"
            for m in own
        )
        found.append(f"{label[0].upper()}{label[1:]} ({when}): {trends}.")
    return tuple(found)
