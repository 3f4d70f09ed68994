"""Parameters of a concealed effect in the words of the verdict, where both mean the same thing."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

Numbers = dict[str, float]

_SPRING = 0.77
"""Stiffness of a single spring over Mindlin's at equal rebounds of oblique spheres."""


def _rate(form: str, k: Numbers) -> Numbers:
    if form == "overstress-power":
        rise = (1000.0 / k["D"]) ** (1.0 / k["q"])
    elif form == "zerilli-armstrong":
        rise = k["A"] * ((1000.0 / 1e-3) ** k["m"] - 1.0)
    else:
        rise = k["C"] * math.log1p(1000.0 / k["reference"])
    return {"rise_at_1000_per_s": rise}


def _film(form: str, k: Numbers) -> Numbers:
    return {"film_drag_Pa_s": k["viscosity"] * math.log1p(k["thickness"] / k["closed"])}


_WORDS: dict[str, Callable[[str, Numbers], Numbers]] = {
    "strain-rate-hardening": _rate,
    "squeeze-film": _film,
    "thermal-softening": lambda form, k: {"softening_exponent": k["m"]} if "m" in k else {},
    "contact-damping": lambda form, k: {"damping_s_m": k["chi"]} if "chi" in k else {},
    "adhesion": lambda form, k: {"work_of_adhesion_J_m2": k["work"]} if form == "jkr" else {},
    "size-effect": lambda form, k: {"size_length_m": k["length"]} if form == "swadener" else {},
    "impact-speed-loss": lambda form, k: {"speed_loss": k["loss"]} if "loss" in k else {},
    "tilt": lambda form, k: {"tilt_deg": math.degrees(k["angle"])},
    # the generator's partial slip is no exact contact: its rebounds are those of 0.94 of the spring
    "tangential-compliance": lambda form, k: (
        {"tangential_stiffness_ratio": k["ratio"] / _SPRING} if form == "spring-and-slider" else {}
    ),
    "support-compliance": lambda form, k: (
        {"support_stiffness_N_m": k["stiffness"], "support_mass_kg": k["mass"]}
        if form == "mass-spring-dashpot"
        else {}
    ),
}


def comparable(effect: dict[str, Any]) -> Numbers:
    """True values of those parameters of the verdict that have one, SI or the verdict's unit.

    `effect`: entry of a truth file: `name`, `form`, `numbers`.
    """
    find = _WORDS.get(effect["name"])
    if find is None or (effect["form"] == "meshed" and "C" not in effect["numbers"]):
        return {}
    return find(effect["form"], effect["numbers"])
