"""Sets of every kind pass the reader of recordings, and say nothing of what they conceal."""

import numpy as np
import pytest
from dentscope import recordings
from dentscope.studies.proof.generators import effects, folder, parameters, simulate, truth
from dentscope.studies.proof.generators.benches import BENCHES

KINDS = [
    ("null", ""), ("single", "squeeze-film"), ("single", "half-space-waves"), ("single", "tilt"),
    ("single", "impact-speed-loss"), ("single", "thermal-softening"), ("single", "adhesion"),
    ("single", "tangential-compliance"), ("outside", "drift-with-order"), ("pair", ""),
    ("mass-error", ""), ("strength-error", ""),
]  # fmt: skip


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    monkeypatch.setattr(truth, "size_of", lambda *args, **more: 10.0)
    monkeypatch.setattr(truth.Visibility, "size", lambda *args: 10.0)
    monkeypatch.setattr(truth, "beyond_library", lambda *args: 10.0)


def told_of(bench, seed, *names):
    rng = np.random.default_rng(seed)
    rig = truth.told(rng, BENCHES[bench](rng), names)
    return rig.drop, rig.liquid, rig.told


@pytest.mark.parametrize("bench", BENCHES)
def test_what_a_sheet_tells_does_not_say_what_acts(bench):
    """The same with nothing and with any effect, but for what one needs to be named."""
    able = {n: k for n, k in (effects.EFFECTS | effects.OUTSIDE).items() if bench in k.benches}
    assert len(able) >= 2  # nor does the bench
    needs = {"squeeze-film": 1, "half-space-waves": 2, "impact-speed-loss": 0}
    for name in able:
        for seed in range(5):
            nothing, this = told_of(bench, seed), told_of(bench, seed, name)
            for place in {0, 1, 2} - {needs.get(name)}:
                assert this[place] == nothing[place]


def test_liquids_plates_and_heights_are_told_where_they_do_not_act():
    told = [told_of("balls-normal", seed) for seed in range(400)]
    for share, count in (
        (truth.HEIGHTS, sum(t[0] for t in told)),
        (truth.DECOYS, sum(t[1] > 0.0 for t in told)),
        (truth.DECOYS, sum(t[2].get("thickness_m", truth.BLOCK) < truth.BLOCK for t in told)),
    ):
        assert count / 400 == pytest.approx(share, abs=0.08)


@pytest.mark.parametrize("bench", effects.EFFECTS["squeeze-film"].benches)
def test_a_liquid_that_is_told_lets_every_ball_out_of_a_film(bench):
    for seed in range(6):
        rng = np.random.default_rng(seed)
        rig = truth.told(rng, BENCHES[bench](rng), ("squeeze-film",))
        film = effects.EFFECTS["squeeze-film"].draw(rng, rig, parameters.CAVITY)
        found = simulate.results_of(simulate.rows_of(rig, [film], family=parameters.CAVITY, z={}))
        assert np.all(found[:, parameters.COMPLETED] == 1.0)
        assert np.all(found[:, parameters.RESTITUTION] > 0.0)


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
        rig = truth.told(rng, BENCHES[kind.benches[0]](rng), (names[k % len(names)],))
        plain += kind.draw(rng, rig, float(k % 2)).textbook
    assert plain < 200
