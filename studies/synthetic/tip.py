"""Photographs of a tip with a known radius: blur, noise, uneven light, reflections, a worn flat."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from ...core.arrays import Array
from .clips import ClipTruth, render


@dataclass(frozen=True)
class TipTruth:
    """What is photographed; lengths in pixels.

    - `shape`: `"rod"` or `"sphere"`.
    - `radius`, `half_width`: of the tip, of the rod.
    - `lean`: of the rod [rad].
    - `blur`, `noise`: standard deviation of the blur, of the grey values.
    - `uneven`: part by which the light falls off towards the edges of the picture.
    - `reflection`: grey values that a bright stripe along the body adds.
    - `flat`: radius of a flat worn on the apex.
    """

    shape: str = "rod"
    radius: float = 140.0
    half_width: float = 110.0
    lean: float = 0.0
    blur: float = 1.2
    noise: float = 4.0
    uneven: float = 0.05
    reflection: float = 0.0
    flat: float = 0.0
    rows: int = 420
    columns: int = 360
    seed: int = 0


def photograph(truth: TipTruth) -> npt.NDArray[np.uint8]:
    """Return the picture, (rows, columns), a dark body on a bright ground, tip down."""
    middle = truth.columns / 2.0 + 0.3
    bottom = truth.rows - 60.4
    if truth.shape == "sphere":
        bottom = truth.rows / 2.0 + truth.radius
    body = ClipTruth(
        shape=truth.shape, rows=truth.rows, columns=truth.columns, frames=1, touch=0.0,
        half_width=truth.half_width, tip_radius=truth.radius,
        lean=truth.lean, blur=truth.blur, exposure=0.0, noise=0.0, dark=20.0, bright=215.0,
        surface=bottom, middle=middle, seed=truth.seed,
    )  # fmt: skip
    grey = render(body)[0].astype(np.float64)
    if truth.flat > 0.0:
        grey = _worn(grey, truth, bottom)
    columns = np.arange(truth.columns) - middle
    inside = (grey - 20.0) / 195.0
    stripe = np.exp(-0.5 * ((columns + 0.3 * truth.half_width) / (0.1 * truth.half_width)) ** 2)
    dark = 235.0 - (grey - 20.0) + truth.reflection * inside * stripe
    rows = np.linspace(-1.0, 1.0, truth.rows)[:, None]
    across = np.linspace(-1.0, 1.0, truth.columns)[None, :]
    light = 1.0 - truth.uneven * (0.5 * rows**2 + 0.5 * across**2 + 0.4 * across + 0.2 * rows)
    random = np.random.default_rng(truth.seed)
    dark = dark * light + random.normal(0.0, truth.noise, dark.shape)
    return np.asarray(np.clip(np.rint(dark), 0, 255).astype(np.uint8))


def _worn(grey: Array, truth: TipTruth, bottom: float) -> Array:
    """Cut the apex off to a flat of the given radius, blurred like the rest."""
    from scipy.special import ndtr

    height = truth.radius - np.sqrt(truth.radius**2 - truth.flat**2)
    rows = np.arange(truth.rows)[:, None]
    kept = ndtr((bottom - height - rows) / truth.blur)
    return np.asarray(np.minimum(grey, 20.0 + 195.0 * kept))


def random_tip(seed: int, **given: object) -> TipTruth:
    """Return a rod's tip with drawn radius, lean, blur, noise and light."""
    random = np.random.default_rng(seed)
    half = random.uniform(60.0, 120.0)
    truth = TipTruth(
        radius=half * float(np.exp(random.uniform(0.0, np.log(5.0)))),
        half_width=half,
        lean=np.radians(random.uniform(-4.0, 4.0)),
        blur=random.uniform(0.6, 2.5),
        noise=random.uniform(1.0, 8.0),
        uneven=random.uniform(0.0, 0.15),
        reflection=random.uniform(0.0, 40.0),
        seed=seed,
    )
    return replace(truth, **given)  # type: ignore[arg-type]
