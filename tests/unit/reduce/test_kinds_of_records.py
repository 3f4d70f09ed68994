"""Records of every kind: read right, less sure, or refused for the reason."""

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
from dentscope.reduce.table.pulse import find_pulse
from dentscope.studies.synthetic.tracks import TrackTruth, seen
from made_records import RATE, T, half_sine, recorded, run, table
from scipy.signal import lfilter, lsim

AREA = 2 / np.pi * 800.0 * 4e-3
"""Of the pulse alone [N s]."""


def after(at):
    return np.maximum(T - at, 0.0)


@pytest.mark.parametrize(
    "edge",
    [
        700.0 * (T > 0.02) * (T < 0.03) * (1.0 - after(0.02) / 0.02),  # a reset, and a slow decay
        700.0 * np.clip(after(0.02) / 0.01, 0.0, 1.0) * (T < 0.03),  # a ramp that is cut off
        700.0 * (T > 0.02) * np.exp(-after(0.02) / 3e-3),  # a filter that settles
        700.0 * (T > 0.02) * np.exp(-after(0.02) / 4e-4),  # three samples above its half
        700.0 * np.clip(after(0.02) / 7e-4, 0.0, 1.0) * (T < 0.0208),  # four
        half_sine() * (half_sine() < 500.0),  # a range of 500 N, its excess as 0
        half_sine() - 1000.0 * (half_sine() > 500.0),  # a converter that goes round
    ],
    ids=["reset", "ramp", "settling", "fast", "short ramp", "range", "round"],
)
def test_edges_are_no_pulses(tmp_path, edge):
    with pytest.raises(Refused, match="edge"):
        run(recorded(tmp_path / "a.csv", edge + half_sine(0.0)))


@pytest.mark.parametrize(
    ("between", "end", "head"),
    [("\t", "\n", "Zeit (s)\tKraft (N)"), (";", "\r\n", '"Czas [s]";"Siła [N]"'),
     (";", "\n", "Temps;Force\n(s);(N)"), (",", "\n", '"Time (s)","Force (N)"')],
)  # fmt: skip
def test_quoted_commas_of_other_programs(tmp_path, between, end, head):
    cells = ((f"{t:.4f}", f"{v:.2f}") for t, v in zip(T, half_sine(), strict=True))
    rows = [f'"{t}"{between}"{v}"'.replace(".", ",") for t, v in cells]
    text = end.join([head, *rows])
    (tmp_path / "a.csv").write_bytes(text.encode("utf-8-sig"))
    assert run(tmp_path / "a.csv").values["impulse_N_s"].value == pytest.approx(AREA, abs=0.003)


@pytest.mark.parametrize(
    "level",
    [
        np.where(T < 0.01, 600.0, 0.0) + np.where(T > 0.04, 600.0, 0.0),  # stands, hops, stands
        np.where(T < 0.008, -98.1, 0.0),  # a logger at rest that then falls
        np.where(T < 0.012, 300.0 * np.cos(80.0 * T), 0.0),  # a swing before it lets go
    ],
    ids=["hop", "logger", "swing"],
)
def test_the_zero_is_that_just_before_whatever_came_first(tmp_path, level):
    found = run(recorded(tmp_path / "a.csv", half_sine() + level)).values
    assert abs(found["peak_force_N"].value - 800.0) < 3.0 * found["peak_force_N"].std + 1.0
    assert abs(found["impulse_N_s"].value - AREA) < 3.0 * found["impulse_N_s"].std + 0.002


@pytest.mark.parametrize(
    ("names", "strain_in", "load_in", "given"),
    [
        ("Extension,Load\n(mm),(N)", 50.0, 20.0, {"gauge_length_mm": 50.0, "area_mm2": 20.0}),
        ("Strain,Stress\n(%),(MPa)", 100.0, 1.0, {}),
        ("Strain (%),Load (kN)", 100.0, 0.02, {"area_mm2": 20.0}),
        ("Specimen,steel\nDiameter,6.97,mm\nStrain,Load\n(mm/mm),(kN)", 1.0, 0.0381553,
         {"time": "Strain", "value": "Load"}),
    ],
)  # fmt: skip
def test_tension_in_what_a_machine_writes(tmp_path, names, strain_in, load_in, given):
    strain = np.linspace(0.0, 0.05, 120)
    stress = np.minimum(200e3 * strain, 300.0 * np.maximum(strain / 1.5e-3, 1.0) ** 0.1)  # MPa
    rows = [f"{strain_in * e:.6f},{load_in * s:.6f}" for e, s in zip(strain, stress, strict=True)]
    (tmp_path / "a.csv").write_text("\n".join([names, *rows]))
    found = run(tmp_path / "a.csv", holds="tension", **given).values
    assert found["E_Pa"].value == pytest.approx(200e9, rel=0.03)
    assert found["Sy_Pa"].value == pytest.approx(329e6, rel=0.02)
    if "area_mm2" in given:
        with pytest.raises(InputError, match=r"area_mm2: .*holds a load, and the file names no a"):
            run(tmp_path / "a.csv", holds="tension", **{**given, "area_mm2": None})


@pytest.mark.parametrize("bits", [8, 12, 16])
@pytest.mark.parametrize("cut", [0.55, 0.9])
def test_a_converter_that_is_full_is_seen_through_the_noise(tmp_path, bits, cut):
    value, step = half_sine(long=8e-3, noise=2.0), 1600.0 * cut / 2**bits
    cells = np.round(np.minimum(np.round(value / step), 2 ** (bits - 1) - 1) * step, 4)
    with pytest.raises(Refused, match="clipped"):
        run(recorded(tmp_path / "a.csv", cells))
    whole = np.round(value / step) * step
    assert run(recorded(tmp_path / "b.csv", whole)).values["peak_force_N"].std < 20.0


def heights(folder, time, height):
    cells, times = ([f"{x:.6f}" for x in column] for column in (height, time))
    return table(folder / "a.csv", cells, "time_s,height_m", times)


@pytest.mark.parametrize(("unit", "rate"), [(1.0, 2.0), (0.5, 1.0), (3.0, 1.0)])
def test_heights_that_do_not_fall_name_what_would_fit(tmp_path, unit, rate):
    time = np.arange(0.0, 0.75, 0.004)
    height = np.abs(1.0 - 4.905 * time**2) * np.where(time < 0.4515, 1.0, 0.0)
    late = time - 0.4515
    height = np.where(late > 0.0, 0.8 * 4.429 * late - 4.905 * late**2, height)
    height += np.random.default_rng(2).normal(0.0, 3e-4, time.size)
    path = heights(tmp_path, time / rate, unit * height)
    with pytest.raises(Refused, match="falls with") as told:
        run(path, holds="height")
    size = float(told.value.allowed.split("times ")[1].split()[0])
    assert size == pytest.approx(1.0 / (unit * rate**2), rel=0.02)


@pytest.mark.parametrize("samples", [6, 9, 14])
def test_few_samples_have_the_area_in_the_mean_over_their_phases(samples):
    time = np.arange(0.0, 0.2, 1e-3)
    for at in 0.1 + 1e-3 * np.array([0.1, 0.4, 0.8]):
        s = np.clip((time - at) / (1e-3 * samples), 0.0, 1.0)
        found = find_pulse(time, 100.0 * np.sin(np.pi * s) ** 1.5, source="test").area
        truth = 0.1 * samples * 0.5563  # of sin^1.5, G(5/4) / G(7/4) / sqrt(pi)
        assert abs(found.value - truth) < 2.0 * found.std < 0.03 * truth


def test_what_stays_after_a_pulse_or_swings_before_it_widens_peak_and_time():
    seen = RATE * 30e-3 / (1.0 + RATE * 30e-3)
    drooped = lfilter([seen, -seen], [1.0, -seen], half_sine(noise=0.0)) + half_sine(0.0)
    for value in (drooped, half_sine() + 16.0 * np.sin(2.0 * np.pi * 50.0 * T + 1.1)):
        found = find_pulse(T, value, source="test")
        assert abs(found.peak.value - 800.0) < 2.0 * found.peak.std < 250.0
        assert abs(found.duration.value - 4e-3) < 2.0 * found.duration.std


def test_a_top_that_is_no_parabola_is_less_certain():
    s = np.clip((T - 0.02) / 3e-3, 0.0, 1.0)  # loads slowly, unloads at once
    back = np.clip((T - 0.023) / 1e-3, 0.0, 1.0)
    value = 800.0 * np.where(s < 1.0, np.sin(0.5 * np.pi * s), np.cos(0.5 * np.pi * back))
    found = find_pulse(T, value + half_sine(0.0), source="test").peak
    assert abs(found.value - 800.0) < 2.0 * found.std < 40.0


def test_three_equal_samples_at_a_fine_top_are_a_cut():
    cut = np.minimum(half_sine(long=1.2e-3, noise=0.3), 720.0)
    with pytest.raises(Refused, match="clipped: 3 samples"):
        find_pulse(T, cut, source="test")


def test_a_sensor_that_hardly_rings_widens_the_contact_time():
    """It shows a contact of 8 ms a twentieth too short."""
    time = np.arange(0.0, 0.2, 5e-5)
    force = 100.0 * np.sin(np.pi * np.clip((time - 0.08) / 8e-3, 0.0, 1.0)) ** 1.5
    pace = 2.0 * np.pi / 1.6e-3
    shown = lsim(([pace**2], [1.0, 0.2 * pace, pace**2]), force, time)[1]
    noise = np.random.default_rng(1).normal(0.0, 0.05, time.size)
    found = find_pulse(time, shown + noise, source="test")
    assert 0.03 < 1.0 - found.duration.value / 8e-3 < 2.0 * found.duration.std / 8e-3


@pytest.mark.parametrize(
    ("kind", "given", "said"),
    [
        ("table", {"holds": "force", "first_s": 1.0, "last_s": 0.0},
         r"last_s: 0\.0 \(allowed: later than first_s, 1\)"),
        ("sound", {"first_s": 2.0, "last_s": 2.0}, "later than first_s, 2"),
        ("mocap", {"tip_radius_m": 1e-3, "length_m": 0.1, "first_frame": 9, "last_frame": 8},
         r"last_frame: 8 \(allowed: first_frame, 9, or more"),
        ("mocap", {"tip_radius_m": 1e-3, "length_m": 0.1, "axis": "A"},
         "axis: 'A' .allowed: two markers, as A:B"),
        ("mocap", {"tip_radius_m": 1e-3, "length_m": 0.1, "spin_before_rad_s": "1,2"},
         "spin_before_rad_s: '1,2' .allowed: three numbers"),
    ],
)  # fmt: skip
def test_a_wrong_option_is_told_with_its_name_and_value(tmp_path, kind, given, said):
    with pytest.raises(InputError, match=said):
        load_kind(kind).run(tmp_path / "absent", given, source="command line")


FAST = 1e5
FINE = np.arange(0.0, 0.02, 1.0 / FAST)


def pulse(*, at=0.01, long=1e-3, peak=800.0):
    phase = (FINE - at) / long
    return peak * np.sin(np.pi * np.clip(phase, 0.0, 1.0)) ** 1.5


def noisy(values, spread=2.0):
    return values + np.random.default_rng(4).normal(0.0, spread, values.size)


def swinging():
    late = FINE - 0.005
    return np.where(late > 0.0, 800.0 * np.exp(-late / 8e-3) * np.sin(2500.0 * late), 0.0)


@pytest.mark.parametrize(
    ("record", "words"),
    [
        (np.minimum(pulse(), 500.0), "clipped: .* samples stand at the largest value"),
        (np.minimum(noisy(pulse()), 500.0), "clipped"),
        (np.round(np.minimum(pulse(), 500.0) / 5.0) * 5.0, "clipped"),
        (np.where(FINE > 0.01, 500.0, 0.0) + 0.01 * pulse(), "no impact: looks like a step"),
        (swinging(), "no impact: looks like an oscillation"),
        (np.where(FINE == FINE[900], 800.0, 0.0), "no impact: looks like a spike"),
        (np.zeros(FINE.size), "times the noise"),
        (800.0 * FINE / FINE[-1], "allowed"),
        (sum(pulse(at=at) for at in (4e-3, 8e-3, 12e-3)), "like pulses"),
    ],
    ids=["clipped", "noisy", "stepped", "step", "swing", "spike", "rest", "ramp", "taps"],
)  # fmt: skip
def test_what_is_no_whole_impact_is_refused_with_its_look(record, words):
    with pytest.raises(InputError, match=words):
        find_pulse(FINE, noisy(record, 0.5) if record is not None and "clip" not in words
                   else record, source="record")  # fmt: skip


@pytest.mark.parametrize("power", [1.5, 1.0])
def test_the_ends_of_elastic_and_of_plastic_pulses_are_within_their_errors(power):
    phase = np.clip((FINE - 0.01) / 1e-3, 0.0, 1.0)
    record = 800.0 * np.sin(np.pi * phase) ** power
    for seed in range(5):
        noise = np.random.default_rng(seed).normal(0.0, 1.0, FINE.size)
        found = find_pulse(FINE, record + noise, source="record")
        assert abs(found.start.value - 0.01) < 3.0 * found.start.std
        assert abs(found.duration.value - 1e-3) < 3.0 * found.duration.std
        assert found.duration.std < 0.02e-3


def test_several_pulses_are_named():
    two = find_pulse(FINE, noisy(pulse() + pulse(at=0.004, peak=500.0)), source="record")
    assert any("largest of 2 pulses; others at 0.0045" in note for note in two.notes)
    assert two.peak.value == pytest.approx(800.0, rel=0.02)


def test_volts_counts_and_two_header_lines(tmp_path):
    volts = noisy(pulse()) / 112.0  # a sensor of 8.93 mV/N behind an amplifier of 1000
    lines = ["Logger 7", "sample;channel 1", ";V"]
    lines += [f"{k};{v:.6f}".replace(".", ",") for k, v in enumerate(volts)]
    (tmp_path / "blow.txt").write_text("\n".join(lines))
    given = {"gain": 112.0, "gain_std": 1.12, "rate_hz": FAST}
    found = run(tmp_path / "blow.txt", **given).values
    assert found["peak_force_N"].value == pytest.approx(800.0, rel=0.01)
    assert found["peak_force_N"].std == pytest.approx(8.0, rel=0.3)
    assert found["contact_time_s"].value == pytest.approx(1e-3, rel=0.02)
    for missing, words in (("gain", "holds volts"), ("rate_hz", "counts samples")):
        with pytest.raises(InputError, match=words):
            run(tmp_path / "blow.txt", **{k: v for k, v in given.items() if k != missing})


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
    e = found.values["restitution"].value
    assert 0.5 < e < 0.7
    assert found.values["speed_change_m_s"].value == pytest.approx(2.5 * (1.0 + e))


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
    path = heights(tmp_path, time, height)
    found = run(path, holds="height").values
    sharp = run(path, holds="height", contact_time_s=contact).values
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
    with pytest.raises(InputError, match=r"no restitution is known|no contact with flight"):
        run(heights(tmp_path, t, held), holds="height")


def test_a_contact_that_tells_nothing_is_left_out_of_the_others(monkeypatch):
    found = find_bounces(*BOUNCES, metres=None)
    unsure = replace(found.bounces[1], restitution=Measured(1.5, 1.1))
    mixed = replace(found, bounces=(found.bounces[0], unsure, *found.bounces[2:]))
    monkeypatch.setattr(contacts, "find_bounces", lambda *_, **__: mixed)
    told = contacts.told_bounces(*BOUNCES, metres=None, source="test", allowed="")
    assert told.bounces == (found.bounces[0], *found.bounces[2:])
    assert "no restitution is known: 1.5 ± 1.1 at" in told.notes[-1]
