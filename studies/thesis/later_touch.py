"""After the impact: the flying rod's other end touches, the tip comes back and marks again."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...discrepancy.comparison.forward import ACCURACY
from ...dynamics import Impact, Scene, strike

_RESTITUTION = 0.6  # of the other end; the tip's return hardly hangs on it
_STEP, _LONGEST = 1e-4, 2.0  # s


@dataclass(frozen=True, slots=True)
class Later:
    """The return of the tip.

    Parameters
    ----------
    time
        After the impact [s].
    distance
        Along the flat from where it struck [m].
    speed
        Normal speed with which it comes back [m/s].
    other_first
        When the other end touches before [s]; nan if it does not.
    second
        The impact of that return, on the metal that the first one left.
    overlaps
        Whether the two marks run into one.
    """

    time: float
    distance: float
    speed: float
    other_first: float
    second: Impact
    overlaps: bool


@dataclass(slots=True)
class _Flight:
    """Centre (x, y) and angle of the rod, and their rates."""

    x: float
    y: float
    angle: float
    vx: float
    vy: float
    spin: float


def later_touch(scene: Scene) -> Later | None:
    """Follow the rod in free flight after its impact until the tip is back, and let it strike.

    The other end's blows on the way are rigid and without friction; the rod has stopped to ring
    when the tip is back.

    Returns
    -------
    None if the tip does not come back within 2 s.
    """
    first = strike(scene, ACCURACY)
    rod, g = scene.striker, scene.gravity
    half, angle = 0.5 * rod.length, scene.approach.angle
    f = _Flight(
        half * math.cos(angle), half * math.sin(angle) + rod.tip_radius, angle,
        first.tangential_rebound_m_s, first.rebound_speed_m_s, first.rebound_spin_rad_s,
    )  # fmt: skip
    now, other_first = 0.0, math.nan
    t = np.arange(1.0, _LONGEST / _STEP) * _STEP
    while now < _LONGEST:
        turned = f.angle + f.spin * t
        y = f.y + f.vy * t - 0.5 * g * t * t - rod.tip_radius
        below = np.stack([y - half * np.sin(turned), y + half * np.sin(turned)]) < 0.0
        if not below.any():
            break
        i = int(np.argmax(below.any(axis=0)))
        now += float(t[i])
        f = _Flight(
            f.x + f.vx * t[i], float(y[i]) + rod.tip_radius, float(turned[i]), f.vx,
            f.vy - g * float(t[i]), f.spin,
        )  # fmt: skip
        side = -1.0 if below[0, i] else 1.0
        arm = side * half * math.cos(f.angle)
        speed = -(f.vy + f.spin * arm)
        if side < 0.0:
            return _returned(scene, first, f, Later(
                # the tip has left from the end of its slide, away from the centre
                now, float(f.x + arm) - first.sliding_length_m, speed, other_first, first, False,
            ))  # fmt: skip
        other_first = now if math.isnan(other_first) else other_first
        blow = (1.0 + _RESTITUTION) * max(speed, 0.0) / (1.0 / rod.mass + arm**2 / rod.inertia)
        f.vy, f.spin = f.vy + blow / rod.mass, f.spin + blow * arm / rod.inertia
        # out of the flat by what the step went into it
        f.y -= min(float(y[i]) + half * math.sin(f.angle), 0.0)
    return None


def _returned(scene: Scene, first: Impact, f: _Flight, back: Later) -> Later | None:
    """Let the tip strike where it came back."""
    if not (back.speed > 0.0 and 0.0 < f.angle < 0.5 * math.pi):
        return None
    approach = replace(
        scene.approach, speed=back.speed, angle=f.angle, tangential=f.vx, spin=f.spin
    )
    again = scene.with_(approach=approach, spot=first.spot.shifted(back.distance))
    overlaps = abs(back.distance) < first.scar_length_m
    return replace(back, second=strike(again, ACCURACY), overlaps=overlaps)
