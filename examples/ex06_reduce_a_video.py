"""A high-speed video to numbers: speeds before and after the contact, with their uncertainty."""

# %% A made-up clip of a ball, so that the truth is known: a folder of pictures, 20 000 a second.
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from dentscope.reduce.kinds import load_kind
from matplotlib.image import imsave

RATE, PIXEL = 20_000.0, 2e-4  # frames a second; metres a pixel
DOWN, UP, TOUCH = 3.0, 1.8, 60.3  # metres a second; the frame of the contact
ROWS, COLUMNS, RADIUS, FLAT = 160, 96, 20.0, 150.0  # pixels


def frame(number: int, noise: np.random.Generator) -> np.ndarray:
    t = (number - TOUCH) / RATE
    fallen = (DOWN if t < 0 else -UP) * t + 0.5 * 9.81 * t**2
    middle = FLAT - RADIUS + fallen / PIXEL
    y, x = np.mgrid[:ROWS, :COLUMNS] + 0.5
    inside = np.clip(RADIUS - np.hypot(x - COLUMNS / 2, y - middle) + 0.5, 0.0, 1.0)
    return np.clip(40 + 160 * inside + noise.normal(0.0, 2.0, inside.shape), 0, 255)


# %% Reduced by the same function as `dentscope reduce video`.
with TemporaryDirectory() as name:
    folder, noise = Path(name), np.random.default_rng(1)
    for number in range(140):
        grey = frame(number, noise).astype(np.uint8)
        imsave(folder / f"{number:03d}.png", np.dstack([grey] * 3))
    options = {"frame_rate_hz": RATE, "pixel_m": PIXEL, "shape": "sphere"}
    reduced = load_kind("video").run(folder, options, source="example")
for key, value in reduced.values.items():
    print(f"{key} = {value}")
print(f"truth: {DOWN} m/s down, {UP} m/s up, restitution {UP / DOWN}")
