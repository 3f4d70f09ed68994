"""What is assumed acts in every prediction, at its published size, and is no hypothesis."""

from pathlib import Path

import numpy as np
import pytest
from dentscope.core import InputError
from dentscope.discrepancy.comparison.forward import Point, Simulator
from dentscope.discrepancy.comparison.problem import problem_of
from dentscope.discrepancy.rank import rank
from dentscope.dynamics.mechanisms import MECHANISMS
from dentscope.recordings import read
from dentscope.recordings.shipped import set_folder

(WAVES,) = (m for m in MECHANISMS if m.name == "half-space-waves")


def test_what_is_assumed_is_predicted_and_no_hypothesis() -> None:
    plain, assumed = (
        Simulator(
            problem_of(read(set_folder(Path("thesis-chapter-5"))), law="fitted", assume=names)
        )
        for names in ((), ("half-space-waves",))
    )
    assert [n for n in assumed.problem.notes if n not in plain.problem.notes] == [
        f"taken to act, at its stated or published size: {WAVES.title} (half-space-waves)"
    ]
    z = np.zeros(plain.problem.n_z)
    published = {"half-space-waves": WAVES.published(plain.problem.conditions[0].around)}
    acts = plain.predict((WAVES,), [Point(z, published)])[0]
    assert assumed.predict((), [Point(z)])[0] == pytest.approx(acts, rel=1e-12)
    assert not np.allclose(acts, plain.predict((), [Point(z)])[0], rtol=1e-4)
    assert rank(assumed, mechanisms=(WAVES,)).excluded == {
        WAVES.name: "it is assumed: it acts whatever is found, as published"
    }


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("drag", "no published size"),
        ("adhesion", "no published size"),
        ("rod-flexural-vibration", "rod"),
    ],
)
def test_what_cannot_act_is_refused(name, why) -> None:
    given = read(set_folder(Path("kharaz-2001-oblique")))
    with pytest.raises(InputError, match=why) as told:
        problem_of(given, law="fitted", assume=(name,))
    assert "half-space-waves" in str(told.value.allowed)


SHEET = """format = "recording-set/1"
[target]
material = "stone floor"
{target}
[strikers.ball]
shape = "sphere"
tip_radius_m = 0.02
mass_kg = 0.0027
{ball}
[noise]
{noise} = 0.01
"""


def of_ball(folder: Path, *, target: str = "", ball: str = "", read_as: str = "restitution"):
    folder.mkdir()
    (folder / "set.toml").write_text(SHEET.format(target=target, ball=ball, noise=read_as))
    rows = [
        f"{k},ball,90,{h},{x}" for k, (h, x) in enumerate([(0.5, 0.8), (1.0, 0.75), (2.0, 0.7)])
    ]
    head = f"trial,striker,angle_deg,drop_height_m,{read_as}"
    (folder / "trials.csv").write_text("\n".join([head, *rows]) + "\n")
    return problem_of(read(folder))


def test_a_body_of_unknown_stiffness_has_its_restitution_measured(tmp_path: Path) -> None:
    metal = "E_Pa = 2e11\nnu = 0.3\nSy_Pa = 3e8"
    plain = of_ball(tmp_path / "plain")
    assert plain.baseline == "measured-restitution"
    assert any("of target and strikers.ball is stated: the restitution" in n for n in plain.notes)
    assert of_ball(tmp_path / "floor", ball=metal).baseline == "measured-restitution"
    assert of_ball(tmp_path / "ball", target=metal).baseline == "measured-restitution"
    # what says more of the contact than how fast a body leaves, and what the sheet says, go before
    for name, given in {
        "both": {"target": metal, "ball": metal},
        "asked": {"target": 'law = "elastic-plastic"'},
        "dent": {"read_as": "contact_time_s"},
    }.items():
        assert of_ball(tmp_path / name, **given).baseline == "elastic-plastic"
