"""The closed form for other programs: as source in six languages, as a normal model of LAMMPS."""

from .lammps import STYLE
from .sources import NAME, write_sources
from .tree import INPUTS, OUTPUTS

__all__ = ["INPUTS", "NAME", "OUTPUTS", "STYLE", "write_sources"]
