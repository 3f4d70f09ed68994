"""The impulse that fits a trial best, against scipy's own least squares; growth of an audit."""

import math
import sys
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from dentscope.core.rig import StrikerTable
from dentscope.recordings import audit, read
from dentscope.recordings.checks.momentum import MomentumTrials, momentum_misfit
from dentscope.recordings.rules import RULES
from scipy.optimize import least_squares

ROD = StrikerTable(
    shape="rod", tip_radius_m=8.8e-3, radius_m=8.8e-3, length_m=0.3048, mass_kg=0.4607
)
BALL = StrikerTable(shape="sphere", tip_radius_m=8.8e-3, mass_kg=0.02)
NAMES = (
    "restitution", "friction_impulse_ratio", "rebound_spin_rad_s", "rebound_speed_m_s",
    "tangential_rebound_m_s",
)  # fmt: skip


def after(body, angle, normal, tangential, spin, px, py):
    """Rigid-body mechanics of one trial, written out once more; the flat is y = 0."""
    rod = body.shape == "rod"
    arm = 0.5 * body.length_m.value if rod else 0.0
    R, m = body.tip_radius_m.value, body.mass_kg.value
    inertia = m * ((2 * arm) ** 2 / 12 + R**2 / 4) if rod else 0.4 * m * R**2
    tip = np.array([-arm * math.cos(angle), -arm * math.sin(angle) - R])
    centre = np.array([tangential, -normal + spin * arm * math.cos(angle)])

    def at_tip(v, w):
        return v + w * np.array([-tip[1], tip[0]])

    v = centre + np.array([px, py]) / m
    w = spin + (tip[0] * py - tip[1] * px) / inertia
    e = -at_tip(v, w)[1] / at_tip(centre, spin)[1]
    return dict(zip(NAMES, (e, abs(px) / py, w, v[1], v[0]), strict=True))


@pytest.mark.parametrize("body", [ROD, BALL], ids=["rod", "ball"])
def test_misfit_is_the_one_that_scipy_finds(body):
    rng, n = np.random.default_rng(5), 40
    angle = rng.uniform(0.3, 1.5, n) if body is ROD else np.full(n, math.pi / 2)
    normal, tangential = rng.uniform(0.5, 4.0, n), rng.uniform(-3.0, 3.0, n)
    spin, arm = rng.uniform(-30.0, 30.0, n), 0.1524 if body is ROD else 8.8e-3
    angle_std = np.full(n, 0.02 if body is ROD else 0.0)
    m = body.mass_kg.value
    impulse = np.stack([rng.uniform(-0.3, 0.3, n), rng.uniform(0.4, 1.8, n)], 1) * m
    impulse *= normal[:, None] * (0.3 if body is ROD else 1.0)
    true = [
        after(body, *given, *p)
        for *given, p in zip(angle, normal, tangential, spin, impulse, strict=True)
    ]
    measured = {}
    for name in NAMES:
        value = np.array([t[name] for t in true])
        std = 0.02 * np.abs(value) + 1e-3
        value += std * rng.standard_normal(n)
        value[rng.random(n) < 0.25] = np.nan
        measured[name] = np.stack([value, std], axis=1)
    found, degrees = momentum_misfit(
        MomentumTrials(
            body, np.stack([angle, angle_std], 1), np.stack([normal, 0.02 * normal], 1),
            tangential, spin, measured,
        )
    )  # fmt: skip
    assert degrees.sum() > n

    for k in range(n):
        known = [name for name in NAMES if np.isfinite(measured[name][k, 0])]
        assert degrees[k] == max(len(known) - 2, 0)
        if len(known) < 3:
            assert found[k] == 0.0
            continue
        unit = {name: normal[k] if name.endswith("_m_s") else 1.0 for name in known}
        unit["rebound_spin_rad_s"] = normal[k] / arm

        def residuals(x, k=k, known=known, unit=unit):
            stretch = 1.0 + 0.02 * x[2]
            got = after(
                body, angle[k] + angle_std[k] * x[3], normal[k] * stretch,
                tangential[k] * stretch, spin[k], x[0] * m, x[1] * m,
            )  # fmt: skip
            left = [x[2], x[3]]
            for name in known:
                value, std = measured[name][k]
                left.append((got[name] - value) / math.hypot(std, RULES.frozen_angle * unit[name]))
            return left

        best = min(
            2.0 * least_squares(residuals, [*start, 0.0, 0.0], x_scale="jac").cost
            for start in (impulse[k] / m, impulse[k] / m * [-1.0, 1.0])
        )
        assert found[k] == pytest.approx(best, rel=1e-5, abs=1e-6)


def test_an_audit_grows_no_faster_than_its_rows(tmp_path):
    source = Path(__file__).parents[4] / "data" / "recordings" / "kharaz-2001-oblique"
    head, *rows = (source / "trials.csv").read_text().splitlines()
    calls, peaks = [], []
    for n in (500, 4000):
        folder = tmp_path / str(n)
        folder.mkdir()
        (folder / "set.toml").write_bytes((source / "set.toml").read_bytes())
        named = [row.split(",", 1) for row in (rows * (n // len(rows) + 1))[:n]]
        lines = [f"{name}-{k},{rest}" for k, (name, rest) in enumerate(named)]
        (folder / "trials.csv").write_text("\n".join([head, *lines]) + "\n")
        found = read(folder)
        count, peak = work_of(lambda found=found: audit(found))
        calls.append(count)
        peaks.append(peak)
    # eight times the rows; what grew with their square would be 64 times as much
    assert calls[1] < 12.0 * calls[0]
    assert peaks[1] < 12.0 * peaks[0]


def work_of(do):
    """Calls and most bytes held while `do` runs: unlike seconds, the same on a busy machine."""
    count = 0

    def counted(_frame, event, _arg):
        nonlocal count
        count += event in ("call", "c_call")

    tracemalloc.start()
    sys.setprofile(counted)
    try:
        do()
    finally:
        sys.setprofile(None)
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    return count, peak
