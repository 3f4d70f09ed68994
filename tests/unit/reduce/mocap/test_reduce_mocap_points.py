"""Balls followed as one point: rendered, and the table-tennis recipe on its raw file."""

import runpy
from pathlib import Path

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.recordings import audit, read
from dentscope.reduce.gates import Refused
from dentscope.reduce.mocap.kind import reduce
from dentscope.reduce.mocap.options import Options

ROOT = Path(__file__).parents[4]
RAW = ROOT.parent / "shared" / "recordings" / "tabletennis-spin-bounce" / "trajectories.zip"


def _flight(path: Path, *, drag: float = 2.0, noise: float = 5e-4) -> None:
    random = np.random.default_rng(2)
    t = np.arange(80) / 200.0 - 0.2013
    late = np.maximum(t, 0.0)
    height = -3.0 * t - 4.905 * t**2 + (3.0 + 2.4) * late
    along = 4.0 * t - 0.5 * drag * t * np.abs(t) - 0.2 * 5.4 * late
    p = np.stack([0.8 * along, height, -0.6 * along], axis=1) + random.normal(0, noise, (80, 3))
    rows = [f"{a:.5f},{x:.6f},{y:.6f},{z:.6f}" for a, (x, y, z) in zip(t, p, strict=True)]
    path.write_text("\n".join(["time_s,ball_x_m,ball_y_m,ball_z_m", *rows]) + "\n")


def test_a_point_gives_speeds_and_friction(tmp_path):
    _flight(tmp_path / "a.csv")
    spin = Options(shape="sphere", tip_radius_m=0.02, up="y", spin_before_rad_s="60,0,80")
    found = reduce(tmp_path / "a.csv", spin)
    (trial,) = found.trials
    truth = {
        "impact_speed_m_s": 3.0, "approach_tangential_m_s": -4.0, "restitution": 0.8,
        "friction_impulse_ratio": 0.2, "rebound_speed_m_s": 2.4, "tangential_rebound_m_s": -2.92,
    }  # fmt: skip
    for name, value in truth.items():
        measured = trial.observables[name]
        assert abs(measured.value - value) < 4.0 * measured.std, name
        assert measured.value == pytest.approx(value, rel=0.03), name
    # x = (-0.8, 0, 0.6), z = x cross up = (-0.6, 0, -0.8)
    assert trial.observables["approach_spin_rad_s"].value == pytest.approx(-100.0, rel=0.02)
    assert found.noise["frame_rate_hz"] == pytest.approx(200.0, rel=1e-3)
    found.draw(tmp_path / "picture.png")
    assert (tmp_path / "picture.png").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("wrong", "by", "told"),
    [*(({k: v}, Refused, "falls with")
       for k, v in (("unit", "cm"), ("unit", "mm"), ("frame_rate_hz", 50.0))),
     ({"up": "-y"}, InputError, "no bounce with a flight")],
)  # fmt: skip
def test_a_point_that_does_not_fall_or_bounce_is_refused(tmp_path, wrong, by, told):
    _flight(tmp_path / "a.csv")
    given = {"shape": "sphere", "tip_radius_m": 0.02, "up": "y", **wrong}
    with pytest.raises(by, match=told):
        reduce(tmp_path / "a.csv", Options(**given))


@pytest.mark.skipif(not RAW.exists(), reason="the raw recordings are not beside the checkout")
def test_table_tennis_recipe_makes_a_sound_set(tmp_path):
    path = ROOT / "data" / "recordings" / "recipes" / "tabletennis_spin.py"
    made, left_out = runpy.run_path(str(path))["recipe"](RAW, tmp_path / "set", 12)
    assert made >= 9
    assert len(left_out) <= 3
    found = read(tmp_path / "set")
    e = found.values("restitution")
    # the rules of the game ask a table for a rebound of about 23 cm from 30 cm: e = 0.88
    assert 0.85 < np.median(e) < 0.97
    assert np.all(e < 1.05)
    # spins up to some hundred rad/s, position noise of 1 to 3 mm (SOURCE.md)
    assert 50.0 < np.nanmax(np.abs(found.trials.approach_spin_rad_s)) < 500.0
    assert not [f for f in audit(found).findings if f.severity.value == "contradiction"]
