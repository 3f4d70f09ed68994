"""Families: explanations that do alike, so that data may tell the family and not the member."""

from __future__ import annotations

from typing import NamedTuple

from ..rules import RULES
from .odds import Odds

FAMILIES: dict[str, tuple[str, tuple[str, ...]]] = {
    "strength": (
        "the metal under these blows is not as strong as stated",
        ("strain-rate-hardening", "work-hardening", "hardened-layer", "size-effect",
         "thermal-softening", "wrong-input:target.Sy_Pa"),
    ),
    "structure": (
        "energy goes into what is around the contact",
        ("half-space-waves", "rod-longitudinal-waves", "rod-flexural-vibration",
         "support-compliance", "contact-damping"),
    ),
    "surface": ("the surfaces do not meet bare and smooth",
                ("roughness", "adhesion", "squeeze-film")),
    "friction": (
        "the bodies do not slide by one coefficient",
        ("velocity-dependent-friction", "ploughing-friction", "tangential-compliance",
         "wrong-input:friction.coefficient"),
    ),
    "arrival": (
        "the striker does not arrive as stated",
        ("impact-speed-loss", "air-drag", "tilt", "wrong-input:speed.scale",
         "wrong-input:drop_height_m", "wrong-input:angle_deg"),
    ),
}  # fmt: skip
"""Family to what its members agree on, and the members; a wrong number of a body's size, mass or
modulus belongs to none."""


class Family(NamedTuple):
    """A family that leads: its name, what its members agree on, its probability, theirs."""

    name: str
    title: str
    probability: float
    members: dict[str, float]


def family_of(odds: Odds) -> Family | None:
    """Return the family that takes part with `RULES.together` or more, the most probable."""
    found = []
    for name, (title, members) in FAMILIES.items():
        p = sum(q for label, q in odds.probability.items() if set(odds.names[label]) & set(members))
        own = {m: q for m, q in odds.inclusion.items() if m in members and q >= RULES.supported}
        if p >= RULES.together and own:
            found.append(Family(name, title, p, own))
    return max(found, key=lambda f: f.probability, default=None)
