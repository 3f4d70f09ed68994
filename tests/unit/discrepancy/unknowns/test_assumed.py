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
