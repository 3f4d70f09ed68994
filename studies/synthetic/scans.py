"""Scans of a crater with rim, tilt, drift, roughness, spikes and holes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter

from ...core.arrays import Array
from ...reduce.scan.file import Scan


@dataclass(frozen=True)
class ScanTruth:
    """What is rendered; lengths in metres.

    - `depth`, `radius`: of the crater below the undisturbed surface.
    - `flatness`: κ of its floor d (1 - (1 - κ) x² - κ x⁶), x = r/radius: 0 a paraboloid, above 0 a
      flatter floor and steeper walls.
    - `sliding`: length of the straight part of a scar; 0 for a round crater.
    - `direction`: of the scar [rad].
    - `pile_up`: height of the rim.
    - `tilt`: (2,) slopes.
    - `bow`: height of a paraboloid over the whole scan: drift or form.
    - `roughness`, `correlation`: standard deviation of the surface's roughness and its correlation
      length.
    - `noise`: standard deviation of the instrument.
    - `blur`: standard deviation of the instrument's lateral blur.
    - `spikes`, `holes`: parts of the points.
    """

    depth: float = 30e-6
    radius: float = 400e-6
    flatness: float = 0.0
    sliding: float = 0.0
    direction: float = 0.0
    pile_up: float = 3e-6
    tilt: tuple[float, float] = (0.01, -0.004)
    bow: float = 0.0
    roughness: float = 0.3e-6
    correlation: float = 12e-6
    noise: float = 0.05e-6
    blur: float = 0.0
    spikes: float = 0.002
    holes: float = 0.01
    points: int = 220
    step: float = 9e-6
    offset: tuple[float, float] = (0.0, 0.0)
    seed: int = 0


def true_surface(truth: ScanTruth) -> Array:
    """Return the surface without tilt and errors, (points, points) [m]."""
    x, y = _grid(truth)
    cos, sin = np.cos(truth.direction), np.sin(truth.direction)
    s, t = x * cos + y * sin, -x * sin + y * cos
    reach = np.abs(s) - 0.5 * truth.sliding
    r = np.hypot(np.maximum(reach, 0.0), t)
    # the scar is deepest in its middle and a third shallower at the ends of its straight part
    fade = np.ones_like(s)
    if truth.sliding > 0.0:
        fade = 1.0 - np.minimum(np.abs(s) / (0.5 * truth.sliding), 1.0) ** 2 / 3.0
    x2, k = (r / truth.radius) ** 2, truth.flatness
    inner = -truth.depth * fade * (1.0 - (1.0 - k) * x2 - k * x2**3)
    out = np.maximum(r - truth.radius, 0.0) / (0.15 * truth.radius)
    rim = truth.pile_up * out * np.exp(1.0 - out)
    return np.asarray(np.where(r < truth.radius, inner, rim))


def render(truth: ScanTruth) -> Scan:
    """Return the scan as an instrument would give it."""
    random = np.random.default_rng(truth.seed)
    x, y = _grid(truth)
    z = true_surface(truth)
    if truth.blur > 0.0:
        z = gaussian_filter(z, truth.blur / truth.step, mode="nearest")
    z += truth.tilt[0] * x + truth.tilt[1] * y
    half = 0.5 * truth.points * truth.step
    z += truth.bow * ((x / half) ** 2 + 0.5 * (y / half) ** 2)
    if truth.roughness > 0.0:
        rough = gaussian_filter(random.normal(size=z.shape), truth.correlation / truth.step)
        z += truth.roughness * rough / rough.std()
    z += random.normal(0.0, truth.noise, z.shape)
    spike = random.random(z.shape) < truth.spikes
    z[spike] += random.normal(0.0, 20.0 * truth.roughness + 1e-6, int(spike.sum()))
    z[random.random(z.shape) < truth.holes] = np.nan
    return Scan(z, np.array([truth.step, truth.step]), f"scan {truth.seed}")


def _grid(truth: ScanTruth) -> tuple[Array, Array]:
    line = (np.arange(truth.points) - 0.5 * truth.points) * truth.step
    x, y = np.meshgrid(line - truth.offset[0], line - truth.offset[1], indexing="ij")
    return x, y


def random_truth(seed: int, *, sliding: float = 0.0) -> ScanTruth:
    """Return a scan with drawn depth, size, rim, tilt, blur, roughness, noise and gaps."""
    random = np.random.default_rng(seed)
    depth = float(np.exp(random.uniform(np.log(8e-6), np.log(80e-6))))
    flatness, blur = random.uniform(-0.1, 0.3), random.uniform(0.0, 8e-6)
    return ScanTruth(
        depth=depth,
        radius=random.uniform(250e-6, 420e-6),
        flatness=flatness,
        blur=blur,
        sliding=sliding,
        direction=random.uniform(-1.5, 1.5),
        pile_up=depth * random.uniform(0.0, 0.15),
        tilt=(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02)),
        roughness=depth * random.uniform(0.002, 0.012),
        correlation=random.uniform(5e-6, 25e-6),
        noise=depth * random.uniform(0.0, 0.006),
        spikes=random.uniform(0.0, 0.004),
        holes=random.uniform(0.0, 0.03),
        offset=(random.uniform(-1e-4, 1e-4), random.uniform(-1e-4, 1e-4)),
        seed=seed,
    )
