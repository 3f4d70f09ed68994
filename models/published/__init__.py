"""Every published law in reading order, and those that cannot be offered.

First the elastic law and the simplest plastic ones, then flattening, impact, indentation, and last
the model in which both bodies deform.
"""

from __future__ import annotations

from ..base import ContactLaw
from .brake import BRAKE_2012, BRAKE_2015
from .brizmer import BRIZMER
from .ceb import CEB
from .ghaednia import GHAEDNIA
from .hertz import HERTZ
from .jackson_green import JACKSON_GREEN, JACKSON_GREEN_2007
from .johnson import JOHNSON
from .kogut_etsion import KOGUT_ETSION, KOGUT_ETSION_CONTINUED
from .kogut_komvopoulos import KOGUT_KOMVOPOULOS
from .sinclair_follansbee import SINCLAIR_FOLLANSBEE
from .stronge import STRONGE
from .thornton import THORNTON, THORNTON_NING
from .ye_komvopoulos import YE_KOMVOPOULOS
from .zhao_maietta_chang import ZHAO_MAIETTA_CHANG

PUBLISHED: tuple[ContactLaw, ...] = (
    HERTZ,
    JOHNSON,
    CEB,
    ZHAO_MAIETTA_CHANG,
    KOGUT_ETSION,
    KOGUT_ETSION_CONTINUED,
    BRIZMER,
    JACKSON_GREEN,
    JACKSON_GREEN_2007,
    THORNTON,
    THORNTON_NING,
    STRONGE,
    BRAKE_2012,
    BRAKE_2015,
    SINCLAIR_FOLLANSBEE,
    YE_KOMVOPOULOS,
    KOGUT_KOMVOPOULOS,
    GHAEDNIA,
)

UNAVAILABLE: dict[str, str] = {
    "wang": "Wang's correction of the unloading of Kogut and Etsion: section 1.3.2 gives no "
    "equation, the text of the thesis at hand ends before its list of references, and no public "
    "text or code that quotes the paper was found; kogut-etsion+jackson-green and "
    "kogut-etsion+ghaednia give that loading another recovery",
    "li-thornton": "Li, Wu and Thornton 2002: section 1.3.2 gives no equation; the force follows "
    "from a pressure distribution fitted to their finite elements, whose constants stand in the "
    "paper only, and no public text or code that quotes them was found; thornton is the model that "
    "it corrects",
    "wu": "Wu, Li and Thornton 2003: section 1.3.2 names them among finite-element studies and "
    "gives no equation; the paper, on the rebound of plastic spheres, was not read",
    "bartier": "Bartier and others: section 1.3.1 names the paper as a comparison of models for "
    "the real contact radius; it is no law of its own",
    "komvopoulos-layered": "Komvopoulos, and Ye and Komvopoulos 2003, for layered flats: "
    "section 1.3.1 gives no equation for a layer, and the papers were not read; the flats here "
    "have one metal, for which ye-komvopoulos and kogut-komvopoulos are offered",
    "brake-2015-friction": "the friction of Brake 2015 for oblique impacts: section 1.3.1 says "
    "that the paper has one and gives no equation; brake-2015 is its normal law, tangential "
    "laws at hand are Coulomb's and the tangential-compliance of a diagnosis",
    "kelvin-voigt": "Kelvin and Voigt (chapter 1): F = k d + c d' is a force of depth and rate and "
    "leaves no dent; it pushes at first touch, when nothing is pressed in, and pulls before the "
    "bodies part",
    "hunt-crossley": "Hunt and Crossley, J. Appl. Mech. 42 (1975) 440: F = K d^n (1 + (3/2) alpha "
    "d') is a force of depth and rate and leaves no dent; beside a law it is the mechanism "
    "contact-damping of a diagnosis",
    "cross-grip": "Cross's grip and multiple reversal of friction: section 1.1 says that the "
    "papers give no analytical model; reversal by elastic sticking is tangential-compliance",
    "etsion-sliding": "the Etsion group's other work on slip conditions (section 1.3.2 names two "
    "papers, the list of references is missing): no equation is given; brizmer-stick is the "
    "group's normal law with full stick",
    "wadwalkar": "Wadwalkar, Jackson and Kogut 2010 (large deformation): section 1.2 gives no "
    "equation, and the paper's fits were found in no public text or code; up to a/R = 1 "
    "jackson-green-2007 has a hardness that falls to S, as theirs, but its force is a fit up to "
    "a/R = 0.41",
}
"""Laws that the thesis names and that are not offered, with the reason."""
