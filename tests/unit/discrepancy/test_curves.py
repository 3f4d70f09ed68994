"""Numbers of traces and profiles, against curves whose numbers are known in closed form."""

import math
from pathlib import Path

import numpy as np
import pytest
from dentscope.core import Material
from dentscope.discrepancy.comparison.forward import Point, Simulator
from dentscope.discrepancy.comparison.problem import problem_of
from dentscope.discrepancy.curves.readings import readings_of, reduced
from dentscope.discrepancy.curves.reduction import from_profile, from_trace
from dentscope.dynamics import Approach, Striker, scene_of
from dentscope.dynamics import traced as trace_of
from dentscope.models import LAWS
from dentscope.recordings import read
from made_sets import BALL, made_set

T, PEAK = 2e-4, 3000.0


def half_sine(samples: int) -> dict[str, np.ndarray]:
    t = np.linspace(-T, 2.0 * T, samples) + 0.37
    phase = np.clip((t - 0.37) / T, 0.0, 1.0)
    return {"time_s": t, "force_N": PEAK * np.sin(math.pi * phase)}


def test_force_of_a_half_sine() -> None:
    found = from_trace(half_sine(600))
    # the parabola through what exceeds 85 % of it: (acos 0.85)^4/24 3/35 = 3.4e-4 at its top
    assert found["peak_force_N"] == pytest.approx(PEAK, rel=6e-4)
    assert found["normal_impulse_Ns"] == pytest.approx(2.0 * PEAK * T / math.pi, rel=3e-3)
    assert found["loading_time_s"] == pytest.approx(0.5 * T, rel=5e-3)
    # the foot of the recovery is drawn as Hertz's 3/2 power, so a sine's end comes out late
    assert found["contact_time_s"] == pytest.approx(T, rel=0.04)
    assert from_trace(half_sine(9)) == {}  # too few samples


def test_height_of_a_spring() -> None:
    # m h'' = -k h while h < 0: in at v, out at v, deepest v/w
    v, w = 1.5, math.pi / T
    t = np.linspace(-3.0 * T, 4.0 * T, 1500)
    h = np.where(t < 0, -v * t, np.where(t > T, v * (t - T), -v / w * np.sin(w * t)))
    found = from_trace({"time_s": t + 5.0, "tip_height_m": h})
    assert found["restitution"] == pytest.approx(1.0, abs=1e-6)
    # a parabola through the lowest 40 % of a sine lies 0.3 % above its end
    assert found["peak_depth_m"] == pytest.approx(v / w, rel=4e-3)
    assert found["below_flat_s"] == pytest.approx(T, rel=1e-3)


def test_noise_goes_through_the_same_reduction() -> None:
    curve, sigma = half_sine(600), 0.01 * PEAK
    said = reduced(curve, {"force_N": sigma}, from_trace, seed=1)["normal_impulse_Ns"][1]
    # a sum of independent samples: sigma dt sqrt(n), n samples within the contact
    dt = float(curve["time_s"][1] - curve["time_s"][0])
    assert said == pytest.approx(sigma * dt * math.sqrt(T / dt), rel=0.35)


def test_profile_of_a_cap() -> None:
    x = np.linspace(-2e-3, 2e-3, 801)
    z = -np.maximum(40e-6 - x**2 / 18e-3, 0.0) + 0.02 * x + 1e-3
    assert from_profile({"x_m": x, "z_m": z})["permanent_depth_m"] == pytest.approx(40e-6, rel=5e-3)


@pytest.fixture
def traced(tmp_path: Path) -> Path:
    """One ball, traces of the baseline's own impacts at a tenth of the contact per sample."""
    ball, flat = (Material(E=2e11, nu=0.3, Sy=Sy) for Sy in (2e9, 3e8))
    (tmp_path / "traces").mkdir()
    rng, speeds = np.random.default_rng(3), (0.5, 1.0, 2.0)
    for k, v in enumerate(speeds):
        striker = Striker(mass=0.004, tip_radius=0.005)
        one = scene_of(
            LAWS["fitted"], sphere=ball, flat=flat, striker=striker, approach=Approach(v)
        )
        impact = trace_of(one, points=200)
        t, first = np.unique(impact.column("time_s"), return_index=True)
        T = impact.impact.contact_time_s
        grid = np.arange(-T, 2.0 * T, T / 10.0) + 0.03 * T
        force = np.interp(grid, t, impact.column("normal_force_N")[first], left=0.0, right=0.0)
        force = force + 0.002 * force.max() * rng.standard_normal(len(grid))
        lines = [f"{a:.9g},{b:.6g}" for a, b in zip(grid, force, strict=True)]
        (tmp_path / "traces" / f"t{k}.csv").write_text("time_s,force_N\n" + "\n".join(lines))
    made_set(
        tmp_path, BALL + "Sy_Pa = 2e9\n", target="Sy_Pa = { value = 3e8, std = 1.2e7 }\n",
        noise="force_N_relative = 0.002\n", angle_deg=[90] * 3, impact_speed_m_s=speeds,
    )  # fmt: skip
    return tmp_path


def test_a_set_of_traces_only_has_cells_that_the_simulation_meets(traced: Path) -> None:
    problem = problem_of(read(traced))
    assert set(problem.cells.observable) == {
        "peak_force_N", "contact_time_s", "loading_time_s", "normal_impulse_Ns",
    }  # fmt: skip
    here = Simulator(problem).predict((), [Point(np.zeros(problem.n_z))])[0]
    # ten samples a contact are off by 5 % and more before the reduction's own error is taken off
    assert np.max(np.abs(problem.cells.value - here) / problem.cells.std) < 4.0


def test_a_column_goes_before_its_trace(traced: Path) -> None:
    text = (traced / "trials.csv").read_text().splitlines()
    text = [text[0] + ",peak_force_N"] + [row + ",1234" for row in text[1:]]
    (traced / "trials.csv").write_text("\n".join(text) + "\n")
    setup = traced / "set.toml"
    setup.write_text(setup.read_text() + "peak_force_N_relative = 0.01\n")
    recordings = read(traced)
    problem = problem_of(recordings)
    scenes = problem.scenes(np.zeros(problem.n_z))
    found, _ = readings_of(recordings, scenes)
    assert np.all(found["peak_force_N"].value == 1234.0)
    assert np.all(np.isfinite(found["contact_time_s"].value))
