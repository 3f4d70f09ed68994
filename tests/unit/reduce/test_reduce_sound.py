"""Sound of bounces: flights with drag, runs of instants, rendered records, stop-watch times."""

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from dentscope.core import InputError
from dentscope.recordings import read
from dentscope.reduce.bounces.chain import chain_of
from dentscope.reduce.bounces.fall import Fall
from dentscope.reduce.bounces.options import BounceOptions
from dentscope.reduce.bounces.times import reduce_bounce_times
from dentscope.reduce.kinds import load_kind
from dentscope.reduce.sound.file import read_sound
from dentscope.studies.synthetic.sounds import (
    RATE,
    SoundTruth,
    bounces,
    random_bounces,
    record,
    write_wav,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.io import wavfile

REAL = Path(__file__).parents[4] / "shared" / "recordings" / "ball-bounce-acoustic"
measured = pytest.mark.skipif(not REAL.exists(), reason="the recordings are not here")


@pytest.mark.parametrize(("launch", "terminal"), [(3.0, 9.0), (0.4, 30.0), (8.0, 9.5)])
def test_flight_with_drag_is_the_integrated_one(launch, terminal):
    g = 9.81

    def slope(_t, y):
        return [y[1], -g * (1.0 + y[1] * abs(y[1]) / terminal**2)]

    def ground(_t, y):
        return y[0]

    ground.terminal, ground.direction = True, -1
    flown = solve_ivp(slope, (0.0, 10.0), (0.0, launch), events=ground, rtol=1e-10, atol=1e-12)
    fall = Fall(g, terminal)
    assert fall.duration(launch) == pytest.approx(flown.t_events[0][-1], rel=1e-8)
    assert fall.landing(launch) == pytest.approx(-flown.y_events[0][-1][1], rel=1e-8)
    assert fall.launch(fall.duration(launch)) == pytest.approx(launch, rel=1e-10)
    top = flown.y[0].max()
    assert fall.speed(top, 1.0) == pytest.approx(launch, rel=0.02)


def test_fall_from_rest_is_the_integrated_one():
    # v dv/dx = g (1 - v²/w²)
    height, w = 1.3, 7.0
    flown = solve_ivp(
        lambda _x, u: [2.0 * 9.81 * (1.0 - u[0] / w**2)], (0.0, height), [0.0], rtol=1e-10
    )
    assert Fall(9.81, w).speed(height) == pytest.approx(math.sqrt(flown.y[0, -1]), rel=1e-8)


@settings(max_examples=40, deadline=None)
@given(e=st.floats(0.3, 0.95), first=st.floats(0.2, 1.0), count=st.integers(5, 12), data=st.data())
def test_a_run_is_found_among_echoes_and_with_one_bounce_missed(e, first, count, data):
    instants = np.cumsum(np.concatenate([[0.7], first * e ** np.arange(count)]))
    missed = data.draw(st.integers(2, count - 2))
    echoed = data.draw(st.integers(0, count - 1).filter(lambda k: k != missed))
    after = instants[echoed] + 0.3 * first * e**count
    heard = np.sort(np.append(np.delete(instants, missed), after))
    chain = chain_of(heard)
    whole = {
        (heard[a], heard[b])
        for a, b, one in zip(chain.kept, chain.kept[1:], chain.single, strict=False)
        if one
    }
    true = set(pairwise(instants))
    assert whole <= true
    assert len(chain.kept) >= count - 2


def test_rounding_alone_makes_no_interval_stray():
    instants = np.cumsum(np.concatenate([[0.7], 0.6305 * 0.9296057092335683 ** np.arange(9)]))
    heard = np.delete(instants, 5)
    chain = chain_of(np.sort(np.append(heard, instants[0] + 0.1)))
    assert chain.single == (True, True, True, True, False, True, True, True)


@pytest.mark.parametrize("place", ["first", "last"])
@pytest.mark.parametrize("count", [5, 6, 12])
def test_a_knock_in_place_of_a_bounce_at_an_end_of_the_run(place, count):
    flights = 0.4 * 0.7 ** np.arange(count)
    instants = np.concatenate([[0.0], np.cumsum(flights)])
    k = 0 if place == "first" else -1
    instants[k] += 0.17 * flights[k] * (1 if place == "first" else -1)
    chain = chain_of(instants)
    used = [a for a, one in zip(chain.kept, chain.single, strict=False) if one]
    assert used == list(range(1, count) if place == "first" else range(count - 1))


def test_a_run_whose_restitution_changes_as_a_real_one_keeps_its_ends():
    # a golf ball: 0.883 to 0.898 from bounce to bounce
    e = np.array([0.8975, 0.8941, 0.8913, 0.8832, 0.8982])
    flights = 0.9 * np.concatenate([[1.0], np.cumprod(e)])
    chain = chain_of(np.concatenate([[0.0], np.cumsum(flights)]))
    assert chain.kept == tuple(range(7))
    assert not chain.notes


@pytest.mark.parametrize("seed", [1, 4, 7])
def test_restitution_of_rendered_bounces(tmp_path, seed):
    truth = SoundTruth(seed=seed, restitution=0.75, knocks=1, noise=3e-3)
    write_wav(record(truth), tmp_path / "a.wav")
    given = {
        "mass_kg": truth.mass, "diameter_m": truth.diameter, "contact_time_s": truth.contact_time,
    }  # fmt: skip
    reduced = load_kind("sound").run(tmp_path / "a.wav", given, source="test")
    true = bounces(truth)
    assert len(reduced.trials) >= len(true) - 4
    for trial in reduced.trials:
        v, e = trial.observables["impact_speed_m_s"], trial.observables["restitution"]
        near = min(true, key=lambda b: abs(b[1] - v.value))
        assert v.value == pytest.approx(near[1], rel=5e-3)
        assert e.value == pytest.approx(near[2], rel=5e-3)
    reduced.draw(tmp_path / "a.png")
    assert (tmp_path / "a.png").stat().st_size > 20_000


@pytest.mark.parametrize("seed", [3, 4, 9])
def test_a_restitution_that_follows_the_speed_is_no_error_of_the_instants(seed):
    """Drag and e(v) bend the course of the intervals; each e itself scatters by 0.2 %."""
    truth = random_bounces(seed)
    times, _, e = np.transpose(bounces(truth))
    known = BounceOptions(
        mass_kg=truth.mass, contact_time_s=truth.contact_time, diameter_m=truth.diameter
    )
    found = reduce_bounce_times(times, known, std=None, source="made")
    assert len(found.bounces) == len(times) - 2
    for bounce in found.bounces:
        assert bounce.restitution.std < 0.02 * bounce.restitution.value
        off = bounce.restitution.value - e[bounce.number - 1]
        assert abs(off) < 3.0 * bounce.restitution.std + 1e-4


def test_an_interval_that_strays_is_no_missed_bounce():
    instants = np.append(0.0, np.cumsum(0.5 * 0.75 ** np.arange(9)))
    instants[4] += 0.006
    chain = chain_of(instants)
    assert not any(chain.missed)
    assert chain.single == (True,) * 3 + (False,) * 2 + (True,) * 4
    assert chain.scatter() < 1e-9


@pytest.mark.parametrize(("height", "asked"), [(0.5, False), (0.55, False), (5.0, True)])
def test_a_height_is_asked_back_that_makes_the_first_bounce_unlike_the_next(height, asked):
    flights = 2.0 * np.sqrt(2.0 * 0.5 / 9.81) * 0.75 ** np.arange(1, 7)
    times = np.append(0.3, 0.3 + np.cumsum(flights))
    found = reduce_bounce_times(
        times, BounceOptions(release_height_m=height), std=None, source="made"
    )
    assert any("5? 0.5 would fit" in note for note in found.notes) == asked


@pytest.mark.parametrize("form", ["wav", "flac"])
def test_a_microphone_with_one_channel_turned_hears(tmp_path, form):
    samples = record(SoundTruth())
    turned = (np.stack([samples, -samples], axis=1) * 32767).astype("<i2")
    wavfile.write(tmp_path / "a.wav", RATE, turned)
    path = tmp_path / f"a.{form}"
    if form == "flac":
        av = pytest.importorskip("av")
        with av.open(str(path), "w") as out:
            stream = out.add_stream("flac", rate=RATE, layout="stereo")
            frame = av.AudioFrame.from_ndarray(turned.reshape(1, -1), "s16", "stereo")
            frame.sample_rate = RATE
            for packet in [*stream.encode(frame), *stream.encode(None)]:
                out.mux(packet)
    assert np.ptp(read_sound(path).samples) == pytest.approx(np.ptp(samples), rel=0.01)


def test_a_wave_file_without_its_header_is_refused_in_a_line(tmp_path):
    """The file says of itself that nothing follows: scipy has no rate to give back."""
    write_wav(record(SoundTruth()), tmp_path / "a.wav")
    raw = (tmp_path / "a.wav").read_bytes()
    (tmp_path / "a.wav").write_bytes(raw[:4] + bytes(4) + raw[8:])
    with pytest.raises(InputError, match="no header of its format"):
        load_kind("sound").run(tmp_path / "a.wav", {}, source="test")


def test_sound_into_a_set(tmp_path, errs, prints):
    truth = SoundTruth()
    write_wav(record(truth), tmp_path / "drop.wav")
    where = str(tmp_path / "set")
    command = ["reduce", "sound", str(tmp_path / "drop.wav"), "--into", where]
    command += ["--release-height-m", str(truth.speed**2 / 19.62)]
    assert "drag of the air left out" in prints(*command)
    found = read(tmp_path / "set", unfinished=True)
    e = found.trials.observables["restitution"]
    # in vacuum and with instant contacts the numbers are a little off, and a note says so
    assert e[0] == pytest.approx(bounces(truth)[0][2], rel=0.01)
    message = errs(*command, "--drop-height-m", "0.3")
    assert "drop-height-m" in message
    assert "release_height_m" in message


@measured
def test_restitution_of_a_golf_ball_is_one_value_with_drag_taken_out():
    """Four heights of release: what is left of a course with speed is below 0.003."""
    given = {"holds": "bounces", "time": "4", "mass_kg": 0.0459, "diameter_m": 0.0427,
             "contact_time_s": 5e-4}  # fmt: skip
    rows = []
    for height in ("80", "90", "100", "110"):
        reduced = load_kind("table").run(
            REAL / "golf_ball/data_golfball.xlsx", given | {"sheet": f"{height} cm"}, source="test"
        )
        for trial in reduced.trials:
            e = trial.observables["restitution"]
            rows.append((trial.observables["impact_speed_m_s"].value, e.value, e.std**-2))
    v, e, weight = np.array(rows).T
    mean = np.average(e, weights=weight)
    for low, high in ((0.0, 2.5), (2.5, 3.2), (3.2, 9.0)):
        part = (v >= low) & (v < high)
        assert np.average(e[part], weights=weight[part]) == pytest.approx(mean, abs=0.003)


@measured
def test_heights_and_times_of_one_ball_agree():
    """First rebounds of the blue ball: heights from video against intervals from sound."""
    kind = load_kind("table")
    by_height = kind.run(
        REAL / "first_bounce_heights.csv",
        {"holds": "rebounds", "value": "2", "value_unit": "cm", "select": "ball=blue"},
        source="test",
    )
    heights = {
        round(t.observables["impact_speed_m_s"].value, 3): t.observables["restitution"].value
        for t in by_height.trials
    }
    high = heights[max(heights)]
    found = []
    for file in sorted((REAL / "blue_ball").glob("Lancio *65*.xls")):
        given = {"holds": "bounces", "sheet": "All", "release_height_m": 0.65}
        reduced = kind.run(file, given, source="test")
        found.append(reduced.values["bounce1_restitution"].value)
    assert len(found) == 10
    assert np.mean(found) == pytest.approx(high, abs=0.02)


@measured
def test_a_bounce_that_the_stop_watch_missed_is_found():
    # the last interval of the run is that of two flights
    given = {"holds": "bounces", "sheet": "All"}
    reduced = load_kind("table").run(REAL / "blue_ball/Lancio 5, blu, 55.xls", given, source="test")
    assert any("not recorded" in note for note in reduced.notes)
    e = [t.observables["restitution"].value for t in reduced.trials]
    assert min(e) > 0.83
    assert max(e) < 0.95


def test_times_stand_beside_the_numbers_of_the_bounces(tmp_path):
    path = tmp_path / "watch.csv"
    path.write_text("bounce,time (s)\n1,0.452\n2,1.23\n3,1.92\n4,2.53\n5,3.07\n")
    reduced = load_kind("table").run(path, {"holds": "bounces"}, source="test")
    assert reduced.values["bounce2_restitution"].value == pytest.approx(0.69 / 0.778, rel=1e-9)


@pytest.mark.parametrize("std", [2e-5, None], ids=["heard", "stopped"])
def test_five_taps_are_seldom_a_bouncing_ball(std):
    """Even ones with a twentieth of scatter, and of any interval from 0.15 to 0.9 s."""
    passed = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        even, wild = np.exp(0.05 * rng.normal(size=4)), 0.15 * 6.0 ** rng.uniform(size=4)
        for intervals in (0.4 * even, wild):
            times = np.append(0.0, np.cumsum(intervals))
            errors = None if std is None else np.full(5, std)
            try:
                found = reduce_bounce_times(times, BounceOptions(), std=errors, source="taps")
            except InputError:
                continue
            passed += 1
            assert min(b.restitution.std for b in found.bounces) > 1e-3
    assert passed <= 12  # of 80


def test_four_bounces_are_as_uncertain_as_their_restitution_is_uneven():
    """Of 0.9, 0.91 and 0.89 nothing tells whether the ball or its time scatters."""
    times = np.append(0.0, np.cumsum(0.5 * np.cumprod([1.0, 0.9, 0.91, 0.89])))
    heard = reduce_bounce_times(times, BounceOptions(), std=np.full(5, 1e-6), source="a ball")
    assert all(0.004 < b.restitution.std < 0.02 for b in heard.bounces)
    # by the scatter alone, of two flights beyond the two that tell a factor, 2.3 times as much
    stopped = reduce_bounce_times(times, BounceOptions(), std=None, source="a ball")
    assert stopped.time_std[0] == pytest.approx(2.265 * heard.chain.scatter(), rel=1e-3)


TAPS = (0.80, 0.72, 0.73, 0.60, 0.58, 0.45, 0.44, 0.36, 0.35, 0.26, 0.25, 0.18)


@pytest.mark.parametrize("intervals", [TAPS, TAPS[::-1], (0.5,) * 6])
def test_taps_are_no_bouncing_ball(tmp_path, intervals):
    taps = np.cumsum((0.3, *intervals))
    rate, rng = RATE, np.random.default_rng(1)
    t = np.arange(0.0, taps[-1] + 0.5, 1.0 / rate)
    sound = rng.normal(0.0, 1e-3, t.size)
    for at in taps:
        late = t - at
        sound += 0.5 * np.exp(-np.maximum(late, 0.0) / 5e-3) * np.sin(2e4 * late) * (late > 0.0)
    write_wav(sound, tmp_path / "taps.wav")
    with pytest.raises(InputError, match=r"no run of bounces|of the speed back|do not shrink"):
        load_kind("sound").run(tmp_path / "taps.wav", {}, source="test")


def test_a_run_whose_every_bounce_misses_a_flight_is_refused(tmp_path):
    times = 0.3 + np.cumsum(np.r_[0.0, 0.6 * 0.8 ** np.arange(4)])[[0, 1, 3, 4]]
    (tmp_path / "a.csv").write_text("\n".join(["t (s)", *(f"{t:.5f}" for t in times)]))
    given = {"holds": "bounces", "time_std_s": 1e-4}
    with pytest.raises(InputError, match="no bounce with a recorded flight on both sides"):
        load_kind("table").run(tmp_path / "a.csv", given, source="test")
