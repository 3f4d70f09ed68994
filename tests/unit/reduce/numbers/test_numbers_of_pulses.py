"""Tuned numbers of records against time where they act, in cases that are worked out by hand."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from dentscope.reduce.measured import Measured
from dentscope.reduce.shared.flank import meets_zero
from dentscope.reduce.table.force import _possible, _whole
from dentscope.reduce.table.heading import heading_of
from dentscope.reduce.table.pulse.area import _after, area_of
from dentscope.reduce.table.pulse.find import _both_flanks, _flank, _timed
from dentscope.reduce.table.pulse.level import Level, _quiet, level_before
from dentscope.reduce.table.pulse.shape import Shape, _flat_top, _others, _single, shape_of
from made_records import refused as refuses

CLEAN = Shape(0.0, 0.0, 0.0, (), 8)


@pytest.mark.parametrize(("before", "told"), [(9, False), (10, True)])
def test_ten_samples_tell_a_level(before, told) -> None:
    up = np.array([0.0] * before + [1.0, 2.0, 1.0] + [0.0] * 20)
    assert (level_before(up, before + 1).samples > 0) == told


@pytest.mark.parametrize(("change", "level"), [(0.009, 0), (0.011, None)])
def test_a_level_changes_by_a_hundredth_of_the_pulse(change, level) -> None:
    ramp = np.linspace(0.0, change, 10)
    assert _quiet(ramp, width=10, noise=0.0, height=1.0, low=0.0) == level


@pytest.mark.parametrize(("foot", "first"), [(125, 80), (130, 210)])
def test_a_foot_is_six_widths_long(foot, first) -> None:
    """Windows of 20 samples go back by 5: of a lower level 25 of them away at the most."""
    up = np.array([0.0] * 100 + [0.05] * foot)
    assert _quiet(up, width=20, noise=0.0, height=1.0, low=0.0) == first


@pytest.mark.parametrize(("height", "seen"), [(0.012, False), (0.013, True)])
def test_a_foot_of_half_a_per_cent_of_the_area_counts(height, seen) -> None:
    """Five samples before a triangle of area 10: half of the last is its own, four are a foot."""
    time = np.arange(30.0)
    clear = np.maximum(2.0 - 0.4 * np.abs(time - 15.0), 0.0) + height * ((time > 4) & (time < 10))
    ends = Measured(10.0, 0.0), Measured(20.0, 0.0)
    found = area_of(time, clear, Level(0.0, 0.0, 0.0, 0, 5), CLEAN, ends)
    assert bool(found.notes) == seen
    assert found.area.value == pytest.approx(10.0 + height * (4.5 if seen else 0.5))
    if not seen:  # a thousandth by the form of the pulse, and 2.6 by the phase of ten samples
        assert found.area.std == pytest.approx(10.006 * np.hypot(1e-3, 2.6008e-3), rel=1e-4)


def test_a_ringing_is_averaged_over_twenty_durations() -> None:
    time = np.arange(100.0)
    assert _after(time, np.zeros(100), CLEAN, 10.0, 11.0)[2] == 10.0


@pytest.mark.parametrize("samples", [7, 8])
def test_an_edge_is_refused_where_eight_samples_would_show_a_flank(samples) -> None:
    shape = CLEAN._replace(above_half=samples)

    def refused(used, times) -> bool:
        return refuses(lambda: _both_flanks(shape, used, times, ""), "an edge: one")

    assert refused((0, 5), (1.0, 1.0)) == (samples == 8)
    assert refused((5, 5), (1.0, 12.1)) == (samples == 8)
    assert not refused((5, 5), (1.0, 11.9))


@pytest.mark.parametrize(("gap", "refused"), [(0.09, False), (0.11, True)])
def test_a_hole_of_a_tenth_of_the_pulse_is_refused(gap, refused) -> None:
    time = np.concatenate([np.arange(0.0, 0.5, 0.01), np.arange(0.49 + gap, 1.0, 0.01)])
    pulse = SimpleNamespace(
        duration=Measured(1.0, 0.0), start=Measured(0.0, 0.0), end=Measured(1.0, 0.0), time=time,
        inside=np.ones(time.size, dtype=bool),
    )  # fmt: skip
    series = SimpleNamespace(missed=np.array([]))
    assert refuses(lambda: _whole(pulse, series, ""), "no sample for") == refused


@pytest.mark.parametrize(
    ("at_top", "beside", "flat"), [(10, 10, 0), (11, 9, 11), (3, 2, 0), (4, 1, 4)]
)
def test_a_flat_top_has_more_equal_samples_than_the_converters_steps_leave(at_top, beside, flat):
    """Steps of 1 below a peak of 100: a round top has its root of 1 to 10 of what is above 90.

    Of 20 samples these are 6.3, and 1.7 times as many are too many; of 5 it takes four.
    """
    rise = [*range(40), 50, 60, 70, 80]
    top = [92.0] * (beside - beside // 2) + [100.0] * at_top + [92.0] * (beside // 2)
    clear = np.array([*rise, *top, *rise[::-1]], dtype=float)
    assert _flat_top(clear, len(rise) + beside - beside // 2) == flat


def looked_at(clear, ends=(25.0, 55.0)):
    clear = np.asarray(clear, dtype=float)
    return shape_of(np.arange(clear.size * 1.0), clear, int(np.argmax(clear)), ends, 0.0, source="")


def with_top(top, sides):
    """A peak of 1 whose highest samples, all above 0.95, differ; level for long to both sides."""
    high = np.linspace(0.965, 1.0, top // 2)
    half = np.array([0.2, *sides, *high])
    return np.concatenate([np.zeros(200), half, half[::-1], np.zeros(200)])


@pytest.mark.parametrize(
    ("top", "sides", "refused"),
    [(12, (0.6, 0.7, 0.8, 0.9), False), (14, (0.6, 0.7, 0.8), True)],
)
def test_a_top_of_two_thirds_of_the_width_is_cut(top, sides, refused) -> None:
    """12 and 14 of 20 samples above half of the peak."""
    record, ends = with_top(top, sides), (195.0, 230.0)
    assert refuses(lambda: looked_at(record, ends), "is flat over") == refused


@pytest.mark.parametrize(("samples", "refused"), [(2, True), (3, False)])
def test_a_pulse_has_three_samples_above_half_of_its_peak(samples, refused) -> None:
    record = np.zeros(100)
    record[30 : 30 + samples] = [0.8, 1.0, 0.7][:samples]
    assert refuses(lambda: looked_at(record, (28.0, 35.0)), "a spike") == refused


PULSE = np.sin(np.pi * np.arange(21) / 20)


@pytest.mark.parametrize(("rest", "refused"), [(0.32, False), (0.34, True)])
def test_a_third_of_the_peak_that_stays_is_a_step(rest, refused) -> None:
    record = np.concatenate([np.zeros(200), PULSE, np.full(300, rest)])
    record[200:221] = np.maximum(record[200:221], rest * (np.arange(21) > 15))
    assert refuses(lambda: looked_at(record, (200.0, 220.0)), "a step") == refused


def swings(waves, size, *, away=30):
    """A pulse of 20 s, and half-waves of as many, to either side in turn, from so long after it."""
    after = np.concatenate([(-1) ** (k + 1) * size * PULSE[:-1] for k in range(waves)])
    return np.concatenate([np.zeros(400), PULSE, np.zeros(away - 1), after, np.zeros(400)])


@pytest.mark.parametrize(
    ("waves", "size", "refused"),
    [(6, 0.35, True), (5, 0.35, False), (6, 0.32, False)],
)
def test_six_half_waves_of_a_third_of_the_peak_are_an_oscillation(waves, size, refused) -> None:
    record = swings(waves, size, away=3)
    assert refuses(lambda: looked_at(record, (400.0, 420.0)), "an oscillation") == refused


@pytest.mark.parametrize(
    ("size", "away", "ringing"),
    [(0.2, 130, 0.2), (0.2, 165, 0.0), (0.009, 30, 0.0), (0.011, 30, 0.011)],
)
def test_a_hundredth_to_either_side_in_turn_within_eight_durations_is_a_ringing(
    size, away, ringing
) -> None:
    found = looked_at(swings(2, size, away=away), (400.0, 420.0))
    assert found.ringing == (pytest.approx(ringing) if ringing else 0.0)


@pytest.mark.parametrize(
    ("flights", "heights", "refused"),
    [
        ((100.0,), (1.0, 0.99), False),  # two are no train
        ((100.0, 96.0), (1.0, 0.9, 0.8), True),  # within 1.05 of each other
        ((100.0, 94.0), (1.0, 0.9, 0.8), False),
        ((100.0, 85.0, 90.0), (1.0, 0.9, 0.8, 0.7), True),  # longer than the one before
        ((100.0, 85.0, 88.0), (1.0, 0.9, 0.8, 0.7), False),
        ((100.0, 90.0), (1.0, 0.6, 0.71), True),  # a tenth of the largest higher
        ((100.0, 90.0), (1.0, 0.6, 0.69), False),
    ],
)
def test_pulses_that_fade_as_bounces_do_are_no_train(flights, heights, refused) -> None:
    at = 50.0 + np.concatenate([[0.0], np.cumsum(flights)])
    time = np.arange(500.0)
    clear = np.zeros(500)
    clear[at.astype(int)] = heights
    told = refuses(lambda: _single(time, clear, tuple(at[1:]), (49.0, 51.0), ""), "like pulses")
    assert told == refused


@pytest.mark.parametrize(("height", "others"), [(0.32, 0), (0.34, 1)])
def test_another_pulse_of_a_third_is_named(height, others) -> None:
    clear = np.concatenate([np.zeros(50), PULSE, np.zeros(100), height * np.ones(4), np.zeros(50)])
    found = list(_others(np.arange(clear.size * 1.0), clear, 1.0, (50.0, 70.0)))
    assert len(found) == others


@pytest.mark.parametrize(("std", "refused"), [(0.34, False), (0.37, True)])
def test_a_duration_known_to_less_than_half_is_refused(std, refused) -> None:
    """Both ends scatter: the duration by the root of two more."""
    ends = Measured(0.0, std), Measured(1.0, std)
    assert refuses(lambda: _timed(*ends, ""), "a contact of") == refused


def test_a_flank_lies_between_6_and_45_hundredths() -> None:
    rise = np.linspace(0.0, 1.0, 101)
    clear = np.concatenate([rise, rise[-2::-1]])
    time = np.arange(clear.size * 1.0)
    end, samples = _flank(time, clear, 100, -1, 1.0)
    assert samples == 38
    assert end.value == pytest.approx(0.0, abs=0.2)


@pytest.mark.parametrize("power", [1.0, 1.2, 1.5])
def test_a_flank_rises_with_a_power_of_1_to_1_and_a_half(power) -> None:
    t = np.linspace(0.05, 0.3, 40)
    assert meets_zero(t, t**power, -1).value == pytest.approx(0.0, abs=2e-3)


@pytest.mark.parametrize(("value", "refused"), [(1.29, False), (1.31, True), (-0.31, True)])
def test_a_restitution_lies_within_three_deviations_of_0_to_1(value, refused) -> None:
    told = Measured(value, 0.1)
    assert refuses(lambda: _possible(told, ""), "asks for a restitution") == refused
    if not refused:
        assert _possible(told, "").std == pytest.approx(math.hypot(0.1, 0.29))


@pytest.mark.parametrize(("between", "names"), [(2, ("t [s]", "F [N]")), (3, ("s", "N"))])
def test_units_stand_in_the_four_lines_above_the_numbers(between, names) -> None:
    lines = [["t", "F"], ["s", "N"], *[["note"]] * between, ["of May"]]
    assert heading_of(lines, 2).names == names
