"""How Fallversuche.csv was made: forty drops onto a plate whose strength rises with the rate.

    python made.py | iconv -f utf8 -t cp1252 > Fallversuche.csv

The flat's strength is 250 MPa times 1 + (r/40 s)^(1/5) (Cowper and Symonds, mild steel), one
factor a blow from its mean rate 0.4 v/a; noise of 1.5 % in the rebound height, 1 % in the diameter.
"""

import dentscope as ds
import numpy as np

RADIUS, GRAVITY = 5e-3, 9.81
BALL = ds.Material(E=210e9, nu=0.3, Sy=2.2e9, density=7800)
draw = np.random.default_rng(8)
print("Nr.;Fallhöhe (cm);Rückprallhöhe (mm);Eindruckdurchmesser (mm);Bemerkung")
number = 0
for height in (0.05, 0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.0):
    speed, factor = (2.0 * GRAVITY * height) ** 0.5, 2.0
    for _ in range(5):
        plate = ds.Material(E=205e9, nu=0.29, Sy=250e6 * factor, density=7850)
        blow = ds.impact(ds.Pair(sphere=BALL, flat=plate, R=RADIUS), speed=speed)
        a = 0.5 * blow["fitted"].scar_width_m
        factor = 1.0 + (0.4 * 0.5 * speed / a / 40.0) ** 0.2
    for _ in range(5):
        number += 1
        up = 1e3 * height * blow["fitted"].restitution ** 2 * (1.0 + 0.015 * draw.standard_normal())
        wide = 2e3 * a * (1.0 + 0.01 * draw.standard_normal())
        rebound = "" if number in (7, 23) else f"{up:.1f}"
        note = "Kugel rollte" if number == 7 else ""
        print(f"{number};{1e2 * height:g};{rebound};{wide:.3f};{note}".replace(".", ","))
