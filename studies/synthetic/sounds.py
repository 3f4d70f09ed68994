"""Sound of a bouncing ball, rendered with known truth: ringing, echo, knocks, noise, clipping."""

from __future__ import annotations

import math
import wave
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.arrays import Array

RATE = 44100
_GRAVITY, _AIR, _DRAG = 9.81, 1.2, 0.45
_STEP = 2e-5


@dataclass(frozen=True)
class SoundTruth:
    """A ball that is dropped on a flat, and what is heard of it.

    - `diameter`, `density`: of the ball [m, kg/m³].
    - `speed`, `restitution`, `power`: speed of the first impact [m/s]; restitution at 1 m/s, which
      falls as speed^-power.
    - `contact_time`: of every contact [s].
    - `slowest`: impacts below are not rendered [m/s].
    - `knocks`: number of knocks that belong to no bounce.
    - `noise`, `echo`, `gain`: standard deviation of the noise; loudness of the echo; above 1 the
      record is clipped.
    - `seed`: of the noise, the knocks and the sound of a contact.
    """

    diameter: float = 0.02
    density: float = 7800.0
    speed: float = 2.5
    restitution: float = 0.8
    power: float = 0.05
    contact_time: float = 1e-4
    slowest: float = 0.15
    knocks: int = 0
    noise: float = 1e-3
    echo: float = 0.1
    gain: float = 0.9
    seed: int = 0

    @property
    def mass(self) -> float:
        """Mass of the ball [kg]."""
        return self.density * math.pi * self.diameter**3 / 6.0


def random_bounces(seed: int) -> SoundTruth:
    """Draw a ball and a record."""
    rng = np.random.default_rng(seed)
    return SoundTruth(
        diameter=rng.uniform(0.01, 0.05), density=rng.uniform(1000.0, 8000.0),
        speed=rng.uniform(1.0, 4.0), restitution=rng.uniform(0.5, 0.92),
        power=rng.uniform(0.0, 0.12), contact_time=rng.uniform(5e-5, 5e-4),
        knocks=int(rng.integers(0, 3)), noise=10.0 ** rng.uniform(-4.0, -2.2),
        echo=rng.uniform(0.0, 0.25), gain=rng.uniform(0.6, 1.3), seed=seed,
    )  # fmt: skip


def bounces(truth: SoundTruth) -> list[tuple[float, float, float]]:
    """Return time [s], impact speed [m/s] and restitution of every bounce.

    The flights are integrated step by step, not by the closed form that the reduction inverts.
    """
    rng = np.random.default_rng(truth.seed + 1)
    time, speed = 0.5, truth.speed
    found: list[tuple[float, float, float]] = []
    while speed > truth.slowest and len(found) < 25 and time < 9.0:
        e = min(truth.restitution * speed**-truth.power, 0.98) * math.exp(0.002 * rng.normal())
        found.append((time, speed, e))
        flight, speed = _flight(e * speed, truth)
        time += truth.contact_time + flight
    return found


def _flight(speed: float, truth: SoundTruth) -> tuple[float, float]:
    """Duration of a flight and speed at its end."""
    area = 0.25 * math.pi * truth.diameter**2
    # half of the air that it displaces moves with a sphere (potential flow)
    mass = truth.mass * (1.0 + 0.5 * _AIR / truth.density)
    drag = 0.5 * _AIR * _DRAG * area / mass
    weight = _GRAVITY * (1.0 - _AIR / truth.density) * truth.mass / mass
    time, height, v = 0.0, 0.0, speed
    while True:
        middle = v - 0.5 * _STEP * (weight + drag * v * abs(v))
        slope = weight + drag * middle * abs(middle)
        if height + _STEP * middle < 0.0:
            part = -height / (_STEP * middle)
            return time + part * _STEP, -(v - part * _STEP * slope)
        height, v, time = height + _STEP * middle, v - _STEP * slope, time + _STEP


def record(truth: SoundTruth) -> Array:
    """Return the samples of a record, (n,), full scale 1."""
    rng = np.random.default_rng(truth.seed + 2)
    events = bounces(truth)
    time = np.arange(int((events[-1][0] + 0.8) * RATE)) / RATE
    modes = [(rng.uniform(900, 9000), rng.uniform(2e-3, 2e-2), rng.normal()) for _ in range(5)]
    delay = rng.uniform(0.004, 0.012)
    heard = np.zeros(time.size)
    loud_at = [(at, speed**1.2) for at, speed, _ in events]
    loud_at += [(float(at), 0.3) for at in rng.uniform(0.1, events[-1][0], truth.knocks)]
    for at, loud in loud_at:
        for shift, part in ((0.0, 1.0), (delay, truth.echo)):
            tau = time - at - shift
            on = (tau > 0.0) & (tau < 0.15)
            for frequency, decay, amplitude in modes:
                ring = np.sin(2.0 * np.pi * frequency * tau[on]) * np.exp(-tau[on] / decay)
                heard[on] += part * loud * amplitude * ring
    hiss = np.convolve(rng.normal(size=time.size), np.exp(-np.arange(40) / 8.0), "same")
    heard = truth.gain * heard / np.abs(heard).max() + truth.noise * hiss / hiss.std()
    return np.asarray(np.clip(heard, -1.0, 1.0))


def write_wav(samples: Array, path: Path) -> None:
    """Write a record as 16-bit WAV."""
    with wave.open(str(path), "wb") as out:
        out.setnchannels(1)
        out.setsampwidth(2)
        out.setframerate(RATE)
        out.writeframes((samples * 32767).astype("<i2").tobytes())
