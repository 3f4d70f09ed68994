"""Tuned numbers of clips, scans, markers and sounds where they act, worked out by hand."""

import math
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import made_records
import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.reduce.bounces.flights import Piece
from dentscope.reduce.bounces.view import Launch
from dentscope.reduce.images import silhouette
from dentscope.reduce.images.edge_fit import RodShape, _rod_picture, _settle
from dentscope.reduce.measured import Measured
from dentscope.reduce.mocap import flight_search
from dentscope.reduce.mocap.checks import check_fall, check_shape
from dentscope.reduce.mocap.file import Markers
from dentscope.reduce.mocap.flight_search import _spans
from dentscope.reduce.mocap.point import _side
from dentscope.reduce.scan import ball, bottom
from dentscope.reduce.scan.ball import reduce_ball
from dentscope.reduce.scan.bottom import _floor, find_bottom
from dentscope.reduce.scan.file import Scan, _refuse_far
from dentscope.reduce.scan.level import Levelled, _outside
from dentscope.reduce.scan.walls import _wall_end
from dentscope.reduce.sound.file import Sound
from dentscope.reduce.sound.kind import check_level
from dentscope.reduce.sound.onsets import _pick, _rise_db
from dentscope.reduce.video import reduction, tracking
from dentscope.reduce.video.reduction import Optics, VideoReduction, _contacts, _timed
from dentscope.reduce.video.tracking import _rod_shape, _without_reflection, track_ball

refused = partial(made_records.refused, by=InputError)

MARKERS = Markers(np.arange(30.0), ("a",), np.zeros((30, 1, 3)), "")
# what is looked at, and a number on either side of its limit
LIMITS = {
    "points of a scan lie within a millimetre": (lambda x: _refuse_far(x, Path("a")), 9e-4, 1.1e-3),
    "a fifth of a sound may be at full scale": (
        lambda part: check_level(Sound(np.zeros(9), 1.0, part, "")), 0.19, 0.21),
    "markers fall within three tenths of gravity": (
        lambda part: check_fall(Measured(9.81 * (1.0 + part), 0.0), 9.81, ""), 0.29, 0.31),
    "markers lie within a twentieth of their shape": (
        lambda x: check_shape(SimpleNamespace(spread=x, extent=0.1), ""), 0.0049, 0.0051),
    "a recording of markers has ten frames": (lambda n: MARKERS.part(3, 2 + n), 10, 9),
}  # fmt: skip


@pytest.mark.parametrize("beyond", [False, True])
@pytest.mark.parametrize("limit", LIMITS)
def test_a_reading_is_refused_beyond_its_limit(limit, beyond) -> None:
    look, *numbers = LIMITS[limit]
    assert refused(lambda: look(numbers[beyond])) == beyond


# --- pictures ---


@pytest.mark.parametrize(("grey", "own"), [(129.0, False), (131.0, True)])
def test_a_ball_three_tenths_brighter_than_the_clip_has_its_own_grey(grey, own) -> None:
    rows, columns = np.mgrid[:40, :40]
    frame = np.where(np.hypot(rows - 20, columns - 20) < 8.0, grey, 0.0)
    found = silhouette.ball_by_light(frame, levels=(0.0, 100.0))
    assert found.bright == (grey if own else 100.0)


def settled(start: float, *, strays: float = 0.0, halves: bool = True):
    """A constant grey of 0 fitted from `start`; each move takes half of what is left."""
    values = np.append(np.zeros(20), [strays] if strays else [])
    rounds = []

    def picture(p):
        rounds.append(float(p[0]))
        slope = np.full((1, values.size), 2.0 if halves else 1.0)
        return np.full(values.size, p[0]), slope, np.ones(values.size, dtype=bool)

    far = np.array([np.inf])
    found = _settle(picture, values, np.array([start]), free=(0,), limits=far, low=-far, high=far)
    return found, len(rounds)


def test_an_edge_is_moved_ten_times_until_it_settles_to_a_ten_thousandth() -> None:
    """From 0.01 the seventh move is 0.01/2^7, less than that; from 1 the tenth is 1/2^10."""
    assert settled(0.01)[1] == 7
    assert settled(1.0)[1] == 10
    # a last move of a fiftieth is still a fit: 20/2^10 and 21/2^10
    assert settled(20.0)[0] is not None
    assert settled(21.0)[0] is None


def test_a_residual_of_two_and_a_half_deviations_counts_linearly() -> None:
    """Twenty greys of 0 with a spread of 0.3 at the least, and one of 10 that counts as 0.75."""
    found, _ = settled(0.0, strays=10.0, halves=False)
    assert found[0] == pytest.approx(2.5 * 0.3 / 20.0, rel=1e-3)


@pytest.mark.parametrize(("across", "counts"), [(14.9, True), (15.1, False)])
def test_a_cap_is_read_from_three_quarters_of_the_half_width(across, counts) -> None:
    """A rod of 20 pixels to both sides with a round end of 30: its sides begin 7.6 above."""
    rod = np.array([0.0, 0.0, 0.0, 0.0, 100.0, 1.0, 0.0, 20.0, 1.0 / 30.0])
    zone = _rod_picture(np.array([-5.0]), np.array([across]), rod)[2]
    assert zone.tolist() == [counts]


# --- clips ---


def test_a_lean_is_read_from_twenty_frames() -> None:
    """Of a hundred the last twenty lean by 0.2 and 0 in turn, the others by 1."""
    lean = np.append(np.ones(80), np.resize([0.2, 0.0], 20))
    clip = SimpleNamespace(frame=np.arange(100), lean=lean)
    found = VideoReduction._lean_before(clip, SimpleNamespace(near=(99, 100)))
    assert found.value == pytest.approx(0.1)
    assert found.std == pytest.approx(0.1 / math.sqrt(19.0))


@pytest.mark.parametrize(("rate", "used"), [(1009.0, False), (1011.0, True)])
def test_a_container_that_plays_a_hundredth_faster_has_its_own_rate(rate, used) -> None:
    clip = SimpleNamespace(container_rate=rate, uneven=0, stamps=None, repeats=np.array([]))
    assert bool(_timed(clip, Optics(1000.0))[1]) == used


def test_a_position_is_known_to_a_thousandth_and_drifts(monkeypatch) -> None:
    """By five thousandths of a pixel over a flight; near its reflection by a tenth more."""
    seen = []
    monkeypatch.setattr(reduction, "told_bounces", lambda path, *_, **__: seen.append(path))
    track = {"frame": np.arange(5), "row": np.arange(5.0)}
    _contacts(track, Measured(1.0, 0.0), 7.0, Optics(1000.0), "")
    assert seen[0].floor == 1e-3
    assert seen[0].drift(7.0) == pytest.approx(5e-3)
    assert seen[0].drift(0.0) == pytest.approx(0.105)


def test_a_reflection_is_read_in_twelve_frames_from_one_to_three_and_a_half_blurs(monkeypatch):
    """Of a blur of 2 above a lowest row of 100: between rows 93 and 98."""
    rows = np.append(np.linspace(80.0, 99.0, 1901), 100.0)
    poses = [(k, SimpleNamespace(x=0.0, y=float(y), lean=0.0)) for k, y in enumerate(rows)]
    light, calls = [0.1], []

    def fit(frame, shape, start, **given):
        calls.append((given.get("free", "pose"), start[1]))
        return SimpleNamespace(shape=SimpleNamespace(mirror=light[0], flat=100.0), y=start[1])

    monkeypatch.setattr(tracking, "fit_rod", fit)
    frames, shape = np.zeros((rows.size, 1, 1), dtype=np.uint8), RodShape(10.0, 0.05, 2.0)
    _without_reflection(frames, poses, shape, (0.0, 1.0))
    read = [y for free, y in calls if free == "mirror"]
    again = [y for free, y in calls if free == "pose"]
    assert len(read) == 13  # every 41st of 499 rows
    assert (min(read), max(read)) == (pytest.approx(93.01), pytest.approx(97.93))
    assert min(again) == pytest.approx(93.01)
    # a fiftieth of the light is none
    for share, counts in ((0.019, False), (0.021, True)):
        light[0] = share
        found = _without_reflection(frames, poses, shape, (0.0, 1.0))
        assert (found is not poses) == counts


@pytest.mark.parametrize(("frames", "reach"), [(80, 15), (400, 50)])
def test_the_shape_of_a_rod_is_read_from_thirty_frames(frames, reach, monkeypatch) -> None:
    seen = []
    monkeypatch.setattr(tracking, "body_mask", lambda grey, level: seen.append(grey[0, 0]))
    monkeypatch.setattr(tracking, "rod_guess", lambda mask: None)
    numbers = (np.arange(frames) % 256).astype(np.uint8)[:, None, None]
    _rod_shape(numbers, 60, (0.0, 1.0))
    assert len(seen) == 30
    assert (min(seen), max(seen)) == (60 - reach, 60 + reach)


@pytest.mark.parametrize(("sharp", "kind"), [(16, "light"), (17, "sharp")])
def test_a_ball_is_followed_by_its_edge_where_four_fifths_show_one(sharp, kind, monkeypatch):
    def found(x):
        return SimpleNamespace(x=x, y=0.0, radius=5.0, bright=1.0)

    edges = iter([found(1.0)] * sharp + [None] * (20 - sharp))
    monkeypatch.setattr(tracking, "ball_by_light", lambda *_, **__: found(0.0))
    monkeypatch.setattr(tracking, "_ball_edge", lambda *_: next(edges))
    track = track_ball(np.zeros((20, 1, 1), dtype=np.uint8), (0.0, 1.0), "")
    assert track["column"][0] == (1.0 if kind == "sharp" else 0.0)


# --- scans ---


def dome(n=31):
    x, y = np.mgrid[:n, :n] - (n - 1) / 2
    return Scan(-(x**2 + y**2) / 200.0, np.ones(2), "")


def test_a_ball_is_fitted_to_two_hundred_points_in_eight_sectors(monkeypatch) -> None:
    """Within 8 steps of a point lie 197 points, within the root of 65 of them 213."""
    calls = []
    sphere = ball._sphere
    monkeypatch.setattr(ball, "_sphere", lambda *given: calls.append(1) or sphere(*given))
    assert refused(lambda: reduce_ball(dome(), reach=8.03))
    reduce_ball(dome(), reach=8.1)
    assert len(calls) == 1 + 8


def bowl(n=41):
    x, y = np.mgrid[:n, :n] - (n - 1) / 2
    z = (x**2 + y**2) / 200.0
    whole = np.ones(z.shape, dtype=bool)
    return Levelled(z, whole, whole, np.ones(2), np.ones((*z.shape, 1)), 0)


def test_a_floor_has_45_points() -> None:
    """Within 3.5 steps lie 37 points, within 3.7 steps 45."""
    assert refused(lambda: _floor(bowl(), np.array([20, 20]), 3.5, ""))
    assert _floor(bowl(), np.array([20, 20]), 3.7, "").low == pytest.approx(0.0, abs=1e-9)


def test_a_floor_is_fitted_over_three_quarters_and_a_half_of_the_half_width(monkeypatch) -> None:
    radii = []
    floor = bottom._floor

    def told(found, start, radius, source):
        radii.append(radius)
        return floor(found, start, radius, source)

    monkeypatch.setattr(bottom, "_floor", told)
    find_bottom(bowl(), 10.0, source="")
    assert radii == [7.5, 5.0]


def test_levelling_leaves_nine_tenths_of_the_radius_around_a_crater_out() -> None:
    x, y = np.mgrid[:101, :101] - 50
    crater = np.hypot(x, y) <= 10.0
    clear = _outside((crater,), SimpleNamespace(z=np.zeros((101, 101)), source=""))
    assert not clear[50, 50 + 10 + 9]
    assert clear[50, 50 + 10 + 10]


@pytest.mark.parametrize(("left", "few"), [(499, True), (500, False)])
def test_a_twentieth_of_the_points_is_left_to_level_on(left, few) -> None:
    crater = np.zeros((100, 100), dtype=bool)
    crater[:10, :10] = True
    seen = np.zeros((100, 100))
    seen[-5:] = 1.0
    seen[-1, -1] = 1.0 if left == 500 else 0.0
    scan = SimpleNamespace(z=np.where(seen, 0.0, np.nan), source="")
    assert refused(lambda: _outside((crater,), scan)) == few


def test_a_wall_is_followed_from_45_to_8_hundredths_of_the_depth() -> None:
    """Straight between, where it points to 1; below and above it goes another way."""
    s = np.linspace(-0.2, 1.6, 181)
    z = s - 1.0
    z = np.where(s < 0.545, -1.0, z)
    z = np.where(s > 0.925, 0.5, z)
    end = _wall_end(s, z, 1.0, np.zeros(10))
    assert end.value == pytest.approx(1.0, abs=1e-9)
    # and misses a seventh of a step
    assert end.std == pytest.approx(0.14 * 0.01, rel=1e-6)
    for bent in (
        np.where((s > 0.55) & (s < 0.58), -0.3, z),
        np.where((s > 0.88) & (s < 0.925), -0.1, z),
    ):
        other = _wall_end(s, bent, 1.0, np.zeros(10))
        assert other is None or abs(other.value - 1.0) > 1e-4


# --- sounds ---


def test_a_rise_is_that_of_a_millisecond_over_15_before() -> None:
    """Energies of 1 and 9 for half a millisecond each over 0.03 and 0.01 for 7.5 ms each."""
    energy = np.concatenate([np.full(5000, 1.0), np.full(750, 0.03), np.full(750, 0.01),
                             np.full(50, 1.0), np.full(50, 9.0), np.full(50000, 1e-4)])  # fmt: skip
    rise = _rise_db(np.sqrt(energy), 1e5)[6500]
    assert rise == pytest.approx(10.0 * math.log10(5.0 / 0.02))


@pytest.mark.parametrize(
    ("late_s", "found"), [(5.5e-3, True), (7e-3, False), (-1.8e-3, True), (-2.3e-3, False)]
)
def test_an_onset_is_sought_6_ms_before_and_2_ms_after_the_steepest_rise(late_s, found) -> None:
    rate = 1e5
    sound = np.resize([1.0, -1.0], 4000) * np.where(np.arange(4000) < 2000, 1e-3, 1.0)
    time, _ = _pick(sound, 2000 + round(late_s * rate), rate)
    assert (abs(time - 2000 / rate) < 2e-5) == found


# --- markers ---


@pytest.mark.parametrize(("before", "told"), [(5, None), (6, 6), (40, 15)])
def test_a_flight_of_a_point_is_fitted_over_15_hundredths_of_a_second(before, told) -> None:
    """A frame a hundredth of a second: of six or more, those nearer than 0.15 s."""
    time = 0.01 * np.arange(100.0)
    flight = Piece(np.arange(50 - before, 50), 0.0, Launch(0.0, 0.0), 1.0)
    found = _side(time, np.stack([time] * 3, axis=1), 0.495, flight, -1)
    assert (None if found is None else found[0].time.size) == told


def spans(rms, whole, monkeypatch):
    """Runs of windows of 8 frames with such residuals; a longer span has the residual `whole`."""
    rms = np.asarray(rms, dtype=float)
    n = rms.size + 7
    fitted = lambda _, span, *__: (None, rms[span[0]] if span[1] - span[0] == 7 else whole)  # noqa: E731
    monkeypatch.setattr(flight_search, "alone", fitted)
    monkeypatch.setattr(flight_search, "_noise", lambda _: 0.0)
    poses = SimpleNamespace(time=0.01 * np.arange(n), origin=np.zeros((n, 3)))
    return _spans(poses, np.zeros(3), None)


def test_a_window_of_eight_frames_fits_a_flight_to_three_usual_residuals(monkeypatch) -> None:
    """A usual residual is 1.2 of the best twentieth's: the limit lies at 3.6."""
    rms = np.ones(41)
    assert spans(rms, 1.0, monkeypatch) == [(0, 47)]
    rms[20] = 3.5
    assert spans(rms, 1.0, monkeypatch) == [(0, 47)]
    rms[20] = 3.7
    assert spans(rms, 1.0, monkeypatch) == [(0, 26), (21, 47)]


@pytest.mark.parametrize(
    ("worst", "whole", "cut"), [(1.6, 18.1, True), (1.4, 18.1, False), (1.6, 17.9, False)]
)
def test_a_span_is_cut_that_no_flight_describes_where_a_window_stands_out(
    worst, whole, cut, monkeypatch
) -> None:
    """One and a half usual residuals there, and five limits of 3.6 over the whole."""
    rms = np.ones(41)
    rms[20] = worst
    parts = [(0, 26), (21, 47)] if cut else [(0, 47)]
    assert spans(rms, whole, monkeypatch) == parts
