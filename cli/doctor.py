"""`dentscope doctor`: what this environment has, and what to do about what it lacks."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from typing import NamedTuple

import typer

from ..core.processes.children import python_command
from . import studies

_SYSTEM_PACKAGES = (
    "libgl1 libglu1-mesa libxrender1 libxcursor1 libxft2 libxinerama1 libgomp1 libegl1"
)
_REMEDY = f"sudo apt-get install --no-install-recommends {_SYSTEM_PACKAGES}"
EXIT_ENVIRONMENT = 1
"""Exit code for an environment in which the solver cannot run."""


class EnvironmentFinding(NamedTuple):
    """One thing looked at."""

    name: str
    state: str  # what was found
    fine: bool = True
    needed: bool = False  # the solver cannot run without it
    remedy: str = ""  # what to do when it does not work


def doctor() -> int:
    """Check gmsh, rendering and compiled code; name what to install."""
    findings = examine()
    for finding in findings:
        mark = "ok" if finding.fine else ("MISSING" if finding.needed else "absent")
        typer.echo(f"{mark:8} {finding.name:20} {finding.state}")
        if not finding.fine:
            typer.echo(f"{'':8} {'':20} -> {finding.remedy}")
    return EXIT_ENVIRONMENT if any(one.needed and not one.fine for one in findings) else 0


def examine() -> tuple[EnvironmentFinding, ...]:
    """Look at everything that can be missing, each in the order in which a run meets it."""
    from ..core.provenance import environment
    from ..core.rendering import offscreen_available

    shown = ", ".join(f"{name} {version}" for name, version in environment().items())
    renders = offscreen_available()
    return (
        EnvironmentFinding("versions", shown),
        EnvironmentFinding("processors", str(os.cpu_count() or 1)),
        EnvironmentFinding("docs, examples, data", str(Path(__file__).resolve().parents[1])),
        EnvironmentFinding("workshop", "here" if studies.present() else studies.WHERE),
        _gmsh(),
        EnvironmentFinding(
            "off-screen pictures", "pyvista renders" if renders else "no pictures in space",
            fine=renders, remedy=_REMEDY,
        ),
        _compiled_code(),
    )  # fmt: skip


def _gmsh() -> EnvironmentFinding:
    # asked in a process of its own: a half-loaded library would stay in this one
    answer = subprocess.run(
        python_command("-c", "import gmsh"), capture_output=True, text=True, check=False
    )
    if answer.returncode == 0:
        return EnvironmentFinding("gmsh", "loads", needed=True)
    last = (answer.stderr.strip().splitlines() or ["ended without a message"])[-1]
    return EnvironmentFinding("gmsh", last, fine=False, needed=True, remedy=_REMEDY)


def _compiled_code() -> EnvironmentFinding:
    """Say where numba keeps compiled code: beside the source, or in the user's cache folder."""
    remedy = "name a writable folder in the environment variable NUMBA_CACHE_DIR"
    try:
        from ..fem import assemble
    except RuntimeError as error:  # numba found no folder that it may write to
        return EnvironmentFinding(
            "compiled code", str(error), fine=False, needed=True, remedy=remedy
        )
    kernels = (value for value in vars(assemble).values() if hasattr(value, "stats"))
    return EnvironmentFinding("compiled code", f"kept in {next(kernels).stats.cache_path}")
