"""Marker tracks of a rod or ball that strikes a flat, with known truth: noise, gaps, mix-ups."""

from __future__ import annotations

import csv
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from ...core.arrays import Array
from ...reduce.mocap.file import Markers

ROD_MARKERS = ((0.009, 0.0, 0.125), (-0.004, 0.008, 0.060), (0.002, -0.009, -0.045))
"""Three markers on the side of a rod, places from its centre of mass, the third axis along it."""


@dataclass(frozen=True)
class MocapTruth:
    """What happens: a plane rigid-body impact of given restitution and impulse ratio.

    - `shape`: `"rod"` or `"sphere"`.
    - `markers`: places on the striker from its centre of mass [m].
    - `length`, `tip_radius`: of the rod between the centres of its tips (0 for a sphere), and of
      the tip [m].
    - `angle`: between axis and flat at the contact (rod) [rad].
    - `normal`, `tangential`, `spin`: approach of the contact point, velocity of the centre along x
      [m/s], spin before [rad/s].
    - `restitution`, `ratio`: of the contact point; tangential over normal impulse, positive along
      +x.
    - `contact_time`: during which the impulse acts evenly [s].
    - `azimuth`: of the plane of motion about the vertical [rad].
    - `rate`, `frames`, `touch`: frames per second, number of frames, instant of first touch [s].
    - `noise`: standard deviation of each coordinate [m].
    - `missing`, `gap`: part of the positions that are lost; frames in which the first marker is
      hidden.
    - `mixed_up`: part of the frames in which one marker is found somewhere else.
    """

    shape: str = "rod"
    markers: tuple[tuple[float, float, float], ...] = ROD_MARKERS
    length: float = 0.3048
    tip_radius: float = 0.0088
    angle: float = np.radians(45.0)
    normal: float = 1.5
    tangential: float = 0.0
    spin: float = 0.0
    restitution: float = 0.6
    ratio: float = 0.2
    contact_time: float = 1.4e-3
    azimuth: float = 0.3
    rate: float = 500.0
    frames: int = 120
    touch: float = 0.1203
    gravity: float = 9.81
    noise: float = 1.5e-4
    missing: float = 0.03
    gap: tuple[int, int] = (0, 0)
    mixed_up: float = 0.0
    seed: int = 0

    @property
    def inertia_over_mass(self) -> float:
        """About the centre of mass, across the axis [m²]."""
        if self.shape == "sphere":
            return 0.4 * self.tip_radius**2
        return self.length**2 / 12.0 + self.tip_radius**2 / 4.0

    @property
    def arm(self) -> tuple[float, float]:
        """How far the contact point lies behind (-x) and below the centre of mass [m]."""
        half = 0.5 * self.length
        return half * float(np.cos(self.angle)), half * float(np.sin(self.angle)) + self.tip_radius

    def changes(self) -> tuple[float, float, float]:
        """Changes of v_x, v_y and spin by the contact (corrected Eqs. 5.2-5.8 of the thesis)."""
        c, s = self.arm if self.shape == "rod" else (0.0, self.tip_radius)
        k = self.inertia_over_mass
        py = (1.0 + self.restitution) * self.normal / (1.0 + c * c / k - self.ratio * c * s / k)
        return self.ratio * py, py, (s * self.ratio * py - c * py) / k

    def values(self) -> dict[str, float]:
        """What a perfect reduction finds, under the names of the columns of trials.csv."""
        c = self.arm[0] if self.shape == "rod" else 0.0
        dx, dy, turn = self.changes()
        fall = -self.normal + self.spin * c
        return {
            "impact_speed_m_s": self.normal,
            "approach_tangential_m_s": self.tangential,
            "approach_spin_rad_s": self.spin,
            "restitution": self.restitution,
            "friction_impulse_ratio": abs(self.ratio),
            "rebound_spin_rad_s": self.spin + turn,
            "rebound_speed_m_s": fall + dy,
            "tangential_rebound_m_s": self.tangential + dx,
        }


def simulate(truth: MocapTruth) -> Markers:
    """Return the marker tracks, vertical along z."""
    random = np.random.default_rng(truth.seed)
    time = np.arange(truth.frames) / truth.rate
    # velocities are those at the middle of the contact
    t = time - truth.touch - 0.5 * truth.contact_time
    c = truth.arm[0] if truth.shape == "rod" else 0.0
    start = np.array([truth.tangential, -truth.normal + truth.spin * c, truth.spin])
    moved = start * t[:, None] + _pushed(t, truth.contact_time)[:, None] * np.array(truth.changes())
    moved[:, 1] -= 0.5 * truth.gravity * t**2
    h = np.array([np.cos(truth.azimuth), np.sin(truth.azimuth), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    normal = np.cross(h, up)
    axis = np.cos(truth.angle) * h + np.sin(truth.angle) * up
    first = np.stack([np.cross(normal, axis), normal, axis], axis=1)
    turn = Rotation.from_rotvec(moved[:, 2:] * normal).as_matrix() @ first
    height = truth.arm[1] if truth.shape == "rod" else truth.tip_radius
    centre = moved[:, :1] * h + (moved[:, 1:2] + height) * up + np.array([0.4, -0.2, 0.0])
    points = centre[:, None] + np.einsum("kij,mj->kmi", turn, np.array(truth.markers))
    points += random.normal(0.0, truth.noise, points.shape)
    for k in np.flatnonzero(random.random(truth.frames) < truth.mixed_up):
        points[k, random.integers(points.shape[1])] += random.uniform(-0.1, 0.1, 3)
    points[random.random(points.shape[:2]) < truth.missing] = np.nan
    points[truth.gap[0] : truth.gap[1], 0] = np.nan
    names = tuple(f"M{i + 1}" for i in range(points.shape[1]))
    return Markers(time, names, points, f"rendered {truth.seed}")


def _pushed(t: Array, contact: float) -> Array:
    """Integral of the part of the impulse that has acted, zero time at half of it."""
    late = np.clip(t + 0.5 * contact, 0.0, contact)
    inside = 0.5 * late**2 / max(contact, 1e-12)
    return np.asarray(np.where(t > 0.5 * contact, t, inside))


def random_rod(seed: int, **given: object) -> MocapTruth:
    """Return a rod with drawn angle, speed, friction, markers, noise and gaps."""
    random = np.random.default_rng(seed)
    angle = np.radians(random.uniform(15.0, 75.0))
    truth = MocapTruth(
        markers=_on_rod(random, int(random.integers(3, 6))),
        angle=float(angle),
        normal=random.uniform(0.8, 3.0),
        restitution=random.uniform(0.3, 0.9),
        ratio=random.uniform(0.02, 0.2),
        contact_time=random.uniform(1e-4, 3e-3),
    )
    return _seen(truth, random, seed, given)


def random_ball(seed: int, **given: object) -> MocapTruth:
    """Return a ball with drawn spin, speeds, friction, markers on its surface and noise."""
    random = np.random.default_rng(seed)
    radius = random.uniform(0.02, 0.05)
    places = random.normal(size=(int(random.integers(4, 8)), 3))
    places *= radius / np.linalg.norm(places, axis=1)[:, None]
    truth = MocapTruth(
        shape="sphere",
        markers=tuple((float(x), float(y), float(z)) for x, y, z in places),
        length=0.0,
        tip_radius=radius,
        normal=random.uniform(1.0, 4.0),
        tangential=-random.uniform(0.5, 3.0),
        spin=random.uniform(-60.0, 60.0),
        restitution=random.uniform(0.4, 0.95),
        ratio=random.uniform(0.05, 0.3),
        contact_time=random.uniform(1e-4, 1e-3),
    )
    return _seen(truth, random, seed, given)


def _seen(
    truth: MocapTruth, random: np.random.Generator, seed: int, given: dict[str, object]
) -> MocapTruth:
    """Draw how a motion is seen; `given` goes first."""
    seen = {
        "azimuth": random.uniform(-np.pi, np.pi), "touch": random.uniform(0.10, 0.14),
        "noise": random.uniform(5e-5, 2e-4), "missing": random.uniform(0.0, 0.06), "seed": seed,
    }  # fmt: skip
    first = int(random.integers(0, 120))
    gap = first, first + int(random.integers(0, 12))
    return replace(truth, **{**seen, "gap": gap, **given})  # type: ignore[arg-type]


def _on_rod(random: np.random.Generator, count: int) -> tuple[tuple[float, float, float], ...]:
    along = np.linspace(-0.08, 0.14, count) + random.uniform(-0.02, 0.02, count)
    around = random.uniform(-np.pi, np.pi, count)
    return tuple(
        (0.009 * float(np.cos(a)), 0.009 * float(np.sin(a)), float(z))
        for a, z in zip(around, along, strict=True)
    )


def write_csv(markers: Markers, path: Path) -> None:
    """Write tracks as a table in millimetres; a marker that was not seen leaves empty cells."""
    header = ["time_s", *(f"{n}_{a}_mm" for n in markers.names for a in "xyz")]
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(header)
        for t, row in zip(markers.time, markers.position, strict=True):
            cells = ["" if np.isnan(v) else f"{1e3 * v:.4f}" for v in row.ravel()]
            writer.writerow([f"{t:.6f}", *cells])


def write_c3d(markers: Markers, path: Path) -> None:
    """Write tracks as C3D in millimetres; a marker that was not seen has a residual of -1."""
    import ezc3d

    content = ezc3d.c3d()
    points = np.ones((4, len(markers.names), markers.time.size))
    points[:3] = 1e3 * np.moveaxis(markers.position, (0, 1, 2), (2, 1, 0))
    unseen = ~np.isfinite(points[:3]).all(axis=0)
    points[:3, unseen] = 0.0
    content["parameters"]["POINT"]["RATE"]["value"] = [markers.rate]
    content["parameters"]["POINT"]["LABELS"]["value"] = list(markers.names)
    content["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
    content["data"]["points"] = points
    content["data"]["meta_points"]["residuals"] = np.where(unseen, -1.0, 0.0)[None]
    content.write(str(path))
