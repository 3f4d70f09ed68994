"""Add a mechanism of your own, and ask a recording set for it: here a magnet under the flat."""

# %% What it changes of a blow, with its free number: energy that is gone before the touch.
from dataclasses import replace

import dentscope as ds
from dentscope.discrepancy import Mechanism, Parameter


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


# %% A verdict with it beside the library's own: does it take part?
found = ds.diagnose("leeb-steel-800hv", mechanisms=[Brake()])
print(found)
part = found.verdict.inclusion.get("brake", 0.0)
print(f"a brake takes part with a probability of {part:.0%}")

# %% The verdict says that neither calibration nor proof covers it. The report has it too.
print(next(note for note in found.verdict.notes if note.startswith("brake")))
print(found.report("build/brake.html"))
