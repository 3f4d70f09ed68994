"""Add a mechanism of your own, and ask a recording set for it: here a magnet under the flat."""

# %% What it changes of a blow, with its free number: a constant deceleration before the touch.
from dataclasses import replace
from pathlib import Path

from dentscope.discrepancy.comparison.forward import Simulator
from dentscope.discrepancy.comparison.problem import problem_of
from dentscope.discrepancy.mechanisms.base import Mechanism, Parameter
from dentscope.discrepancy.rank import rank
from dentscope.recordings import read
from dentscope.recordings.shipped import set_folder


class Brake(Mechanism):
    """Something takes energy from the striker before it touches."""

    name = "brake"
    title = "something brakes the striker before the touch"
    equations = "v^2 -> v^2 - 2 w"
    parameters = (
        Parameter("work_J_kg", "J/kg", 1e-3, 1.0, "log", 0.0, "as strong as a hand magnet"),
    )

    def attach(self, scene, values, around):
        a = scene.approach
        left = max(a.speed**2 - 2.0 * values["work_J_kg"], 1e-6)
        return scene.with_(approach=replace(a, speed=left**0.5))


# %% Fitted beside the baseline: is the set better explained with it?
problem = problem_of(read(set_folder(Path("leeb-steel-800hv"))))
ranking = rank(Simulator(problem), mechanisms=(Brake(),))
gain = None
if ranking.singles:
    (single,) = ranking.singles
    gain = single.log_evidence - ranking.base.log_evidence
    print(f"weight of evidence for a brake: {gain:+.2f} nat (3 would be 20 to 1)")
for name, reason in ranking.excluded.items():
    print(f"{name} is excluded: {reason}")
