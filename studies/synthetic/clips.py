"""Clips of a falling and rebounding rod or ball, rendered by supersampling."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.ndimage import gaussian_filter1d

from ...recordings.reduce.measured import Array

_SUPER = 4
_EXPOSURES = 5


@dataclass(frozen=True)
class ClipTruth:
    """What is rendered; lengths in pixels, times in frames unless a unit is named.

    Parameters
    ----------
    shape
        `"rod"` or `"sphere"`.
    rows, columns, frames
        Size of the clip.
    scale
        Size of a pixel [m].
    rate
        Frames per second [1/s].
    approach, rebound
        Speeds of the tip before and after the contact [m/s].
    contact_time
        Duration of the contact; within it the tip follows a sine arc joined to both flights [s].
    half_width, tip_radius
        Of the rod, or the ball's radius twice [pixel].
    lean
        Tilt of the rod, or of a ball's path [rad].
    blur
        Standard deviation of the optical blur [pixel].
    exposure
        Part of the frame's time in which the shutter is open.
    noise
        Standard deviation of the grey values.
    dark, bright
        Grey values of background and body.
    uneven
        Light falls off towards the edges by this part.
    """

    shape: str = "rod"
    rows: int = 160
    columns: int = 48
    frames: int = 240
    scale: float = 2.0e-4
    rate: float = 80_000.0
    approach: float = 4.0
    rebound: float = 1.6
    contact_time: float = 2.5e-4
    half_width: float = 15.0
    tip_radius: float = 15.0
    lean: float = 0.0
    blur: float = 0.9
    exposure: float = 0.6
    noise: float = 4.0
    dark: float = 25.0
    bright: float = 225.0
    uneven: float = 0.0
    gravity: float = 9.81
    surface: float = 130.3
    middle: float = 23.6
    touch: float = 120.37
    seed: int = 0

    @property
    def restitution(self) -> float:
        """Rebound over approach speed."""
        return self.rebound / self.approach

    def tip(self, frame: Array) -> tuple[Array, Array]:
        """Return column and row of the tip on the axis at (fractional) frame numbers, (n,)."""
        t = (np.asarray(frame, dtype=np.float64) - self.touch) / self.rate
        down = np.where(
            t < 0.0,
            self.approach * t + 0.5 * self.gravity * t**2,
            self._after(t),
        )
        drift = down * (np.tan(self.lean) if self.shape == "sphere" else 0.0)
        return self.middle + drift / self.scale, self.surface + down / self.scale

    def _after(self, t: Array) -> Array:
        inside = (
            self.approach
            * np.clip(t, 0.0, self.contact_time)
            * (1.0 - np.clip(t / max(self.contact_time, 1e-30), 0.0, 1.0))
        )
        late = t - self.contact_time
        return np.where(late < 0.0, inside, -self.rebound * late + 0.5 * self.gravity * late**2)


def render(truth: ClipTruth) -> npt.NDArray[np.uint8]:
    """Return the frames, (n, rows, columns)."""
    random = np.random.default_rng(truth.seed)
    light = _light(truth)
    lens = _lens(truth.rows, truth.blur), _lens(truth.columns, truth.blur).T
    frames = np.empty((truth.frames, truth.rows, truth.columns), dtype=np.uint8)
    for number in range(truth.frames):
        cover = lens[0] @ _smeared(truth, number) @ lens[1]
        grey = (truth.dark + (truth.bright - truth.dark) * cover) * light
        grey += random.normal(0.0, truth.noise, grey.shape)
        frames[number] = np.clip(np.rint(grey), 0, 255)
    return frames


def _lens(count: int, blur: float) -> Array:
    """Return the matrix that blurs fine cells and gathers them to pixels, (count, 4 count)."""
    sharp = np.eye(count * _SUPER)
    blurred = gaussian_filter1d(sharp, blur * _SUPER, axis=0, mode="nearest")
    return np.asarray(blurred.reshape(count, _SUPER, -1).mean(axis=1))


def _smeared(truth: ClipTruth, number: int) -> Array:
    """Part of each fine cell that the body covers while the shutter is open."""
    moments = number + truth.exposure * ((np.arange(_EXPOSURES) + 0.5) / _EXPOSURES - 0.5)
    columns, rows = truth.tip(moments)
    total = np.zeros((truth.rows * _SUPER, truth.columns * _SUPER))
    for x, y in zip(columns, rows, strict=True):
        _cover(total, truth, x, y)
    return total / _EXPOSURES


def _cover(total: Array, truth: ClipTruth, x: float, y: float) -> None:
    """Add the cover of a body whose tip is at (x, y); cells below the tip stay empty."""
    low = truth.half_width * abs(np.sin(truth.lean)) + 1.0
    end = int(np.clip((y + low + 1.0) * _SUPER, 0, total.shape[0]))
    dx = ((np.arange(total.shape[1]) + 0.5) / _SUPER - 0.5 - x)[None, :]
    dy = ((np.arange(end) + 0.5) / _SUPER - 0.5 - y)[:, None]
    if truth.shape == "sphere":
        total[:end] += _soft(truth.tip_radius - np.hypot(dx, dy + truth.tip_radius))
        return
    across = dx * np.cos(truth.lean) + dy * np.sin(truth.lean)
    cover = _soft(truth.half_width - np.abs(across))
    # the cap reaches up to where it meets the sides, and a little more where the rod leans
    reach = truth.tip_radius - np.sqrt(max(truth.tip_radius**2 - truth.half_width**2, 0.0))
    first = int(np.clip((y - reach - low - 1.0) * _SUPER, 0, end))
    up = dx * np.sin(truth.lean) - dy[first:] * np.cos(truth.lean)
    cap = np.hypot(across[first:], np.minimum(up - truth.tip_radius, 0.0))
    cover[first:] = np.minimum(cover[first:], _soft(truth.tip_radius - cap))
    total[:end] += cover


def _soft(depth: Array) -> Array:
    """Cover of a fine cell whose centre lies `depth` pixels inside the edge."""
    return np.asarray(np.clip(0.5 + depth * _SUPER, 0.0, 1.0))


def _light(truth: ClipTruth) -> Array:
    rows = np.linspace(-1.0, 1.0, truth.rows)[:, None]
    columns = np.linspace(-1.0, 1.0, truth.columns)[None, :]
    return np.asarray(1.0 - truth.uneven * (0.6 * rows**2 + 0.4 * columns**2 + 0.15 * rows))


def random_truth(seed: int, **given: object) -> ClipTruth:
    """Return a clip with drawn speeds, lean, blur, noise, tip and place of the contact."""
    random = np.random.default_rng(seed)
    half = random.uniform(10.0, 16.0)
    approach = random.uniform(2.0, 5.0)
    truth = ClipTruth(
        approach=approach,
        rebound=approach * random.uniform(0.2, 0.7),
        contact_time=random.uniform(1e-4, 3e-4),
        half_width=half,
        tip_radius=half * float(np.exp(random.uniform(0.0, np.log(8.0)))),
        lean=np.radians(random.uniform(-3.0, 3.0)),
        blur=random.uniform(0.5, 1.8),
        exposure=random.uniform(0.1, 0.9),
        noise=random.uniform(1.0, 8.0),
        uneven=random.uniform(0.0, 0.1),
        surface=random.uniform(125.0, 140.0),
        middle=random.uniform(21.0, 26.0),
        touch=random.uniform(100.0, 130.0),
        seed=seed,
    )
    return replace(truth, **given)  # type: ignore[arg-type]


def write_video(
    frames: npt.NDArray[np.uint8], path: Path, *, container_rate: int = 25, codec: str = "ffv1"
) -> None:
    """Write frames without loss; the container's rate is, as with high-speed cameras, arbitrary."""
    import av

    with av.open(str(path), "w") as container:
        stream = container.add_stream(codec, rate=container_rate)
        stream.height, stream.width = frames.shape[1:]
        stream.pix_fmt = "gray" if codec == "ffv1" else "yuv420p"
        for frame in frames:
            container.mux(stream.encode(av.VideoFrame.from_ndarray(frame, format="gray")))
        container.mux(stream.encode())


def write_pictures(frames: npt.NDArray[np.uint8], folder: Path) -> None:
    """Write frames as `1.png`, `2.png` ... into a folder."""
    from skimage.io import imsave

    folder.mkdir(parents=True, exist_ok=True)
    for number, frame in enumerate(frames, start=1):
        imsave(folder / f"{number}.png", frame, check_contrast=False)
