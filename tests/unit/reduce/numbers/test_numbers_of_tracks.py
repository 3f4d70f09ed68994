"""Tuned numbers of bouncing bodies and of what all reductions share, worked out by hand."""

import math
from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.reduce.bounces import contacts, flights, touch
from dentscope.reduce.bounces.chain import _longest, _without_false_ends, _without_strays, chain_of
from dentscope.reduce.bounces.contacts import _on_one_flat, find_bounces
from dentscope.reduce.bounces.flights import (
    Piece,
    _clean_starts,
    _Fit,
    _fitted,
    _next_blocks,
    own_fall,
    side,
)
from dentscope.reduce.bounces.joint import Before, _cleaned, _untrimmed, fit_together
from dentscope.reduce.bounces.options import BallOptions, BounceOptions
from dentscope.reduce.bounces.scale import (
    Scale,
    _belief,
    check_scale,
    floor_drift,
    frames_lost,
    scale_of,
)
from dentscope.reduce.bounces.sides import _same_fall, known_before
from dentscope.reduce.bounces.times import BouncedTimes, _unsure_contact, reduce_bounce_times
from dentscope.reduce.bounces.touch import (
    LASTS,
    common_durations,
    likely_durations,
    samples_of,
    touch_of,
)
from dentscope.reduce.bounces.track import Track, on_the_body
from dentscope.reduce.bounces.view import Launch, Stage, View
from dentscope.reduce.gates import Refused
from dentscope.reduce.images.clip import repeated_frames
from dentscope.reduce.measured import Measured
from dentscope.reduce.mocap.rigid import _is_line
from dentscope.reduce.scan.noise import autocovariance
from dentscope.reduce.shared.regression import robust_regression, unit_covariance
from made_records import refused
from scipy.linalg import hilbert

NO_FALL = View(0.0, 0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(("off", "kept"), [(0.19, 3), (0.21, 2)])
def test_a_flight_a_fifth_off_the_steady_factor_is_none_of_the_run(off, kept) -> None:
    times = np.cumsum([0.0, 1.0, 0.8 * math.exp(off)])
    assert len(_longest(times, 0.8)[1]) == kept


def test_a_missed_bounce_costs_three_quarters_of_an_instant() -> None:
    """Flights of 1, 0.8, 0.64 and 0.512 together, and 0.4096."""
    times = np.cumsum([0.0, 1.0, 0.8, 0.64 + 0.512, 0.4096])
    score, kept, single = _longest(times, 0.8)
    assert (len(kept), single) == (5, (True, True, False, True))
    assert score == pytest.approx(5.0 - 0.75)


@pytest.mark.parametrize(("off", "run"), [(0.01, True), (0.04, False)])
def test_a_run_is_longer_than_chance_makes_it(off, run) -> None:
    """Four of six instants hang together in 15 ways, each as likely as it is uneven."""
    flights = np.array([1.0, 0.8 * (1.0 + off), 0.64])
    times = np.cumsum(np.concatenate([[0.0], flights, [2.0, 3.4]]))
    found = chain_of(times)
    assert (found is not None and len(found.kept) == 4) == run


def bounced(factor, jitter=0.0, **given):
    flights = factor ** np.arange(11) + jitter * np.resize([1.0, -1.0], 11)
    times = np.append(0.0, np.cumsum(flights))
    return reduce_bounce_times(
        times, BounceOptions(), **{"std": np.full(12, 1e-4), **given}, source=""
    )


def test_flights_shrink_by_three_of_their_errors_or_are_taps() -> None:
    """Ten flights of 0.9999 of the one before: the last is 1 ms shorter, ± 2 of an instant."""
    assert bounced(0.9999, std=np.full(12, 1.6e-4)).bounces
    with pytest.raises(Refused, match="do not shrink"):
        bounced(0.9999, std=np.full(12, 1.8e-4))


@pytest.mark.parametrize(("part", "told"), [(0.9, False), (1.1, True)])
def test_an_instant_is_no_better_known_than_its_run_scatters(part, told) -> None:
    scatter = bounced(0.8, 1e-3).chain.scatter()
    found = bounced(0.8, 1e-3, std=np.full(12, scatter / part))
    assert any("about a smooth course" in note for note in found.notes) == told
    assert found.time_std[0] == pytest.approx(max(scatter / part, scatter))


def test_three_of_five_flights_on_one_course_do_not_hide_how_the_others_stray() -> None:
    """A tennis ball's first three agree to 0.1 ms, the next two are off by 2 and 3 ms."""
    flights = np.array([0.5325, 0.4035, 0.3059, 0.2340, 0.1729])
    found = reduce_bounce_times(
        np.append(0.0, np.cumsum(flights)), BounceOptions(), std=None, source=""
    )
    e = [b.restitution for b in found.bounces]
    assert found.time_std[0] > 1e-3
    assert abs(e[-1].minus(e[0]).value) < 3.0 * e[-1].minus(e[0]).std


def test_a_contact_not_known_lasts_30_us_to_4_ms() -> None:
    """Its root mean square is 1.28 ms where any order of magnitude is as likely: g/2 of it."""
    bounce = BouncedTimes(1, 0.0, Measured(2.0, 0.0), Measured(1.0, 0.0), Measured(0.5, 0.0))
    found = _unsure_contact(bounce, 10.0)
    assert found.approach.std == pytest.approx(5.0 * 1.2787e-3, rel=1e-3)
    assert found.restitution.std == pytest.approx(0.5 * found.approach.std * (1.0 - 0.5), rel=1e-6)
    assert LASTS[[0, -1]] == pytest.approx([3e-5, 0.02])


@pytest.mark.parametrize(("off", "wrong"), [(0.42, False), (0.44, True), (-0.24, True)])
def test_a_fall_is_off_gravity_by_three_tenths(off, wrong) -> None:
    scale = Scale(Measured(1.0, 0.0), "", (), off)
    assert refused(lambda: check_scale(scale, source="")) == wrong


def test_a_flat_drifts_by_a_hundredth_of_the_fall_and_less() -> None:
    """Heights that say nothing leave what is believed: the mean of three variances."""
    vague = [(Measured(t, 0.0), Measured(0.0, 1e6)) for t in (0.0, 1.0)]
    widths = np.array([1e-4, 1e-3, 1e-2])
    found = floor_drift(vague, 10.0)
    assert found.std == pytest.approx(10.0 * math.sqrt(np.mean(widths**2)), rel=1e-6)


def test_a_frame_in_fifty_is_missing_and_a_tenth_of_belief_counts() -> None:
    """The second of three contacts lies too high by what a missing frame makes of it."""

    def seen(rise: float) -> tuple[float, float]:
        heights = [0.0, rise, 0.0]
        found = [(Measured(float(k), 0.0), Measured(h, 1.0)) for k, h in enumerate(heights)]
        level = [(Measured(float(k), 0.0), Measured(0.0, 1.0)) for k in range(3)]
        odds = 0.02 * math.exp(_belief(level, 1e-3) - _belief(found, 1e-3))
        # one of the others could be missing too, without a rise
        return odds / (1.0 + 2 * 0.02 + odds), frames_lost(found, (0.0, rise, 0.0), 1e-3)[1]

    for rise in np.linspace(2.0, 4.0, 21):
        share, found = seen(float(rise))
        assert found == (pytest.approx(share) if share > 0.1 else 0.0)
    assert seen(2.0)[0] < 0.1 < 0.2 < seen(4.0)[0] < 0.9


STAGE = Stage(0.0, 50.0, 0.0, 0.4)


def thrown(n=41, fall=9810.0):
    time = np.linspace(0.0, 0.4, n)
    track = Track(time, 0.5 * fall * time * (0.4 - time))
    return track, Piece(np.arange(n), 0.2, Launch(float(track.height[n // 2]), 0.0), 1.0)


def test_what_is_known_of_fall_and_drag_before_a_track_is_looked_at() -> None:
    """A pixel of a millimetre, 50 of them high and 0.4 s long; nobody says what falls."""
    track, piece = thrown()
    ball = BallOptions(gravity_m_s2=9.81).ball_of(None)
    (found,) = known_before(track, [piece], ball, Measured(1e-3, 0.0), STAGE)
    assert found.fall.value == pytest.approx(9810.0)
    assert found.fall.std == pytest.approx(0.02 * 9810.0)
    # the fastest falls from 50 pixels: half of a tenth over twice the height
    assert found.drag.value == pytest.approx(0.05 / 100.0)
    assert (found.bends, found.grows) == (pytest.approx(0.5), pytest.approx(0.4))


def test_drag_is_taken_at_three_quarters_of_the_launch() -> None:
    options = BounceOptions(mass_kg=0.0027, diameter_m=0.04)
    assert options.fall_of(0.4).terminal == options.ball.fall(0.3).terminal
    assert options.fall_of(0.4).terminal != options.ball.fall(0.35).terminal


@pytest.mark.parametrize(
    ("usual", "sigma", "kept"),
    [(1.0, 5.9, True), (1.0, 6.1, False), (0.01, 0.49, True), (0.01, 0.51, False)],
)
def test_a_flight_spreads_six_times_as_much_as_others_or_a_hundredth_of_the_reach(
    usual, sigma, kept
) -> None:
    track, piece = thrown()
    sides = [Piece(piece.index, 0.2, piece.launch, s) for s in (usual, usual, usual, sigma)]
    before = Before(Measured(9810.0, 0.0), Measured(0.0, 0.0))
    fall_of = partial(own_fall, track)
    assert (_same_fall(track, fall_of, sides, before, STAGE)[3] is not None) == kept


@pytest.mark.parametrize(("fall", "straight"), [(0.99, True), (1.01, False)])
def test_a_flight_is_straight_whose_speed_changes_by_a_tenth(fall, straight) -> None:
    piece = Piece(np.arange(11), 0.0, Launch(0.0, 10.0), 1.0)
    assert piece.straight(np.linspace(0.0, 1.0, 11), fall) == straight


def test_five_samples_are_a_flight_that_begins_with_twelve(monkeypatch) -> None:
    track = thrown()[0]
    assert side(track, 0, 4, STAGE, None) is None
    assert side(track, 0, 5, STAGE, None).index.tolist() == [1, 2, 3, 4, 5]
    sizes = []
    starts = lambda track, order, size: sizes.append(size) or [0]  # noqa: E731
    monkeypatch.setattr(flights, "_clean_starts", starts)
    side(track, 0, 40, STAGE, None)
    assert sizes == [12]


def test_a_flight_is_looked_for_within_two_lengths_of_its_contact() -> None:
    """Starts of 0, 1, 2, 3, 4, 6, 9, 13, 19, 28 samples: of 12 samples up to 24 away."""
    track = replace(thrown(101)[0], floor=1e-3)
    assert _clean_starts(track, np.arange(1, 101), 12)[-1] == 19


def test_a_flight_spreads_three_times_as_much_as_the_track() -> None:
    height = np.zeros(200)
    height[180:] = np.resize([10.0, -10.0], 20)
    track = Track(np.linspace(0.0, 1.0, 200), height, floor=1.0)
    assert _fitted(track, np.arange(180, 200), STAGE, None).sigma == pytest.approx(3.0)


def test_a_flight_grows_by_a_quarter_and_over_two_blocks_off_it() -> None:
    def grown(off, *, size=20):
        z = np.zeros(100)
        z[size : size + len(off)] = off
        fit = SimpleNamespace(deviations=lambda _, block: z[block])
        more, reached = _next_blocks(None, fit, np.arange(100), size, size)
        return more.size, reached - size

    assert grown([]) == (5, 5)
    assert grown([9.0] * 10) == (5, 15)
    assert grown([9.0] * 15) == (0, 0)
    # a block whose middle is three and a half deviations off is none of it
    assert grown([3.4] * 5) == (5, 5)
    assert grown([3.6] * 5 + [9.0] * 10) == (0, 0)
    # six of ten samples lie on it
    strays = [9.0, -9.0, 9.0, -9.0]
    assert grown(strays + [0.0] * 6 + [9.0] * 20, size=40) == (10, 10)
    assert grown([*strays, -9.0] + [0.0] * 5 + [9.0] * 20, size=40) == (0, 0)


def test_a_fall_changes_by_a_fiftieth_where_nothing_is_seen() -> None:
    """Half a second without a sample in a fall of 10: 0.02 of its 5."""
    exact = SimpleNamespace(covariance=np.zeros((2, 2)))
    fit = _Fit(STAGE, View(10.0, 0.0, 0.0, 0.0, 0.0), 0.0, Launch(0.0, 0.0), exact, 1.0)
    assert fit.speed_error(0.0, 0.5 + 0.1 * np.arange(5)) == pytest.approx(0.1)
    assert math.isinf(fit.speed_error(0.0, 0.5 + 0.1 * np.arange(4)))


def test_contacts_are_fitted_three_times(monkeypatch) -> None:
    time = np.linspace(0.0, 1.0, 400)
    height = np.abs(np.where(time < 0.5, 0.25 - time**2, 4 * (time - 0.5) * (1.0 - time) / 4))
    calls = []

    def counted(*given):
        calls.append(given)
        return fit_together(*given)

    monkeypatch.setattr(contacts, "fit_together", counted)
    find_bounces(Track(time, height), BallOptions(gravity_m_s2=2.0).ball_of(None), metres=None)
    assert len(calls) == 3


@pytest.mark.parametrize(("height", "left"), [(2.4, 3), (2.6, 2)])
def test_contacts_lie_within_a_twentieth_of_the_reach(height, left) -> None:
    found = [SimpleNamespace(height=Measured(h, 0.0)) for h in (0.0, 0.0, height)]
    assert len(_on_one_flat(found, STAGE)) == left


def piece(index, speed=1.0, sigma=1e-9):
    return Piece(np.asarray(index), 0.0, Launch(0.0, speed), sigma)


@pytest.mark.parametrize(
    ("runs", "step", "resolved"),
    [((2, 2), 9e-4, True), ((2, 1), 9e-4, False), ((2, 2), 1.1e-3, False)],
)
def test_four_samples_less_than_a_millisecond_apart_show_both_ends(
    runs, step, resolved, monkeypatch
) -> None:
    held = [9 - np.arange(runs[0]), 10 + np.arange(runs[1])]
    monkeypatch.setattr(touch, "_held", lambda *_: held)
    track = Track(step * np.arange(20.0), np.zeros(20))
    both = piece([0, 1]), piece([18, 19])
    met = np.array([9.5 * step, 1.0, 1.0, 1.0, 0.0])
    found = touch_of(track, STAGE, NO_FALL, both, met, None, np.ones(LASTS.size))
    assert found.whole == (not resolved)


def test_half_of_what_shows_of_a_contact_lies_beyond_its_ends(monkeypatch) -> None:
    """Two samples before and two after the lowest; of four that show, one and one more."""
    monkeypatch.setattr(touch, "_held", lambda *_: [np.array([9, 8]), np.array([11, 12])])
    track = Track(1e-3 * np.arange(20.0), np.zeros(20))
    both = piece([0, 1]), piece([18, 19])
    short = np.eye(1, LASTS.size)[0]  # 30 us
    assert samples_of(track, STAGE, NO_FALL, both, 10, np.array([0.01]), short) == (4, 4)


def test_contacts_above_4_ms_are_rarer_by_the_fourth_power() -> None:
    found = common_durations([np.zeros(LASTS.size)])[0]
    assert found == pytest.approx(np.minimum((LASTS / 4e-3) ** -4.0, 1.0))


def test_contacts_of_a_track_last_within_three_tenths_of_each_other() -> None:
    one = np.full(LASTS.size, -np.inf)
    one[60] = 0.0
    found = common_durations([one, np.zeros(LASTS.size)])[1]
    near = np.abs(np.log(LASTS / LASTS[60])) <= math.log(1.3)
    assert np.array_equal(found > 0.0, near)
    assert near.sum() == 11


def likely(monkeypatch, track, both, ratio=1.0) -> np.ndarray:
    monkeypatch.setattr(touch, "_held", lambda *_: [np.array([], int)] * 2)
    met = np.array([0.0, 1.0, 1.0, ratio, 0.0])
    return likely_durations(track, STAGE, NO_FALL, both, met)


def test_six_samples_to_both_sides_say_12_each_at_most(monkeypatch) -> None:
    """They lie on both flights to the last digit: no contact reaches them."""
    time = 1e-3 * (np.arange(60.0) - 29.5)
    track = Track(time, np.abs(time))
    both = piece(range(30), -1.0), piece(range(30, 60))
    found = likely(monkeypatch, track, both)
    # of 20 ms, ten to each side
    assert found[-1] == -12.0 * 6 * 2
    assert found[0] == 0.0
    # flights of strays, one of which goes on through the flat
    with np.errstate(all="raise"):
        assert np.isfinite(likely(monkeypatch, track, both, -0.9999)).all()


@pytest.mark.parametrize(
    ("part", "possible"), [(0.84, False), (0.86, True), (1.29, True), (1.31, False)]
)
def test_a_soft_contact_bends_as_a_spring_does_within_limits(part, possible, monkeypatch) -> None:
    """One sample 3 ms from the meeting of a contact of 10 ms: a quarter of a sine is 5 ms."""
    k = int(np.argmin(np.abs(LASTS - 0.01)))
    half, gap = 0.5 * LASTS[k], 3e-3
    late = half - gap
    above = part * (late - half * math.sin(0.5 * math.pi * late / half) / (0.5 * math.pi))
    time = np.array([-gap, gap])
    track = Track(time, gap + above * np.ones(2))
    found = likely(monkeypatch, track, (piece([0], -1.0, 1e-12), piece([1], 1.0, 1e-12)))
    assert (found[k] == 0.0) == possible


@pytest.mark.parametrize(
    ("held", "off", "kept"), [(4, 3.9, 60), (4, 4.1, 56), (5, 50.0, 55), (6, 50.0, 60)]
)
def test_no_body_is_three_times_as_fast_as_it_mostly_is_but_for_six_samples(held, off, kept):
    """It moves with 1 a sample; some lie higher: from them it comes back with 1 less."""
    height = np.arange(60.0)
    height[30 : 30 + held] += off
    assert on_the_body(Track(np.arange(60.0), height)).size == kept


@pytest.mark.parametrize(("off", "kept"), [(2.4, 20), (2.6, 18)])
def test_samples_two_and_a_half_deviations_off_at_an_end_are_left_out(off, kept) -> None:
    z = np.zeros(20)
    z[:2] = off
    assert _untrimmed(z).sum() == kept


def test_eight_samples_of_all_flights_count_in_the_spread_of_one() -> None:
    """Twelve samples off by 1 and by 3 in turn: squares of 12 and 108, 9.5 degrees of freedom."""
    height = np.concatenate([np.resize([1.0, -1.0], 12), np.resize([3.0, -3.0], 12)])
    track = Track(np.linspace(0.0, 0.4, 24), height)
    both = [Piece(k + np.arange(12), 0.0, Launch(0.0, 0.0), 1.0) for k in (0, 12)]
    found = _cleaned(track, both, STAGE, np.zeros(9))
    pooled = 0.5 * (12.0 + 108.0) / 9.5
    for piece, squares in zip(found, (12.0, 108.0), strict=True):
        assert piece.sigma == pytest.approx(math.sqrt((squares + 8.0 * pooled) / 17.5))


def test_a_scale_drifts_by_one_three_or_rarely_ten_hundredths() -> None:
    """A track so short that it says nothing of it: what is believed stays."""
    track, one = thrown()
    track = replace(track, floor=1.0)
    before = Before(Measured(9810.0, 1e-6), Measured(0.0, 1e-12), 1e-9, 1e-9)
    view = View(9810.0, 0.0, 0.0, 0.0, 0.0)
    _, solutions = fit_together(track, [one], STAGE, view, before)
    beliefs = {round(math.sqrt(s.covariance[2, 2]) / 1e-9, 4): s.weight for s in solutions}
    assert beliefs == pytest.approx({0.01: 1 / 2.05, 0.03: 1 / 2.05, 0.1: 0.05 / 2.05}, rel=1e-3)


def test_a_fall_known_to_a_tenth_gives_a_scale() -> None:
    known, vague = Measured(981.0, 95.0), Measured(981.0, 100.0)
    assert scale_of(known, 9.81, None).metres.value == pytest.approx(0.01)
    assert math.isnan(scale_of(vague, 9.81, None).metres.value)


def test_two_scales_agree_within_three_deviations() -> None:
    stated = Measured(0.01, 1e-4)
    # the fall's scale has an error of 1 % as well: 1.41 % together
    near = scale_of(Measured(981.0 / 1.042, 9.81 / 1.042), 9.81, stated)
    far = scale_of(Measured(981.0 / 1.045, 9.81 / 1.045), 9.81, stated)
    assert near.origin == "gravity and what is stated"
    assert far.origin == "what is stated, against gravity"


@pytest.mark.parametrize(("late", "left"), [(0.09, 6), (0.11, 5)])
def test_an_end_that_is_a_tenth_off_is_a_knock(late, left) -> None:
    """Flights of 0.8 of the one before; the last longer by a part of itself."""
    flights = 0.8 ** np.arange(5)
    flights[-1] *= math.exp(late)
    times = np.append(0.0, np.cumsum(flights))
    kept, _, ends = _without_false_ends(times, tuple(range(6)), (True,) * 5)
    assert (len(kept), ends) == (left, 6 - left)


def test_a_shape_of_one_to_a_hundred_is_a_line() -> None:
    assert _is_line(np.diag([1.0, 0.009, 0.0]))
    assert not _is_line(np.diag([1.0, 0.011, 0.0]))


def test_a_frame_repeats_where_it_changes_by_a_third_of_its_neighbours_in_a_fifth_of_all() -> None:
    def repeats(small: int, every: int = 2) -> int:
        steps = [small if k % every == 0 else 100 for k in range(39)]
        levels = 100 + np.cumsum([0, *(s * (-1) ** k for k, s in enumerate(steps))])
        return repeated_frames(np.broadcast_to(levels[:, None, None], (40, 4, 4))).size

    assert repeats(34) == 20
    assert repeats(36) == 0
    assert repeats(34, every=6) == 0


def test_a_residual_of_four_robust_deviations_is_left_out() -> None:
    """Residuals of 1 and -1 in turn: 1.4826 of the median of their size is a deviation."""
    x = np.arange(100.0)
    y = np.resize([1.0, -1.0], 100)
    used = []
    for size in (5.7, 6.3):
        moved = y.copy()
        moved[50] = size
        used.append(bool(robust_regression(np.stack([np.ones_like(x)], axis=1), moved).used[50]))
    assert used == [True, False]


def test_a_covariance_needs_thirty_pairs() -> None:
    """Of n points on a line n - k pairs are k apart."""
    z = np.ones((32, 1))
    found = autocovariance(z, np.ones((32, 1), dtype=bool), np.array([4, 0]))
    assert (found.ravel() > 0.0).tolist() == [False, False, *[True] * 5, False, False]


def test_a_flight_eight_deviations_off_the_course_is_a_stray() -> None:
    """Flights of 0.8 of the one before, each off by a thousandth to and fro."""

    def single(off: float) -> int:
        ratio = 0.8 ** np.arange(12) * np.exp(0.001 * np.resize([1.0, -1.0], 12))
        ratio[6] *= math.exp(off)
        times = np.append(0.0, np.cumsum(ratio))
        kept, _ = _without_strays(times, tuple(range(13)), (True,) * 12)
        return sum(kept)

    assert single(0.003) == 12
    assert single(0.1) < 12


def test_a_straight_line_has_the_textbooks_covariance():
    t = np.linspace(0.0, 1.0, 50)
    found = unit_covariance(np.stack([np.ones_like(t), t - t.mean()], axis=1))
    assert found == pytest.approx(np.diag([1.0 / 50, 1.0 / np.sum((t - t.mean()) ** 2)]))


@pytest.mark.parametrize("size", [4, 8, 12, 20])
def test_no_variance_is_negative_however_alike_the_columns(size):
    covariance = unit_covariance(hilbert(size))
    assert np.array_equal(covariance, covariance.T)
    assert np.all(np.diag(covariance) >= 0.0)
    assert np.linalg.eigvalsh(covariance)[0] >= -1e-12 * np.linalg.eigvalsh(covariance)[-1]


def test_readings_almost_without_noise_have_a_covariance():
    # two unknowns that only rounding tells apart, as the spin of a body that hardly turns
    t = np.linspace(0.0, 1.0, 200)
    design = np.stack([np.ones_like(t), t, t + 1e-9 * t**2, t**2], axis=1)
    fit = robust_regression(design, design @ [1.0, 2.0, 0.0, 3.0], floor=1e-7)
    assert np.all(np.isfinite(np.sqrt(np.diag(fit.covariance))))
    assert np.all(np.isfinite(fit.prediction_std(design)))


def test_a_column_that_no_reading_sees_has_no_variance():
    design = np.stack([np.ones(10), np.zeros(10)], axis=1)
    assert unit_covariance(design) == pytest.approx(np.diag([0.1, 0.0]))
