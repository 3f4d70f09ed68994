"""Honest speeds from tracks: rendered ones with every fault at once, and a marble on paper."""

import math
from pathlib import Path

import numpy as np
import pytest
from dentscope.core.drag import air
from dentscope.reduce.bounces import contacts
from dentscope.reduce.bounces.contacts import find_bounces
from dentscope.reduce.bounces.fall import UNKNOWN, Ball, Fall, flight
from dentscope.reduce.bounces.flights import Piece
from dentscope.reduce.bounces.scale import floor_drift, scale_of
from dentscope.reduce.bounces.touch import LASTS, common_durations, likely_durations
from dentscope.reduce.bounces.track import Track
from dentscope.reduce.bounces.view import Launch, Stage, View
from dentscope.reduce.measured import Measured
from dentscope.reduce.table.file import read_columns
from dentscope.studies.synthetic.tracks import TrackTruth, random_track, seen
from scipy.integrate import solve_ivp

_FOUR_SIGMA = -8.0
"""Logarithm of the likelihood of what lies four standard deviations off."""

MARBLE = Path(__file__).parents[4] / "shared/recordings/marble-on-paper-a4/a4"


@pytest.mark.parametrize("drag", [0.05, 1e-6, -0.03, 0.0])
@pytest.mark.parametrize("speed", [3.0, -2.0])
def test_flight_with_drag_is_the_integrated_one(drag, speed):
    for end in (0.5, -0.2):
        flown = solve_ivp(
            lambda _t, y: [y[1], -9.8 - drag * y[1] * abs(y[1])], (0.0, end), (1.0, speed),
            rtol=1e-11, atol=1e-12,
        )  # fmt: skip
        height, rate = flight(flown.t, 1.0, speed, 9.8, drag)
        assert height == pytest.approx(flown.y[0], abs=1e-9)
        assert rate == pytest.approx(flown.y[1], abs=1e-8)


def test_a_light_ball_is_lifted_and_slowed():
    # 2.7 g and 40 mm in air at 20 °C: buoyancy 1.5 %, air carried along 0.75 %, by hand
    ball = Ball(9.81, 2.7e-3, 0.04, air())
    lifted = 1.2041 * math.pi / 6.0 * 0.04**3 / 2.7e-3
    fall = ball.fall(9.0)
    assert fall.gravity == pytest.approx(9.81 * (1.0 - lifted) / (1.0 + 0.5 * lifted), rel=1e-4)
    # wind-tunnel drag of table-tennis balls, C_D 0.43 to 0.50 near Re = 24,000
    assert 8.4 < fall.terminal < 9.4
    assert UNKNOWN.fall(3.0) == Fall(9.81, math.inf)


def bounces_of(truth, time, height, **known):
    ball = Ball(9.81, truth.mass, truth.diameter, air())
    return find_bounces(Track(time, height), ball, metres=None, **known).bounces


def miss(bounce, truth):
    return abs(bounce.restitution.value - truth.restitution)


def test_rendered_tracks_with_every_fault_are_honest():
    """Drift of the scale, drag, rolling shutter, lost frames, strays, blur, a dip."""
    pulls, errors = [], []
    for seed in range(12):
        truth = random_track(seed)
        track = seen(truth)
        time = track.time + truth.line_time * (track.height.max() - track.height)
        for bounce in bounces_of(truth, time, track.height):
            off = bounce.restitution.value - truth.restitution
            near = int(np.argmin(np.abs(track.contacts - bounce.time.value)))
            assert abs(track.contacts[near] - bounce.time.value) < 2.5 / truth.rate
            pulls.append(off / bounce.restitution.std)
            errors.append(off)
    assert len(pulls) > 20
    assert abs(np.mean(errors)) < 0.002
    assert np.mean(np.abs(pulls) < 2.0) > 0.88
    assert np.abs(pulls).max() < 6.0


def test_a_span_without_samples_is_paid_for():
    """The nearer half of a flight is lost: the speed is bridged, and its error grows."""
    truth = TrackTruth(rate=500.0, noise=0.1, restitution=0.8)
    track = seen(truth)
    contact = track.contacts[1]
    found = {}
    for lost in (0.0, 0.08):
        kept = (track.time > contact) | (track.time < contact - lost)
        result = bounces_of(truth, track.time[kept], track.height[kept])
        found[lost] = bounce = min(result, key=lambda b: abs(b.time.value - contact))
        assert miss(bounce, truth) < 3.0 * bounce.restitution.std
    assert found[0.08].approach.std > 1.2 * found[0.0].approach.std


def test_a_frame_that_is_missing_in_a_contact_is_found_by_where_the_flights_meet():
    truth = TrackTruth(rate=200.0, noise=0.1, restitution=0.8, drop=0.5)
    track = seen(truth)
    contact = track.contacts[1]
    gone = int(np.searchsorted(track.time, contact))
    kept = np.arange(track.time.size) != gone
    time = track.time - (np.arange(track.time.size) > gone) / truth.rate
    found = bounces_of(truth, time[kept], track.height[kept])
    assert len(found) >= 3
    for bounce in found:
        assert miss(bounce, truth) < max(3.0 * bounce.restitution.std, 0.003)
        assert bounce.restitution.std < 0.01
    near = min(found, key=lambda b: abs(b.time.value - contact))
    # read as it stands, the contact is off by g/rate of both speeds: e = 0.774
    assert near.restitution.value == pytest.approx(0.8, abs=0.006)


def test_a_sample_next_to_the_contact_bounds_how_long_it_lasts():
    # 2 m/s down, 1 m/s up: a third of the contact lies before the meeting, two thirds after it
    time = 1e-3 * np.array([-15.4, -10.4, -5.4, -0.4, 4.6, 9.6, 14.6, 19.6])
    track = Track(time, np.where(time < 0.0, -2.0, 1.0) * time)
    stage, view = Stage(0.0, 1.0, 0.0, 1.0), View(0.0, 0.0, 0.0, 0.0, 0.0)
    pieces = [
        Piece(np.arange(4), 0.0, Launch(0.0, -2.0), 1e-7),
        Piece(np.arange(4, 8), 0.0, Launch(0.0, 1.0), 1e-7),
    ]
    met = np.array([0.0, 2.0, 1.0, 0.5, 0.0])
    likely = likely_durations(track, stage, view, pieces, met)
    # a sample 0.4 ms before the meeting is still in flight: 1.2 ms, and where force sets in softly
    assert 1.1e-3 < LASTS[likely > _FOUR_SIGMA].max() < 1.5e-3
    shorter = LASTS < 4e-4
    mine, other = common_durations([likely, np.where(shorter, 0.0, -np.inf)])
    assert LASTS[mine > 0.0].max() == pytest.approx(1.3 * LASTS[shorter].max(), rel=0.06)
    assert np.array_equal(other > 0.0, shorter)


def test_a_fast_contact_that_dents_deeper_is_no_flat_that_drifts():
    truth = TrackTruth(
        mass=0.045, diameter=0.045, rate=1000.0, noise=0.02, restitution=0.7, contact_time=1.9e-3,
        pixel=1e-3,
    )  # fmt: skip
    track = seen(truth)
    known = Measured(truth.contact_time, 0.0)
    found = bounces_of(truth, track.time, track.height, contact=known)
    assert len(found) >= 2
    for bounce in found[:2]:
        assert bounce.restitution.value == pytest.approx(0.7, abs=0.0008)


def test_a_flight_that_took_in_another_is_not_chosen_for_its_length():
    """A frame lost in mid-flight: the crooked whole is longer than its straight part."""
    truth = random_track(731182)
    track = seen(truth)
    for bounce in bounces_of(truth, track.time, track.height):
        assert miss(bounce, truth) < 3.0 * bounce.restitution.std
        assert bounce.restitution.std < 0.004


def test_gravity_and_a_stated_size_that_disagree_are_both_held():
    fall = Measured(12_000.0, 60.0)
    by_fall = 9.81 / 12_000.0
    scale = scale_of(fall, 9.81, Measured(1.1 * by_fall, 0.005 * by_fall))
    assert "check unit, rate" in scale.notes[0]
    for one in (by_fall, 1.1 * by_fall):
        assert abs(scale.metres.value - one) < 1.01 * scale.metres.std
    agreed = scale_of(fall, 9.81, Measured(1.004 * by_fall, 0.005 * by_fall))
    assert not agreed.notes
    assert agreed.metres.std < 0.005 * by_fall
    # within three standard deviations, as one of a hundred pairs: the scatter widens the error
    apart = scale_of(fall, 9.81, Measured(1.018 * by_fall, 0.005 * by_fall))
    assert not apart.notes
    assert apart.metres.std > 2.0 * agreed.metres.std
    assert not scale_of(Measured(math.nan, math.nan), 9.81, None).known


@pytest.mark.parametrize(
    ("terminal", "restitution", "contacts"),
    [(1.2, 0.5, 2), (1.8, 0.8, 4), (1.2, 0.9, 4), (3.0, 0.5, 2), (math.inf, 0.8, 4)],
)
def test_a_body_that_a_liquid_brakes_keeps_its_contacts(terminal, restitution, contacts):
    """Dropped by 0.25 m; its buoyancy, which leaves 8.05 m/s², is told or not."""
    fall, time, parts = Fall(8.05, terminal), np.arange(0.0, 4.0, 0.002), []
    start, launch = 0.0, fall.speed(0.25, 1.0)
    for k in range(contacts + 1):
        end = start + fall.duration(launch)
        here = time[(time >= start) & (time < end)]
        height, speed = flight(here - start, 0.0, launch, 8.05, 8.05 / terminal**2)
        parts.append(np.stack([here, height])[:, (speed < 0.0) | (k > 0)])
        start, launch = end, restitution * fall.landing(launch)
    time, height = np.concatenate(parts, axis=1)
    track = Track(time, height + np.random.default_rng(3).normal(0.0, 1e-4, time.size))
    for gravity in (8.05, 9.81):
        ball = Ball(gravity, None, None, air())
        found = find_bounces(track, ball, metres=Measured(1.0, 0.0))
        assert len(found.bounces) == contacts
        for bounce in found.bounces:
            off = bounce.restitution.value - restitution
            assert abs(off) < 2.0 * bounce.restitution.std < 0.05


def test_a_body_that_a_hand_sets_down_bounces_in_air():
    """It comes down with 1 m/s as at the terminal speed of a liquid; its flights tell of none."""
    time = np.arange(0.0, 1.2, 0.002)
    height, start, launch = 0.25 - time, 0.25, 0.8
    while launch > 0.2:
        late = time - start
        height = np.where(late < 0.0, height, launch * late - 4.905 * late**2)
        start, launch = start + launch / 4.905, 0.8 * launch
    height = np.where(time < start, height, 0.0) + np.random.default_rng(1).normal(0.0, 1e-4, 600)
    found = find_bounces(Track(time, height), UNKNOWN, metres=Measured(1.0, 0.0))
    assert len(found.bounces) >= 3
    for bounce in found.bounces:
        assert abs(bounce.restitution.value - 0.8) < 2.0 * bounce.restitution.std < 0.03


def test_noise_that_turns_everywhere_is_no_track_and_none_of_its_turns_is_tried(monkeypatch):
    height = 1e-7 * np.random.default_rng(1).normal(size=3000)
    monkeypatch.setattr(contacts, "true_contacts", None)
    found = find_bounces(Track(np.arange(3000) / 200.0, height), UNKNOWN, metres=None)
    assert found is None


def test_a_flat_that_drifts_through_the_picture():
    error = 0.2
    contacts = [(Measured(t, 1e-4), Measured(3.0 - 40.0 * t, error)) for t in (0.3, 0.7, 1.0)]
    drift = floor_drift(contacts, 12_000.0)
    assert drift.value == pytest.approx(-40.0, abs=3.0 * error)
    still = [(t, Measured(3.0, error)) for t, _ in contacts]
    assert abs(floor_drift(still, 12_000.0).value) < 0.01
    assert floor_drift(contacts[:1], 12_000.0) == Measured(0.0, 0.0)


def _local_parabola(time, height, turning, way, count):
    """Fit one side of a contact by a parabola, above this and the next one's shadow."""
    index = turning + way * np.arange(2, count + 42)
    index = index[(index >= 0) & (index < time.size)]
    above = np.flatnonzero(height[index] - height[turning] > 20.0)
    index = index[above[: 1 + int(np.argmax(np.append(np.diff(above), 9) > 1))]][:count]
    if index.size < 6:
        return None
    t, y = time[index] - time[turning], height[index]
    used = np.ones(t.size, dtype=bool)
    for _ in range(5):
        found = np.polyfit(t[used], y[used], 2, cov=True)
        off = np.abs(y - np.polyval(found[0], t))
        used = off < 4.0 * max(1.4826 * np.median(off[used]), 0.03)
    return found


def _ratio(before, after):
    """Speeds of two parabolas where they meet next to time 0, one over the other."""
    meet = np.roots(after - before)
    meet = meet[np.isreal(meet)].real
    t = meet[np.argmin(np.abs(meet))] if meet.size else np.nan
    return -np.polyval(np.polyder(after), t) / np.polyval(np.polyder(before), t)


def _independent(time, height, turning, room):
    """Return restitution by two parabolas, its error, and both accelerations."""
    sides = [
        _local_parabola(time, height, turning, way, min(20, int(0.6 * r)))
        for way, r in zip((-1, 1), room, strict=True)
    ]
    if None in sides:
        return None
    (before, _), (after, _) = sides
    rng = np.random.default_rng(1)
    drawn = zip(*(rng.multivariate_normal(*side, size=300) for side in sides), strict=True)
    error = np.std([_ratio(*pair) for pair in drawn])
    return _ratio(before, after), error, -2.0 * before[0], -2.0 * after[0]


def _marble(file):
    """Time [s] and height [pixel] of a file; a tracker that begins anew writes frames again."""
    table = read_columns(file).values
    whole = np.isfinite(table[:, 0]) & np.isfinite(table[:, 2])
    time, height = table[whole, 0] / 200.0, -table[whole, 2]
    ahead = time > np.concatenate([[-np.inf], np.maximum.accumulate(time)[:-1]])
    return time[ahead], height[ahead]


def judge_marble(files):
    """Return restitution, its error, the independent one and its error of each bounce.

    Those count whose two parabolas both fall with the acceleration that this camera shows all over
    (12,200 pixel/s², the median of all files) within 5 %: others are none of a flight. Parabolas of
    a few samples that know the restitution by themselves worse than to 0.01 tell nothing.
    """
    rows = []
    for file in files:
        time, height = _marble(file)
        found = find_bounces(Track(time, height), UNKNOWN, metres=None)
        turns = [0, *(b.turning for b in found.bounces), time.size] if found else []
        for k, bounce in enumerate(found.bounces if found else (), start=1):
            room = (turns[k] - turns[k - 1], turns[k + 1] - turns[k])
            other = _independent(time, height, bounce.turning, room)
            if other and other[1] < 0.01 and all(abs(a / 12_200.0 - 1.0) < 0.05 for a in other[2:]):
                e = bounce.restitution
                rows.append((e.value, e.std, other[0], other[1]))
    return np.array(rows)


@pytest.mark.skipif(not MARBLE.exists(), reason="the recordings are not here")
def test_marble_on_paper_against_parabolas_within_one_flight():
    """Every fifth of the 68 files."""
    found = judge_marble(sorted(MARBLE.glob("[0-9]*-M.csv"))[::5])
    assert len(found) >= 10
    e, std, other, other_std = found.T
    # of all 68 files 3 of 72 bounces lie beyond 3 standard deviations
    assert np.sum(np.abs(e - other) > 3.0 * std) <= 2
    assert np.abs((e - other) / np.hypot(std, other_std)).max() < 4.0
    assert np.median(std) < 0.005
