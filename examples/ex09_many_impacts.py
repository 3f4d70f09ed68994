"""A hundred thousand drops of a steel ball in a fraction of a second, and a fall through air."""

# %% One scene, and an array of speeds.
import numpy as np
from dentscope.core import Material
from dentscope.core.drag import air
from dentscope.dynamics import Approach, Striker, impacts, scene_of
from dentscope.dynamics.drag import flown
from dentscope.models import LAWS

hard = Material(E=208e9, nu=0.3, Sy=1.7e9, density=7800.0)
mild = Material(E=206e9, nu=0.29, Sy=305e6, density=7850.0)
ball = Striker(mass=4.08e-3, tip_radius=5e-3, name="ball")
scene = scene_of(LAWS["fitted"], sphere=hard, flat=mild, striker=ball, approach=Approach(1.0))
found = impacts(scene, speeds=np.geomspace(0.1, 5.0, 100_000))
for k in (0, 50_000, 99_999):
    print(
        f"{found['impact_speed_m_s'][k]:5.2f} m/s: e = {found['restitution'][k]:.3f}, "
        f"crater {found['permanent_depth_m'][k] * 1e6:.1f} um, "
        f"{found['contact_time_s'][k] * 1e6:.1f} us, by {found['route'][k]}"
    )

# %% Through air it arrives a little slower.
fall = -float(flown(ball, air(), normal=0.0, rise=-1.0).normal)
print(f"dropped from 1 m it arrives with {fall:.3f} m/s, in a vacuum with 4.429")
