"""A rod that meets the flat at an angle: rigid it touches once, bending several times."""

# %% The rod, the flat and the blow, in SI units.
import math

from dentscope.core import Material
from dentscope.dynamics import Approach, Friction, Striker, rod_modes, scene_of, strike
from dentscope.models import LAWS

steel = Material(E=200e9, nu=0.3, Sy=760e6, density=7800.0)
iron = Material(E=200e9, nu=0.3, Sy=305e6, density=7870.0)
rod = Striker(mass=0.4607, tip_radius=0.0088, length=0.3048, radius=0.0088)
scene = scene_of(
    LAWS["jackson-green"],
    sphere=steel,
    flat=iron,
    striker=rod,
    approach=Approach(speed=1.41, angle=math.radians(20.0)),
    friction=Friction(0.20),
)

# %% Without vibration, and with ten modes of it.
found = {}
for count in (0, 10):
    modes = rod_modes(rod.length, rod.radius, steel, mass=rod.mass, count=count)
    found[count] = strike(scene.with_(modes=modes))
    print(
        f"{count:2d} modes: e = {found[count].restitution:.3f}, "
        f"dent {found[count].residual_flat_m * 1e6:.1f} um, "
        f"{found[count].contacts} contacts in {found[count].contact_time_s * 1e3:.2f} ms"
    )
