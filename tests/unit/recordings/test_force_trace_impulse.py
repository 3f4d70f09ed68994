"""The impulse under a force trace against the momentum change, on half sines of known area."""

import numpy as np
import pytest
from dentscope.recordings.checks.findings import Severity
from dentscope.recordings.checks.motion import check_trace
from made_sets import STEEL, made_set

MASS, SPEED, TIME, E = 0.05, 2.0, 1e-4, 0.6
BALL = f"""shape = "sphere"
tip_radius_m = 0.0115
mass_kg = {{ value = {MASS}, std = 1e-5 }}
{STEEL}Sy_Pa = 7e8
"""
NOISE = "impact_speed_relative = 0.005\nforce_N_relative = 0.005\nrestitution = 0.005\n"


def judged(folder, *, scale=1.0, restitution=E, upto=1.0, trace=None):
    impulse = MASS * ((1.0 + E) * SPEED + 9.81 * TIME)
    t = np.linspace(0.0, upto * TIME, 401)
    force = scale * impulse * np.pi / (2.0 * TIME) * np.sin(np.pi * t / TIME)
    measured = {} if restitution is None else {"restitution": [restitution]}
    return check_trace(made_set(
        folder, BALL, target="Sy_Pa = 3e8\n", noise=f"{NOISE}tip_height_m = 1e-6\n",
        trace=trace or {"time_s": t, "force_N": force}, angle_deg=[90], impact_speed_m_s=[SPEED],
        **measured,
    ))  # fmt: skip


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
    (finding,) = judged(tmp_path, upto=0.7)
    assert finding.severity is Severity.UNCHECKED
    assert "ends at 81% of its peak" in finding.message


def test_a_trace_of_the_motion_alone_is_not_judged(tmp_path):
    heights = {"time_s": [0.0, 1e-5], "tip_height_m": [0.0, 1e-6]}
    assert judged(tmp_path, trace=heights) == []
