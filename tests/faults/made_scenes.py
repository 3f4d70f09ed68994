"""A steel ball or rod on iron, as many tests of impacts have them."""

from functools import partial

from dentscope.core import Material
from dentscope.dynamics import Approach, Striker, scene_of

STEEL = Material(E=200e9, nu=0.3, Sy=760e6, density=7800.0)
IRON = Material(E=200e9, nu=0.3, Sy=305e6, density=7870.0)
ROD = Striker(mass=0.4607, tip_radius=0.0088, length=0.3048, radius=0.0088)
on_iron = partial(scene_of, sphere=STEEL, flat=IRON, striker=ROD, approach=Approach(1.0))
