"""Sets of every kind pass the reader of recordings, and say nothing of what they conceal."""

import numpy as np
import pytest
from dentscope import recordings
from dentscope.studies.proof.explicit import sets as explicit_sets
from dentscope.studies.proof.generators import effects, folder, truth

KINDS = [
    ("null", ""), ("single", "squeeze-film"), ("single", "half-space-waves"), ("single", "tilt"),
    ("single", "impact-speed-loss"), ("single", "thermal-softening"), ("single", "adhesion"),
    ("single", "tangential-compliance"), ("outside", "drift-with-order"), ("pair", ""),
    ("mass-error", ""), ("strength-error", ""),
]  # fmt: skip


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """One draw of an effect is enough here: sizes are not asked for."""
    monkeypatch.setattr(truth, "size_of", lambda *args, **more: 10.0)


@pytest.mark.parametrize(("kind", "name"), KINDS)
def test_set_passes_the_reader(tmp_path, kind, name):
    case = truth.draw(np.random.default_rng(11), kind, name=name)
    folder.write_set(case, tmp_path / "set-0000", name="set-0000")
    files = sorted(p.name for p in (tmp_path / "set-0000").iterdir())
    assert files == ["set.toml", "trials.csv"]
    read = recordings.read(tmp_path / "set-0000")
    assert len(read.trials) == len(case.rig)
    text = (tmp_path / "set-0000" / "set.toml").read_text()
    text += (tmp_path / "set-0000" / "trials.csv").read_text()
    for word in [*effects.EFFECTS, *effects.OUTSIDE, "cavity", "foundation"]:
        assert word not in text


def test_explicit_set_passes_the_reader(tmp_path):
    series = explicit_sets.available()[-1]
    case = explicit_sets.draw_explicit(np.random.default_rng(2), series)
    explicit_sets.write_explicit(case, tmp_path / "set-0000", name="set-0000")
    read = recordings.read(tmp_path / "set-0000")
    assert len(read.trials) == len(case.rig)
    assert series.name not in (tmp_path / "set-0000" / "set.toml").read_text()


def test_same_seed_same_set(tmp_path):
    for place in ("a", "b"):
        case = truth.draw(np.random.default_rng(4), "null")
        folder.write_set(case, tmp_path / place, name="set-0000")
    assert (tmp_path / "a/trials.csv").read_bytes() == (tmp_path / "b/trials.csv").read_bytes()


def test_noise_has_the_stated_spread():
    rng = np.random.default_rng(0)
    for shape in ("gaussian", "skewed", "heavy"):
        noise = truth.readings_noise(rng, shape, 200000)
        assert abs(noise.mean()) < 0.01
        assert noise.std() == pytest.approx(1.0, abs=0.02)


def test_half_of_the_truths_are_no_textbook_form():
    rng = np.random.default_rng(3)
    plain = 0
    names = list(effects.EFFECTS)
    for k in range(400):
        kind = effects.EFFECTS[names[k % len(names)]]
        from dentscope.studies.proof.generators.benches import BENCHES

        rig = BENCHES[kind.benches[0]](rng)
        plain += kind.draw(rng, rig, float(k % 2)).textbook
    assert plain < 200
