"""Every published law in reading order, and those that cannot be offered.

First the elastic law and the simplest plastic ones, then flattening, impact, indentation, and last
the model in which both bodies deform.
"""

from __future__ import annotations

from ..base import ContactLaw
from .brake import BRAKE_2012, BRAKE_2015
from .ceb import CEB
from .ghaednia import GHAEDNIA
from .hertz import HERTZ
from .jackson_green import JACKSON_GREEN, JACKSON_GREEN_2007
from .johnson import JOHNSON
from .kogut_etsion import KOGUT_ETSION
from .kogut_komvopoulos import KOGUT_KOMVOPOULOS
from .sinclair_follansbee import SINCLAIR_FOLLANSBEE
from .stronge import STRONGE
from .thornton import THORNTON, THORNTON_NING
from .viscous import RATE_MODELS as RATE_MODELS
from .ye_komvopoulos import YE_KOMVOPOULOS

PUBLISHED: tuple[ContactLaw, ...] = (
    HERTZ,
    JOHNSON,
    CEB,
    KOGUT_ETSION,
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
    "wadwalkar": "Wadwalkar, Jackson and Kogut 2010 (large deformation): section 1.2 gives no "
    "equation, and the paper's fits were found in no public text or code; up to a/R = 1 "
    "jackson-green-2007 has a hardness that falls to S, as theirs, but its force is a fit up to "
    "a/R = 0.41",
}
"""Laws that the thesis names and that are not offered, with the reason."""
