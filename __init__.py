"""dentscope: elastic-plastic contact and impact, from the mesh to the missing physics.

    import dentscope as ds

    ds.impact("ball", speed=2.0)               a blow, by several contact laws; of a pair, a file,
                                               a set-up to start from
    ds.sweep("ball", speed=[1, 2, 4])          many blows, as a table
    ds.diagnose("my-recordings")               what physics the simulation of them lacks
    ds.case("case.toml")                       one's own pair by finite elements
    ds.compare_laws("case.toml")               the same by every contact law, and which to use
    ds.material("aluminium-6061-t6")           a metal of the table of `dentscope materials`
    ds.LAWS                                    every contact law, as a table
    ds.InputError                              what a wrong argument or file raises, in one line

The stages, in the order in which a result passes through them; each is loaded when it is used:

    core         materials, input errors, outcomes, provenance
    fem          gmsh mesh and finite-strain contact solve of a sphere and a flat
    models       closed-form contact laws behind one contract
    campaigns    hundreds of finite-element cases, a file each; published as parts
    fitting      closed forms fitted to a campaign
    dynamics     a sphere or a round-ended rod striking the flat
    recordings   sets of measured impacts, checked and audited
    reduce       raw files of instruments to numbers with errors
    discrepancy  what physics the simulation of a recording left out
    start        the calls of a newcomer, above all stages
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

# absolute: pytest imports this file under another name where the checkout's is no identifier
from dentscope.core.compiled import keep_compiled_code

__version__ = "0.3.0"

_STAGES = (
    "core", "fem", "models", "campaigns", "fitting", "dynamics", "recordings", "reduce",
    "discrepancy", "start",
)  # fmt: skip

__all__ = [
    "LAWS", "InputError", "Material", "Pair", "case", "compare_laws", "diagnose", "impact",
    "material", "sweep",
]  # fmt: skip

keep_compiled_code()

if TYPE_CHECKING:  # a function __getattr__ would hide every misspelt name
    from dentscope import campaigns as campaigns
    from dentscope import core as core
    from dentscope import discrepancy as discrepancy
    from dentscope import dynamics as dynamics
    from dentscope import fem as fem
    from dentscope import fitting as fitting
    from dentscope import models as models
    from dentscope import recordings as recordings
    from dentscope import reduce as reduce
    from dentscope import start as start
    from dentscope.core import InputError
    from dentscope.models import LAWS
    from dentscope.start import (
        Material,
        Pair,
        case,
        compare_laws,
        diagnose,
        impact,
        material,
        sweep,
    )
else:

    def __getattr__(name: str) -> Any:
        """Load a stage, or a name of one, when it is first asked for."""
        if name in _STAGES:
            return import_module(f"dentscope.{name}")
        if name in __all__:
            stage = {"LAWS": "models", "InputError": "core"}.get(name, "start")
            return getattr(import_module(f"dentscope.{stage}"), name)
        raise AttributeError(f"module 'dentscope' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*__all__, *_STAGES, "__version__"})
