"""Tuned numbers of tension tests and presses where they act, worked out by hand."""

import math
from dataclasses import replace

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.reduce.measured import Measured
from dentscope.reduce.press import curve
from dentscope.reduce.press.columns import PressRecord
from dentscope.reduce.press.curve import _zero, contact_zero, left_depth, stiffness
from dentscope.reduce.press.cycles import Cycle, cycles_of
from dentscope.reduce.press.reduction import _from_cycles
from dentscope.reduce.table.rise import _Line, _up_to, elastic_rise
from dentscope.reduce.table.tension import _no_metal, _rows, reduce_tension
from made_records import refused


def line(compliance: float) -> _Line:
    return _Line(compliance, 0.0, 0.0, 0.0, 1.0, False, (0.0, 0.0))


def test_a_rise_yielded_where_one_below_has_seven_tenths_of_its_compliance() -> None:
    assert line(0.69).shows_yield_of(line(1.0))
    assert not line(0.71).shows_yield_of(line(1.0))


def test_a_rise_is_read_from_a_quarter_a_half_or_seven_tenths_of_its_top() -> None:
    """Straight, it is read from a quarter on: its rows' middle lies at five eighths of the top."""
    stress = np.linspace(0.0, 1.2, 1201)
    assert _up_to(1.0, stress, stress).middle[1] == pytest.approx(0.625, abs=2e-3)
    for slack, middle in ((0.5, 0.75), (0.7, 0.85)):  # to there it takes three times the strain
        strain = stress + 2.0 * np.minimum(stress, slack)
        assert _up_to(1.0, strain, stress).middle[1] == pytest.approx(middle, abs=2e-3)


@pytest.mark.parametrize(
    ("kink", "softer", "compliance"), [(0.41, 0.8, 1.0), (0.06, 0.4, 1.0), (0.03, 0.4, 2.5)]
)
def test_a_modulus_is_read_up_to_four_tenths_or_down_to_a_sixteenth_of_the_stress(
    kink, softer, compliance
) -> None:
    """Above the kink the rise has so much of its slope: where it lasts, it is the modulus."""
    stress = np.linspace(0.0, 1.0, 4001)
    strain = np.minimum(stress, kink) + np.maximum(stress - kink, 0.0) / softer
    found = elastic_rise(strain, stress, "").modulus
    assert found.value == pytest.approx(1.0 / compliance, rel=0.02)


@pytest.mark.parametrize(
    ("E", "std", "strength", "why"),
    [
        (41e9, 1e9, 1e8, ""), (39e9, 1e9, 1e8, "no engineering"), (590e9, 1e9, 1e8, ""),
        (610e9, 1e9, 1e8, "no engineering"), (100e9, 1e9, 1.9e9, ""),
        (100e9, 1e9, 2.1e9, "as no metal"), (200e9, 98e9, 1e8, ""),
        (200e9, 102e9, 1e8, "too short, bent or scattered"),
    ],
)  # fmt: skip
def test_a_metal_has_40_to_600_GPa_known_to_half_and_yields_before_a_fiftieth(
    E, std, strength, why
) -> None:
    told = _no_metal(Measured(E, std), strength)
    assert why in told
    assert bool(told) == bool(why)


def test_a_metal_yields_from_a_ten_thousandth_on() -> None:
    """Rows of 0, 0.5, 1, 1.5 ... ten-thousandths of plastic strain: the fourth yields first."""
    plastic = 5e-5 * np.arange(400.0)
    flow = _rows(plastic, np.arange(400.0), "")
    assert flow.stress[0] == 3.0
    assert flow.strain[1] == pytest.approx(1.5e-4)


def test_no_metal_was_strained_by_ten_or_stressed_by_a_terapascal() -> None:
    def refused(strain, stress) -> str:
        with pytest.raises(InputError) as told:
            reduce_tension(
                np.full(5, strain), np.full(5, stress), strain_is="true", E=None, source=""
            )
        return str(told.value)

    assert "in data row 1" in refused(10.5, 1e8)
    assert "in data row 1" in refused(0.1, 1.1e12)
    assert "5 rows" in refused(9.5, 0.9e12)


def test_a_tension_test_has_twenty_rows() -> None:
    strain = np.append(np.linspace(0.0, 0.006, 12), np.linspace(0.007, 0.05, 8))
    stress = np.minimum(71e9 * strain, 480e6 * np.maximum(strain / 0.00676, 1.0) ** 0.06)
    given = {"strain_is": "true", "E": 71e9, "source": ""}
    reduce_tension(strain, stress, **given)
    with pytest.raises(InputError, match="19 rows"):
        reduce_tension(strain[:-1], stress[:-1], **given)


def pressed(load, depth=None) -> PressRecord:
    load = np.asarray(load, dtype=float)
    depth = np.linspace(0.0, 1e-5, load.size) if depth is None else depth
    return PressRecord(load, depth, 0, np.zeros(load.size), None, "")


def refuses(look, record):
    return refused(lambda: cycles_of(record), look)


UP, DOWN = np.linspace(0.0, 1.0, 101), np.linspace(1.0, 0.0, 101)[1:]


@pytest.mark.parametrize(("rows", "refused"), [(19, True), (20, False)])
def test_a_press_has_twenty_rows(rows, refused) -> None:
    assert refuses("rows with a load", pressed(np.sin(np.linspace(0.0, np.pi, rows)))) == refused


@pytest.mark.parametrize(("dip", "cycles"), [(0.04, 1), (0.06, 2)])
def test_a_fall_of_a_twentieth_ends_a_cycle(dip, cycles) -> None:
    low = 0.8 - dip
    load = np.concatenate([UP[:81], np.linspace(0.8, low, 20), np.linspace(low, 1.0, 50), DOWN])
    assert len(cycles_of(pressed(load))) == cycles


@pytest.mark.parametrize(("second", "beyond"), [(1.009, False), (1.011, True)])
def test_a_hold_varies_by_a_hundredth(second, beyond) -> None:
    load = np.concatenate([UP, DOWN, second * UP, second * DOWN])
    first, then = cycles_of(pressed(load))
    assert then.beyond == beyond
    # unloading begins in the last row within a hundredth of the peak
    assert load[first.turn] == pytest.approx(0.99)


@pytest.mark.parametrize(("least", "refused"), [(0.79, False), (0.81, True)])
def test_a_press_is_taken_off_by_a_fifth(least, refused) -> None:
    load = np.concatenate([UP, np.linspace(1.0, least, 50)])
    assert refuses("the load falls to", pressed(load)) == refused


@pytest.mark.parametrize(
    ("equal", "part", "refused"), [(5, 0.035, True), (5, 0.025, False), (3, 0.035, False)]
)
def test_four_equal_loads_while_the_depth_grows_are_a_cut(equal, part, refused) -> None:
    load = np.concatenate([UP, np.ones(equal - 1), DOWN])
    top = np.linspace(1.0 - part, 1.0, equal)
    depth = np.concatenate([(1.0 - part) * UP[:-1], top, DOWN])
    assert refuses("equal loads", pressed(load, depth)) == refused


@pytest.mark.parametrize(("missing", "refused"), [(10, False), (11, True)])
def test_a_tenth_of_the_rows_may_be_missing(missing, refused) -> None:
    """The unloading takes 101 rows; those that are missing lie below half of the load."""
    record = pressed(np.concatenate([UP, DOWN]))
    gap = np.zeros(201)
    gap[30] = missing
    assert refuses("rows without a number", replace(record, gap=gap)) == refused


def cycle(load, turn) -> Cycle:
    load = np.asarray(load)
    return Cycle(float(load.max()), turn, turn, np.arange(turn, load.size), 0.0, True)


def test_a_zero_is_seen_below_eight_times_the_noise() -> None:
    """From a tenth of the load on: where that is above the noise, a tenth of it is error too."""
    load = np.concatenate([np.linspace(0.1, 1.0, 901), np.linspace(1.0, 0.0, 900)[1:]])
    hidden, seen = (contact_zero(load, load, cycle(load, 900), n) for n in (0.0124, 0.0126))
    assert hidden.value == pytest.approx(0.0, abs=1e-3)
    assert math.sqrt(hidden.std**2 - seen.std**2) == pytest.approx(0.01, rel=0.05)


@pytest.mark.parametrize(("least", "told"), [(0.0, 0.05), (0.1, 0.25)])
def test_a_zero_is_told_by_a_twentieth_or_by_two_and_a_half_times_the_least(least, told) -> None:
    """Above what tells it the depth grows another way."""
    part = np.linspace(least, 1.0, 4001)[1:]
    depth = part + 0.5 * np.maximum(part - 1.02 * told, 0.0)
    assert _zero(part, depth, (1.0, 1.0)).value == pytest.approx(0.0, abs=1e-4)
    bent = part + 0.5 * np.maximum(part - 0.8 * told, 0.0)
    assert abs(_zero(part, bent, (1.0, 1.0)).value) > 1e-4


@pytest.mark.parametrize("power", [2.0, 1.5, 1.25, 1.2, 1.0])
@pytest.mark.parametrize(
    ("read", "up", "down"), [(contact_zero, 2001, 100), (left_depth, 100, 2001)]
)
def test_loading_and_unloading_follow_a_power_of_1_to_2(power, read, up, down) -> None:
    depth = np.concatenate([np.linspace(0.0, 1.0, up), np.linspace(1.0, 0.0, down)[1:]])
    load = depth**power
    found = read(load, depth, cycle(load, up - 1), 0.0)
    assert found.value == pytest.approx(0.0, abs=2e-3)


def test_a_zero_is_told_by_sixty_means(monkeypatch) -> None:
    sizes = []
    told = lambda t, *rest: sizes.append(t.size) or Measured(0.0, 0.0)  # noqa: E731
    monkeypatch.setattr(curve, "meets_zero", told)
    part = np.linspace(0.0, 1.0, 4000)
    _zero(part, part, (1.0, 1.0))
    assert sizes == [60, 60]


@pytest.mark.parametrize(("rows", "told"), [(5, False), (6, True)])
def test_six_rows_tell_a_slope(rows, told) -> None:
    load = np.concatenate([[1.0], np.linspace(0.97, 0.71, rows), [0.4, 0.2, 0.0]])
    found = stiffness(load, load, cycle(load, 0))
    assert math.isfinite(found.std) == told


def test_stiffness_is_read_from_98_down_to_50_and_70_hundredths() -> None:
    """Beyond these loads the depth is another: it does not act."""
    load = np.linspace(1.0, 0.0, 2001)
    depth = load + 5.0 * np.maximum(load - 0.981, 0.0) - np.maximum(0.499 - load, 0.0)
    found = stiffness(load, depth, cycle(load, 0))
    assert found.value == pytest.approx(1.0, rel=1e-6)
    assert found.std < 1e-5
    # what lies between half and seven tenths is half error
    bent = load + 0.2 * np.maximum(0.699 - load, 0.0)
    assert stiffness(load, bent, cycle(load, 0)).std > 0.01
    high = load + np.maximum(load - 0.975, 0.0)
    assert abs(stiffness(load, high, cycle(load, 0)).value - 1.0) > 1e-4


def test_a_machine_gives_way_between_meyers_indices_2_and_2_4() -> None:
    """Compliances a at a load of 1 and b at 4: C = (b - a q)/(1 - q), q = 4^(-1/m)."""
    a, b = 3.0, 2.0
    at = np.array([1.0, 1.0, 4.0, 4.0])

    def found(loads):
        cycles = tuple(Cycle(p, 0, 0, np.arange(1), 0.0, True) for p in loads)
        return _from_cycles(cycles, [Measured(1.0 / (a if p == 1.0 else b), 0.0) for p in loads])

    one, other = ((b - a * q) / (1.0 - q) for q in 4.0 ** (-1.0 / np.array([2.0, 2.4])))
    assert one == pytest.approx(1.0)
    assert found(at).value == pytest.approx(0.5 * (one + other))
    assert found(at).std == pytest.approx(0.5 * (one - other), rel=1e-6)
    assert found(at[1:]) is None  # three cycles
    assert found([1.0, 1.0, 1.9, 1.9]) is None  # a ratio below 2
    assert found([1.0, 1.0, 2.1, 2.1]) is not None
