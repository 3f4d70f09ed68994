"""The impulse under a force trace against the momentum change, on half sines of known area."""

from pathlib import Path

import numpy as np
import pytest
from dentscope.core.rig import Quantity, StrikerTable, TargetTable
from dentscope.recordings import RecordingSet, SetFile, Trials
from dentscope.recordings.checks.findings import Severity
from dentscope.recordings.checks.trace import check_trace

MASS, SPEED, TIME, E = 0.05, 2.0, 1e-4, 0.6


def judged(folder: Path, *, scale: float, restitution: float | None, upto: float = 1.0):
    impulse = MASS * ((1.0 + E) * SPEED + 9.81 * TIME)
    t = np.linspace(0.0, upto * TIME, 401)
    force = scale * impulse * np.pi / (2.0 * TIME) * np.sin(np.pi * t / TIME)
    path = folder / "a.csv"
    rows = [f"{a!r},{b!r}" for a, b in zip(t.tolist(), force.tolist(), strict=True)]
    path.write_text("time_s,force_N\n" + "\n".join(rows) + "\n")
    return check_trace(set_of(path, restitution))


def set_of(trace: Path, restitution: float | None) -> RecordingSet:
    ball = StrikerTable(
        shape="sphere", tip_radius_m=Quantity(value=0.0115, std=0.0),
        mass_kg=Quantity(value=MASS, std=1e-5), E_Pa=Quantity(value=2e11, std=0.0), nu=0.3,
        Sy_Pa=Quantity(value=7e8, std=0.0),
    )  # fmt: skip
    setup = SetFile(
        format="recording-set/1", target=TargetTable(E_Pa=2e11, nu=0.3, Sy_Pa=3e8),
        strikers={"ball": ball},
        noise={"impact_speed_relative": 0.005, "force_N_relative": 0.005, "restitution": 0.005},
    )  # fmt: skip
    observables = {} if restitution is None else {"restitution": np.array([restitution])}
    trials = Trials(
        trial=("a",), striker=("ball",), angle_deg=np.array([90.0]),
        impact_speed_m_s=np.array([SPEED]), drop_height_m=np.array([np.nan]),
        observables=observables,
    )  # fmt: skip
    return RecordingSet(setup, trials, traces={"a": trace})


@pytest.mark.parametrize(
    ("scale", "restitution", "severity"),
    [
        (1.0, E, Severity.CONSISTENT),
        (1.015, E, Severity.CONSISTENT),
        (1.1, E, Severity.CONTRADICTION),
        (0.9, E, Severity.CONTRADICTION),
        # without a restitution, anything from 1/1.6 to 2/1.6 of the true impulse may be
        (1.0, None, Severity.CONSISTENT),
        (0.7, None, Severity.CONSISTENT),
        (0.5, None, Severity.CONTRADICTION),
        (1.4, None, Severity.CONTRADICTION),
    ],
)
def test_impulse_of_a_half_sine(tmp_path, scale, restitution, severity):
    (finding,) = judged(tmp_path, scale=scale, restitution=restitution)
    assert finding.severity is severity
    # 2/pi F T of the half sine, by the trapezoidal rule of 400 panels
    assert finding.value == pytest.approx(scale * 0.05 * (1.6 * 2.0 + 9.81e-4), rel=1e-4)


def test_trace_that_stops_under_load_is_not_judged(tmp_path):
    (finding,) = judged(tmp_path, scale=1.0, restitution=E, upto=0.7)
    assert finding.severity is Severity.UNCHECKED
    assert "ends at 81% of its peak" in finding.message


def test_a_trace_of_the_motion_alone_is_not_judged(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("time_s,tip_height_m\n0.0,0.0\n1e-5,1e-6\n")
    assert check_trace(set_of(path, E)) == []
