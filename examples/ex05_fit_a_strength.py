"""Fit a number to a measurement: the yield strength that a rebound hardness test shows."""

# %% Leeb's device D on steel of 300 HV: a carbide ball, 5.5 g at 2 m/s, rebounds with 0.56.
from dataclasses import replace

import dentscope as ds
from dentscope.dynamics import Approach, Striker, scene_of, strike
from scipy.optimize import brentq

MEASURED, STD = 0.56, 0.02
carbide = ds.Material(E=620e9, nu=0.22, Sy=5.2e9)
steel = ds.Material(E=207e9, nu=0.29, Sy=1e9)
ball = Striker(mass=5.5e-3, tip_radius=1.5e-3)


# %% The simulated restitution for a yield strength of the steel.
def restitution(strength: float) -> float:
    flat = replace(steel, Sy=strength)
    scene = scene_of(
        ds.LAWS["fitted"], sphere=carbide, flat=flat, striker=ball, approach=Approach(2.0)
    )
    return strike(scene).restitution


# %% The strength that gives the measured one, and those at its standard deviation.
best, low, high = (
    float(brentq(lambda s, e=e: restitution(s) - e, 2e8, 4e9, rtol=1e-6))
    for e in (MEASURED, MEASURED - STD, MEASURED + STD)
)
print(f"yield strength {best / 1e6:.0f} MPa ({low / 1e6:.0f} to {high / 1e6:.0f})")
print(f"from the hardness, 300 HV over 3: {300 * 9.807e6 / 3 / 1e6:.0f} MPa")
