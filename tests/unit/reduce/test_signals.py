"""Records of force and acceleration as data loggers write them: what is read, what is refused."""

import numpy as np
import pytest
from dentscope.core.errors import InputError
from dentscope.reduce.kinds import load_kind
from dentscope.reduce.table.pulse import find_pulse

RATE = 1e5
TIME = np.arange(0.0, 0.02, 1.0 / RATE)


def pulse(*, at=0.01, long=1e-3, peak=800.0):
    phase = (TIME - at) / long
    return peak * np.sin(np.pi * np.clip(phase, 0.0, 1.0)) ** 1.5


def noisy(values, spread=2.0):
    return values + np.random.default_rng(4).normal(0.0, spread, values.size)


def swinging():
    late = TIME - 0.005
    return np.where(late > 0.0, 800.0 * np.exp(-late / 8e-3) * np.sin(2500.0 * late), 0.0)


@pytest.mark.parametrize(
    ("record", "words"),
    [
        (np.minimum(pulse(), 500.0), "clipped: .* samples stand at the largest value"),
        (np.minimum(noisy(pulse()), 500.0), "clipped"),
        (np.round(np.minimum(pulse(), 500.0) / 5.0) * 5.0, "clipped"),
        (np.where(TIME > 0.01, 500.0, 0.0) + 0.01 * pulse(), "no impact: looks like a step"),
        (swinging(), "no impact: looks like an oscillation"),
        (np.where(TIME == TIME[900], 800.0, 0.0), "no impact: looks like a spike"),
        (np.zeros(TIME.size), "times the noise"),
        (800.0 * TIME / TIME[-1], "allowed"),
        (sum(pulse(at=at) for at in (4e-3, 8e-3, 12e-3)), "like pulses"),
    ],
    ids=["clipped", "noisy", "stepped", "step", "swing", "spike", "rest", "ramp", "taps"],
)  # fmt: skip
def test_what_is_no_whole_impact_is_refused_with_its_look(record, words):
    with pytest.raises(InputError, match=words):
        find_pulse(TIME, noisy(record, 0.5) if record is not None and "clip" not in words
                   else record, source="record")  # fmt: skip


@pytest.mark.parametrize("power", [1.5, 1.0])
def test_the_ends_of_elastic_and_of_plastic_pulses_are_within_their_errors(power):
    phase = np.clip((TIME - 0.01) / 1e-3, 0.0, 1.0)
    record = 800.0 * np.sin(np.pi * phase) ** power
    for seed in range(5):
        noise = np.random.default_rng(seed).normal(0.0, 1.0, TIME.size)
        found = find_pulse(TIME, record + noise, source="record")
        assert abs(found.start.value - 0.01) < 3.0 * found.start.std
        assert abs(found.duration.value - 1e-3) < 3.0 * found.duration.std
        assert found.duration.std < 0.02e-3


def test_several_pulses_are_named():
    two = find_pulse(TIME, noisy(pulse() + pulse(at=0.004, peak=500.0)), source="record")
    assert any("largest of 2 pulses; others at 0.0045" in note for note in two.notes)
    assert two.peak.value == pytest.approx(800.0, rel=0.02)


def test_volts_counts_and_two_header_lines(tmp_path):
    volts = noisy(pulse()) / 112.0  # a sensor of 8.93 mV/N behind an amplifier of 1000
    lines = ["Logger 7", "sample;channel 1", ";V"]
    lines += [f"{k};{v:.6f}".replace(".", ",") for k, v in enumerate(volts)]
    (tmp_path / "blow.txt").write_text("\n".join(lines))
    kind = load_kind("table")
    given = {"holds": "force", "gain": 112.0, "gain_std": 1.12, "rate_hz": RATE}
    found = kind.run(tmp_path / "blow.txt", given, source="test").values
    assert found["peak_force_N"].value == pytest.approx(800.0, rel=0.01)
    assert found["peak_force_N"].std == pytest.approx(8.0, rel=0.3)
    assert found["contact_time_s"].value == pytest.approx(1e-3, rel=0.02)
    for missing, words in (("gain", "holds volts"), ("rate_hz", "counts samples")):
        with pytest.raises(InputError, match=words):
            kind.run(tmp_path / "blow.txt", {k: v for k, v in given.items() if k != missing},
                     source="test")  # fmt: skip
