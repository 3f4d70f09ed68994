"""Clips of a falling and rebounding rod or ball, rendered by supersampling.

A rod is seen over the few milliseconds around its contact, a ball over whole flights through air
(studies/synthetic/tracks.py). What a camera adds: optical blur that differs from top to bottom, the
blur of motion under a shutter that does not let in light evenly, a scale that drifts with height,
rows that are exposed one after the other, the body's reflection in the flat, frames that are shown
twice for one that was dropped, glints that stand for the body in some frames.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.ndimage import gaussian_filter1d

from ...core.arrays import Array
from .tracks import TrackTruth, fly, random_track

_SUPER = 4
_EXPOSURES = 5


@dataclass(frozen=True)
class ClipTruth:
    """What is rendered; lengths in pixels, times in frames unless a unit is named.

    - `shape`: `"rod"` or `"sphere"`.
    - `rows`, `columns`, `frames`: size of the clip.
    - `scale`: size of a pixel [m].
    - `rate`: frames per second [1/s].
    - `approach`, `rebound`: speeds of the tip before and after the contact [m/s].
    - `contact_time`: duration of the contact [s]; within it the tip follows two quarters of a sine,
      slowed down at first and then pushed up, so that its speed nowhere jumps.
    - `half_width`, `tip_radius`: of the rod, or the ball's radius twice [pixel].
    - `lean`: tilt of the rod, or of a ball's path [rad].
    - `blur`: standard deviation of the optical blur [pixel].
    - `exposure`: part of the frame's time in which the shutter is open.
    - `noise`: standard deviation of the grey values.
    - `dark`, `bright`: grey values of background and body.
    - `uneven`: light falls off towards the edges by this part.
    - `ball`: what the path is, if it is that of a ball in air; its size and scale are those of the
      clip.
    - `drift`: relative change of the scale from the flat to the highest point (bend, bow).
    - `line_time`: from one row to the next of a shutter that rolls down [s].
    - `mirror`: brightness of the reflection in the flat, in that of the body.
    - `blur_tilt`: relative growth of the blur from the upper to the lower edge.
    - `flicker`: spread of the slope of the light over one exposure, from frame to frame.
    - `dropped`, `glints`: share of frames in which the one before is shown again; in which
      something bright is in the way.
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
    ball: TrackTruth | None = None
    drift: tuple[float, float] = (0.0, 0.0)
    line_time: float = 0.0
    mirror: float = 0.0
    blur_tilt: float = 0.0
    flicker: float = 0.0
    dropped: float = 0.0
    glints: float = 0.0
    seed: int = 0

    @property
    def restitution(self) -> float:
        """Rebound over approach speed."""
        return self.rebound / self.approach

    def tip(self, frame: Array) -> tuple[Array, Array]:
        """Return column and row of the tip on the axis at (fractional) frame numbers, (n,)."""
        row = self._row(np.asarray(frame, dtype=np.float64))
        for _ in range(4 if self.line_time else 0):  # exposed when the shutter has come there
            row = self._row(frame + self.line_time * self.rate * row)
        drift = (row - self.surface) * (np.tan(self.lean) if self.shape == "sphere" else 0.0)
        return self.middle + drift, row

    def _row(self, frame: Array) -> Array:
        height = self._height(frame)
        if any(self.drift):
            z = height / self.reach
            height = height * (1.0 + self.drift[0] * z + self.drift[1] * z**2)
        return np.asarray(self.surface - height / self.scale)

    @cached_property
    def _flights(self) -> list[tuple[float, float, Any]]:
        return [] if self.ball is None else fly(self.ball)[0]

    @property
    def reach(self) -> float:
        """Largest height above the flat [m]."""
        if self.ball is not None:
            return self.ball.drop
        return self.approach * self.touch / self.rate

    def _height(self, frame: Array) -> Array:
        """Return the height above the flat at frame numbers, (n,) [m]."""
        if self.ball is not None:
            t = frame / self.rate
            y = np.where(t < self.ball.held, self.ball.drop, 0.0)
            for start, end, path in self._flights:
                inside = (t >= start) & (t <= end)
                if inside.any():
                    y[inside] = path(t[inside])[0]
            return y
        t = (frame - self.touch) / self.rate
        late = t - self.contact_time
        falling = -self.approach * t - 0.5 * self.gravity * t**2
        rising = self.rebound * late - 0.5 * self.gravity * late**2
        return np.where(t < 0.0, falling, np.where(late > 0.0, rising, -self._within(t)))

    def _within(self, t: Array) -> Array:
        """Return the depth at times from the touch within the contact, (n,) [m]."""
        down = self.contact_time * self.restitution / (1.0 + self.restitution)
        up = self.contact_time - down
        deepest = 2.0 * down * self.approach / np.pi
        inside = np.clip(t, 0.0, self.contact_time)
        phase = np.where(inside < down, inside / down - 1.0, (inside - down) / up)
        return np.asarray(deepest * np.cos(0.5 * np.pi * phase))


def render(truth: ClipTruth) -> npt.NDArray[np.uint8]:
    """Return the frames, (n, rows, columns)."""
    random = np.random.default_rng(truth.seed)
    light = _light(truth)
    lens = _lens(truth.rows, truth.blur, truth.blur_tilt), _lens(truth.columns, truth.blur).T
    frames = np.empty((truth.frames, truth.rows, truth.columns), dtype=np.uint8)
    for number in range(truth.frames):
        if number and random.random() < truth.dropped:
            frames[number] = frames[number - 1]
            continue
        cover = lens[0] @ _smeared(truth, number, random.normal(0.0, truth.flicker)) @ lens[1]
        if random.random() < truth.glints:
            cover = np.maximum(cover, _glint(truth, number, random))
        grey = (truth.dark + (truth.bright - truth.dark) * cover) * light
        grey += random.normal(0.0, truth.noise, grey.shape)
        frames[number] = np.clip(np.rint(grey), 0, 255)
    return frames


def _lens(count: int, blur: float, tilt: float = 0.0) -> Array:
    """Return the matrix that blurs fine cells and gathers them to pixels, (count, 4 count)."""
    sharp = np.eye(count * _SUPER)
    ends = [
        gaussian_filter1d(sharp, blur * _SUPER * (1.0 + part), axis=0, mode="nearest")
        .reshape(count, _SUPER, -1).mean(axis=1)
        for part in ((0.0, tilt) if tilt else (0.0,))
    ]  # fmt: skip
    share = np.linspace(0.0, 1.0, count)[:, None]
    return np.asarray(ends[0] * (1.0 - share) + ends[-1] * share)


def _smeared(truth: ClipTruth, number: int, slope: float) -> Array:
    """Part of each fine cell that the body covers while the shutter is open."""
    place = (np.arange(_EXPOSURES) + 0.5) / _EXPOSURES - 0.5
    columns, rows = truth.tip(number + truth.exposure * place)
    total = np.zeros((truth.rows * _SUPER, truth.columns * _SUPER))
    for x, y, weight in zip(columns, rows, 1.0 + slope * place, strict=True):
        _cover(total, truth, x, y, weight / _EXPOSURES)
    if truth.mirror:
        flat = round((truth.surface + 0.5) * _SUPER)
        shown = total[max(2 * flat - total.shape[0], 0) : flat][::-1]
        total[flat : flat + len(shown)] += truth.mirror * shown
    return total


def _glint(truth: ClipTruth, number: int, random: np.random.Generator) -> Array:
    """Light of something else beside the body, (rows, columns)."""
    x, y = (float(v[0]) for v in truth.tip(np.array([float(number)])))
    size = random.uniform(0.2, 0.6) * truth.half_width
    x, y = x + random.normal(0.0, truth.half_width), y + random.normal(0.0, truth.half_width)
    rows, columns = np.ogrid[: truth.rows, : truth.columns]
    return np.asarray(np.exp(-0.5 * ((rows - y) ** 2 + (columns - x) ** 2) / size**2))


def _cover(total: Array, truth: ClipTruth, x: float, y: float, weight: float) -> None:
    """Add the cover of a body whose tip is at (x, y); cells below the tip stay empty."""
    low = truth.half_width * abs(np.sin(truth.lean)) + 1.0
    end = int(np.clip((y + low + 1.0) * _SUPER, 0, total.shape[0]))
    dx = ((np.arange(total.shape[1]) + 0.5) / _SUPER - 0.5 - x)[None, :]
    dy = ((np.arange(end) + 0.5) / _SUPER - 0.5 - y)[:, None]
    if truth.shape == "sphere":
        first = int(np.clip((y - 2.0 * truth.tip_radius - 2.0) * _SUPER, 0, end))
        away = np.hypot(dx, dy[first:] + truth.tip_radius)
        total[first:end] += weight * _soft(truth.tip_radius - away)
        return
    across = dx * np.cos(truth.lean) + dy * np.sin(truth.lean)
    cover = _soft(truth.half_width - np.abs(across))
    # the cap reaches up to where it meets the sides, and a little more where the rod leans
    reach = truth.tip_radius - np.sqrt(max(truth.tip_radius**2 - truth.half_width**2, 0.0))
    first = int(np.clip((y - reach - low - 1.0) * _SUPER, 0, end))
    up = dx * np.sin(truth.lean) - dy[first:] * np.cos(truth.lean)
    cap = np.hypot(across[first:], np.minimum(up - truth.tip_radius, 0.0))
    cover[first:] = np.minimum(cover[first:], _soft(truth.tip_radius - cap))
    total[:end] += weight * cover


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


def with_faults(truth: ClipTruth) -> ClipTruth:
    """Return a clip with every fault that a camera of its kind has, mildly and at once."""
    random = np.random.default_rng((truth.seed, 1))
    bend = random.uniform(-0.03, 0.03) * min(truth.reach / 0.1, 1.0)
    return replace(
        truth,
        drift=(bend, random.uniform(-0.5, 0.5) * bend),
        # the rows of a fast camera are read within a frame
        line_time=float(random.choice([0.0, 0.0, 0.5 / truth.rate / truth.rows])),
        mirror=random.uniform(0.0, 0.3),
        blur_tilt=random.uniform(0.0, 0.3),
        flicker=random.uniform(0.0, 0.3),
        dropped=random.uniform(0.0, 0.05),
        glints=float(random.choice([0.0, 0.02, 0.05])),
    )


def random_ball(seed: int) -> ClipTruth:
    """Return a clip of a ball in air: a table-tennis ball, a marble or a rubber ball."""
    random = np.random.default_rng((seed, 2))
    path = random_track(
        seed, drop=random.uniform(0.15, 0.35), span=0.9, restitution=random.uniform(0.5, 0.9),
        held=random.uniform(0.0, 0.05),
    )  # fmt: skip
    rows, radius = 200, random.uniform(8.0, 13.0)
    scale = path.drop / (0.97 * rows - 2.0 * radius - 12.0)
    rate = float(random.choice([240.0, 300.0, 480.0]))
    return ClipTruth(
        shape="sphere", rows=rows, columns=64, frames=int(path.span * rate), scale=scale, rate=rate,
        approach=1.0, rebound=path.restitution, contact_time=path.contact_time,
        half_width=radius, tip_radius=radius, lean=np.radians(random.uniform(-2.0, 2.0)),
        blur=random.uniform(0.5, 1.5), exposure=random.uniform(0.05, 0.3),
        noise=random.uniform(1.0, 8.0), uneven=random.uniform(0.0, 0.1), surface=rows - 8.3,
        middle=random.uniform(28.0, 36.0), ball=path, seed=seed,
    )  # fmt: skip


def write_video(frames: npt.NDArray[np.uint8], path: Path, *, container_rate: int = 25) -> None:
    """Write frames without loss; the container's rate is, as with high-speed cameras, arbitrary."""
    import av

    with av.open(str(path), "w") as container:
        stream = container.add_stream("ffv1", rate=container_rate)
        stream.height, stream.width = frames.shape[1:]
        stream.pix_fmt = "gray"
        for frame in frames:
            container.mux(stream.encode(av.VideoFrame.from_ndarray(frame, format="gray")))
        container.mux(stream.encode())


def write_pictures(frames: npt.NDArray[np.uint8], folder: Path) -> None:
    """Write frames as `1.png`, `2.png` ... into a folder."""
    from skimage.io import imsave

    folder.mkdir(parents=True, exist_ok=True)
    for number, frame in enumerate(frames, start=1):
        imsave(folder / f"{number}.png", frame, check_contrast=False)
