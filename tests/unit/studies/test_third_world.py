"""The third world against exact impacts, finite elements, and its own silence about truths."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from dentscope.core.material import Material, Pair
from dentscope.models import law_named
from dentscope.recordings import read
from dentscope.studies.proof import third_world as runs
from dentscope.studies.proof import third_world_page
from dentscope.studies.proof.generators import base_laws
from dentscope.studies.proof.generators.benches import BEARING_STEEL, CARBIDE, TARGETS
from dentscope.studies.third_world import motion
from dentscope.studies.third_world.benches import BENCHES, GLASS
from dentscope.studies.third_world.contact import Law
from dentscope.studies.third_world.draw import NULLS, as_stated, draw, readings
from dentscope.studies.third_world.effects import EFFECTS, OUTSIDE, Effect
from dentscope.studies.third_world.physics import physics_of
from dentscope.studies.third_world.sheet import write

PAIRS = [(t, s) for t in TARGETS for s in (BEARING_STEEL, CARBIDE)]


def rms(x):
    return float(np.sqrt(np.mean(np.square(x))))


@pytest.mark.parametrize(("target", "striker"), PAIRS, ids=lambda m: m.name)
def test_mean_metal_is_finite_elements_within_some_per_cent(target, striker):
    # stored finite elements: force, what stays, energy given back; the contact radius by their fit
    found = base_laws.stored()[f"{striker.name} on {target.name}"]
    law, k = Law(), found["stiffness"]

    def loaded(depth):
        one = np.ones(len(depth))
        F, a = law.load(depth, k * one, one, one)
        for _ in range(6):
            F, a = law.load(depth, k * one, np.exp(-law.fall * a), one)
        return F, a

    force, _ = loaded(np.array(found["depth"]))
    turn, left = np.array(found["turn"]), np.array(found["left"])
    F, a = loaded(turn)
    one = np.ones(len(turn))
    n = np.minimum(law.exponent(a, k * one, one, one), 2.0 * k * a * turn / F)
    given = n * F / (2.0 * k * a)
    pair = Pair(*(Material(E=x.E, nu=x.nu, Sy=x.Sy) for x in (striker, target)), 1e-3)
    edge = law_named("fitted").contact_radius(pair, turn * 1e-3) / 1e-3
    off = {
        "force": rms(np.log(force / np.array(found["force"]))),
        "stays": rms((turn - given - left) / turn),
        "energy": rms(np.log(F * given / (n + 1.0) / np.array(found["back"]))),
        "radius": rms(np.log(a / edge)),
    }
    assert max(off.values()) < 0.05, off
    assert max(off.values()) > 0.01, "a metal that is the law's is no metal"


def glassy(bench, **more):
    rig = BENCHES[bench](np.random.default_rng(3))
    p = physics_of(replace(rig, flat=GLASS), Law(), {})
    p.mu[:] = 0.0
    for key, value in more.items():
        setattr(p, key, value)
    return p


def test_elastic_ball_is_hertz():
    p = glassy("balls")
    out = motion.blows(p)
    depth = (15.0 * p.mass * p.speed**2 / (16.0 * np.sqrt(p.R) * p.E)) ** 0.4
    assert out["restitution"] == pytest.approx(np.ones(len(p.R)), abs=2e-3)
    assert out["contact_time_s"] == pytest.approx(2.9432 * depth / p.speed, rel=1e-2)
    force = 4.0 / 3.0 * p.E * np.sqrt(p.R) * depth**1.5
    assert out["peak_force_N"] == pytest.approx(force, rel=1e-3)


def test_rigid_rod_aslant_loses_nothing_and_bends_if_it_may():
    stiff = motion.blows(glassy("rods-aslant"))["restitution"]
    bent = motion.blows(glassy("rods-aslant", flexible=True))["restitution"]
    assert stiff == pytest.approx(np.ones(len(stiff)), abs=2e-3)
    assert np.nanmean(bent) < 0.9
    assert np.mean(np.isfinite(bent)) > 0.5


def test_plate_takes_twice_as_much_if_it_gives_way_twice_as_fast():
    p = glassy("balls")
    whole = motion.blows(p)["contact_time_s"]
    lost = []
    for times in (1.0, 2.0):
        soft = glassy("balls", plate=0.003 * times * float(np.min(whole / p.mass)))
        lost.append(1.0 - motion.blows(soft)["restitution"])
    assert np.all(lost[0] > 0.0)
    assert np.max(lost[0]) > 0.01
    assert lost[1] / lost[0] == pytest.approx(np.full(len(whole), 2.0), abs=0.15)


def test_press_gives_back_what_it_does_not_keep():
    rig = BENCHES["pressed"](np.random.default_rng(1))
    found = readings(rig, Law(), {}, ())
    pressed = rig.load > 0.0
    whole = found["permanent_depth_m"] + found["recovered_depth_m"]
    assert whole[pressed] == pytest.approx(found["press_depth_m"][pressed])
    assert np.all(np.isnan(found["press_depth_m"][~pressed]))
    assert np.all(np.isnan(found["restitution"][pressed]))


@pytest.mark.parametrize("name", [*EFFECTS, *OUTSIDE])
def test_every_effect_acts(name):
    kind = (EFFECTS | OUTSIDE)[name]
    rng = np.random.default_rng(5)
    rig = as_stated(rng, BENCHES[kind.benches[0]](rng), [name])
    effect = kind.draw(rng, rig)
    plain, acted = readings(rig, Law(), {}, ()), readings(rig, Law(), {}, (effect,))
    moved = [np.max(np.abs(np.nan_to_num(acted[k] / plain[k]) - 1.0)) for k in plain]
    assert max(moved) > 5e-4


@pytest.mark.parametrize("bench", BENCHES)
def test_what_a_sheet_states_does_not_say_what_acts(bench):
    """The same with nothing and with any effect, but for what one needs to be named."""
    able = [n for n, kind in (EFFECTS | OUTSIDE).items() if bench in kind.benches]
    assert bench in NULLS
    assert len(able) >= 2
    needs = {"squeeze-film": "fluid", "half-space-waves": "told", "impact-speed-loss": "heights"}
    for name in able:
        for seed in range(5):
            nothing, this = (
                as_stated(rng, BENCHES[bench](rng), names)
                for rng, names in ((np.random.default_rng(seed), n) for n in ([], [name]))
            )
            for key in {"fluid", "told", "heights", "gauge"} - {needs.get(name)}:
                assert getattr(this, key) == getattr(nothing, key)


def test_sheet_says_nothing_of_the_truth(tmp_path):
    truth = draw(np.random.default_rng(4), "null", "plateau")
    write(truth, tmp_path / "set", name="set")
    found = read(tmp_path / "set")
    assert len(found.trials) == len(truth.rig.which)
    rng = np.random.default_rng(6)
    rig = BENCHES["balls"](rng)
    again = replace(truth, rig=rig, effects=(Effect("work-hardening", "swift",
                                             {"n": 0.2, "strain": 0.004}),))  # fmt: skip
    write(again, tmp_path / "other", name="other")
    text = "".join(p.read_text() for p in (tmp_path / "other").iterdir())
    assert not any(name in text for name in EFFECTS)


def test_list_has_its_shares():
    kinds = [entry.kind for entry in runs.entries()]
    assert {k: kinds.count(k) for k in kinds} == {
        "null": 50, "single": 110, "pair": 16, "outside": 24
    }  # fmt: skip
    singles = {entry.effect for entry in runs.entries() if entry.kind == "single"}
    assert singles == set(EFFECTS)


def test_truth_record_is_plain():
    record = draw(np.random.default_rng(1), "outside", "collapse").record()
    assert json.loads(json.dumps(record))["mechanisms"] == []
    assert record["sizes"][0] > 1.0
    assert math.isfinite(record["law"]["meyer"])


def test_page_tells_what_the_kept_sets_add_up_to():
    kept = json.loads(third_world_page.FOUND.read_text(encoding="utf-8"))
    text = "\n".join(third_world_page.third_world_lines())
    found = next(r for r in kept["compared"]["rows"] if r["name"] == "diagnosis")
    lost = [one for one in kept["sets"] if not one["front"]]
    assert len(kept["sets"]) == kept["compared"]["sets"] == found["front"] + len(lost)
    assert f"| diagnosis | {len(kept['sets']) - len(lost)} |" in text
