"""dentscope: elastic-plastic contact and impact, from the mesh to the missing physics.

The stages, in the order in which a result passes through them:

    core         materials, input errors, outcomes, provenance
    fem          gmsh mesh and finite-strain contact solve of a sphere and a flat
    models       closed-form contact laws behind one contract
    campaigns    hundreds of finite-element cases into one HDF5 file
    fitting      closed forms fitted to a campaign
    impact       a sphere or a round-ended rod striking the flat
    recordings   measured impacts, reduced and checked
    discrepancy  what physics the simulation of a recording left out
"""

# absolute: pytest imports this file under another name where the checkout's is no identifier
from dentscope.core.compiled import keep_compiled_code

__version__ = "0.1.0"

keep_compiled_code()
