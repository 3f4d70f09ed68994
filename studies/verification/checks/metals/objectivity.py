"""A superposed rotation turns the stress and changes nothing else."""

from __future__ import annotations

import numpy as np

from .....fem.material import EXACT, RADIAL, log_strain
from ...bench import Bench
from ...material_point import MaterialPoint
from ...result import Measurement, Result

_RADIUS = 0.004
_G = 0.4
_SAMPLES = 300


def run(bench: Bench) -> Result:
    """Rotate the end state of random strain increments and compare the stress."""
    rng = np.random.default_rng(1)
    worst, surface, volume = 0.0, 0.0, 0.0
    for rule in (RADIAL, EXACT):
        for _ in range(_SAMPLES):
            old = _gradient(rng, 0.05)
            b = _elastic_b(rng)
            strain = np.array(log_strain(b)[0])
            new = _after(_gradient(rng, 0.03), old)
            point, elastic = MaterialPoint(_G, radius=_RADIUS, rule=rule), MaterialPoint(_G)
            for one in (point, elastic):
                one.rest(old, b, strain)
            done = point.walk(new, stay=True)
            angle = rng.uniform(-np.pi, np.pi)
            turned = point.walk(_rotated(new, angle), stay=True).e
            worst = max(worst, _difference(done.e, turned, angle) / _RADIUS)
            if done.flows:
                size = _RADIUS * np.exp(3.0 * done.mean)
                surface = max(surface, abs(_norm(done.e) / size - 1.0))
            pure, plain = (elastic.walk(F, stay=True).e for F in (new * 1.01, new))
            volume = max(volume, float(np.abs(np.subtract(pure, plain)).max()) / _RADIUS)
    source = "exact"
    return Result(
        name="objectivity",
        title="Objectivity and yield surface of the stress update",
        about=(
            f"{_SAMPLES} random increments for each of the two stress updates, rotated by a random "
            "angle, followed by a change of volume; relative to the radius of the yield circle."
        ),
        measurements=(
            Measurement("stress of the rotated point, turned back", worst, "", None, 1e-10, source),
            Measurement("distance from the yield surface", surface, "", None, 1e-10, source),
            Measurement("change of the deviator by pure volume", volume, "", None, 1e-10, source),
        ),
    )


def _gradient(rng: np.random.Generator, size: float) -> np.ndarray:
    F = np.array([1.0, 0.0, 0.0, 1.0, 1.0]) + rng.uniform(-size, size, 5)
    return np.asarray(F)


def _after(step: np.ndarray, F: np.ndarray) -> np.ndarray:
    plane = step[:4].reshape(2, 2) @ F[:4].reshape(2, 2)
    return np.append(plane.ravel(), step[4] * F[4])


def _rotated(F: np.ndarray, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.append((np.array([[c, -s], [s, c]]) @ F[:4].reshape(2, 2)).ravel(), F[4])


def _elastic_b(rng: np.random.Generator) -> np.ndarray:
    """Elastic left Cauchy-Green tensor inside the yield surface."""
    strain = rng.uniform(-0.4, 0.4, 4) * _RADIUS
    values, vectors = np.linalg.eigh([[strain[0], strain[2]], [strain[2], strain[1]]])
    plane = vectors @ np.diag(np.exp(2.0 * values)) @ vectors.T
    return np.array([plane[0, 0], plane[1, 1], plane[0, 1], np.exp(2.0 * strain[3])])


def _difference(e: np.ndarray, turned: np.ndarray, angle: float) -> float:
    c, s = np.cos(angle), np.sin(angle)
    Q = np.array([[c, -s], [s, c]])
    plane = Q @ np.array([[e[0], e[2]], [e[2], e[1]]]) @ Q.T
    expected = np.array([plane[0, 0], plane[1, 1], plane[0, 1], e[3]])
    return float(np.abs(expected - np.array(turned)).max())


def _norm(e: np.ndarray) -> float:
    return float(np.sqrt(e[0] ** 2 + e[1] ** 2 + e[3] ** 2 + 2.0 * e[2] ** 2))
