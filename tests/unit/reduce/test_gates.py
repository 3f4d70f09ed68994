"""Gates: what a reduction sees passes, widens or refuses; records of kinds that went wrong."""

from dataclasses import replace

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.reduce.bounces import contacts
from dentscope.reduce.bounces.contacts import find_bounces
from dentscope.reduce.bounces.fall import UNKNOWN
from dentscope.reduce.bounces.track import Track
from dentscope.reduce.gates import Refused, is_restitution
from dentscope.reduce.kinds import load_kind
from dentscope.reduce.measured import Measured
from dentscope.studies.synthetic.tracks import TrackTruth, seen
from made_records import T, half_sine, recorded, run, table

_TRACK = seen(TrackTruth(rate=500.0, noise=0.1, restitution=0.8))
BOUNCES = Track(_TRACK.time, _TRACK.height), UNKNOWN


def noise(std=1.0, seed=3):
    return np.random.default_rng(seed).normal(0.0, std, T.size)


def test_missing_rows_within_a_pulse_are_a_hole(tmp_path):
    value = half_sine()
    kept = (value < 700.0) | (T < 0.021)
    times = [f"{t:.4f}" for t in T[kept]]
    with pytest.raises(Refused, match="no sample for"):
        run(table(tmp_path / "a.csv", value[kept], times=times))


def test_a_refusal_draws_the_record(tmp_path, errs):
    path = recorded(tmp_path / "a.csv", noise())
    told = errs("reduce", "table", path, "--holds", "force", "--out", tmp_path / "out")
    assert (tmp_path / "out/a-table-refused.png").stat().st_size > 5000
    assert "times the noise" in told


def test_a_restitution_outside_0_to_1_is_refused(tmp_path):
    path = recorded(tmp_path / "a.csv", half_sine())
    with pytest.raises(Refused, match="asks for a restitution of 3"):
        run(path, mass_kg=0.5, approach_speed_m_s=1.0)
    found = run(path, mass_kg=0.5, approach_speed_m_s=2.5)
    assert 0.5 < found.values["restitution"].value < 0.7


def soft_ball(contact, *, rate, e=0.82, v=4.852, seed=1):
    """Heights of a spring with a dashpot that bounces: its truth, contact by contact."""
    omega = np.pi / contact
    damped = -np.log(e) / contact
    frames = np.arange(0.0, 3.0, 1.0 / rate)
    seen = np.random.default_rng(seed).random(frames.size) > 0.2
    time, height, at = frames[seen], np.zeros(seen.sum()), v / 9.81
    fall = time < at
    height[fall] = 0.5 * v**2 / 9.81 - 0.5 * 9.81 * time[fall] ** 2
    while v > 1.5:
        tau = time - at
        held = (tau >= 0.0) & (tau < contact)
        height[held] = -v / omega * np.exp(-damped * tau[held]) * np.sin(omega * tau[held])
        at, v = at + contact, e * v
        up = (time >= at) & (time < at + 2.0 * v / 9.81)
        height[up] = v * (time[up] - at) - 0.5 * 9.81 * (time[up] - at) ** 2
        at += 2.0 * v / 9.81
    kept = time < at
    noisy = height[kept] + np.random.default_rng(seed + 1).normal(0.0, 3e-4, kept.sum())
    return time[kept], noisy


@pytest.mark.parametrize(("contact", "rate"), [(0.015, 240.0), (0.009, 300.0), (0.02, 200.0)])
def test_a_soft_contact_is_no_flight(tmp_path, contact, rate):
    time, height = soft_ball(contact, rate=rate)
    rows = [f"{t:.6f},{h:.6f}" for t, h in zip(time, height, strict=True)]
    (tmp_path / "a.csv").write_text("\n".join(["time_s,height_m", *rows]))
    kind = load_kind("table")
    found = kind.run(tmp_path / "a.csv", {"holds": "height"}, source="test").values
    known = {"holds": "height", "contact_time_s": contact}
    sharp = kind.run(tmp_path / "a.csv", known, source="test").values
    for numbers in (found, sharp):
        speed, ratio = (numbers[f"bounce1_{n}"] for n in ("impact_speed_m_s", "restitution"))
        assert abs(speed.value - 4.852) < 3.0 * speed.std + 0.005
        assert abs(ratio.value - 0.82) < 3.0 * ratio.std + 0.001
    both = [n["bounce1_impact_speed_m_s"] for n in (found, sharp)]
    assert both[0].value != both[1].value
    assert both[1].std < both[0].std


@pytest.mark.parametrize(
    ("forwards", "steps", "lift"),
    [(1400.0, 0.9, 40.0), (0.0, 0.6, 250.0), (2800.0, 1.4, 90.0), (900.0, 0.0, 0.0)],
    ids=["walks", "squats", "runs", "rides"],
)
def test_who_walks_does_not_fall(tmp_path, forwards, steps, lift):
    rng = np.random.default_rng(7)
    time = np.arange(0.0, 2.5, 0.01)
    names = [f"m{k}_{a}_mm" for k in range(5) for a in "xyz"]
    columns = []
    for k in range(5):
        turn = 2 * np.pi * steps * time + rng.uniform(0.0, 2 * np.pi)
        swing = 150.0 * np.sin(turn)
        up = 300.0 + 250.0 * k + lift * np.abs(np.sin(turn))
        columns += [forwards * time + swing, 100.0 * k + 0.1 * swing, up]
    table = np.stack(columns, axis=1) + rng.normal(0.0, 0.3, (time.size, 15))
    head = ",".join(["time_s", *names])
    np.savetxt(tmp_path / "walk.csv", np.column_stack([time, table]), "%.4f", ",", header=head,
               comments="")  # fmt: skip
    with pytest.raises(ValueError, match=r"free flight|falls with|rigid|no impact|restitution"):
        load_kind("mocap").run(tmp_path / "walk.csv", {"shape": "body"}, source="test")


@pytest.mark.parametrize(
    ("e", "std", "known"),
    [(0.8, 0.02, True), (0.2, 0.09, True), (0.2, 0.11, False), (1.5, 1.1, False),
     (0.9, 0.3, False), (1.05, 0.02, True), (1.07, 0.02, False), (-0.1, 0.02, False)],
)  # fmt: skip
def test_what_a_restitution_is(e, std, known):
    assert is_restitution(Measured(e, std)) == known


@pytest.mark.parametrize("seed", [2, 5, 8])
def test_what_is_let_down_in_steps_does_not_bounce(tmp_path, seed):
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 3.0, 1.0 / 230.0)
    held = 1.0 - 0.1 * np.floor(2.7 * t) + 3e-3 * np.sin(8.0 * t) + 2e-3 * rng.normal(size=t.size)
    rows = (f"{s:.5f},{h:.6f}" for s, h in zip(t, held, strict=True))
    (tmp_path / "a.csv").write_text("\n".join(["time_s,height_m", *rows]))
    with pytest.raises(InputError, match=r"no restitution is known|no contact with flight"):
        load_kind("table").run(tmp_path / "a.csv", {"holds": "height"}, source="test")


def test_a_contact_that_tells_nothing_is_left_out_of_the_others(monkeypatch):
    found = find_bounces(*BOUNCES, metres=None)
    unsure = replace(found.bounces[1], restitution=Measured(1.5, 1.1))
    mixed = replace(found, bounces=(found.bounces[0], unsure, *found.bounces[2:]))
    monkeypatch.setattr(contacts, "find_bounces", lambda *_, **__: mixed)
    told = contacts.told_bounces(*BOUNCES, metres=None, source="test", allowed="")
    assert told.bounces == (found.bounces[0], *found.bounces[2:])
    assert "no restitution is known: 1.5 ± 1.1 at" in told.notes[-1]
