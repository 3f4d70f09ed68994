"""Whether pyvista can render off-screen here.

Without its graphics libraries VTK ends the whole process, which no exception handler sees; the
question is therefore put to a process of its own, once.
"""

from __future__ import annotations

import subprocess
from functools import cache
from typing import Any

from .processes.children import python_command

# limit: time of a trial picture off screen [s]
_RENDER_S = 120.0


@cache
def offscreen_available() -> bool:
    """Return whether a picture can be rendered in this environment.

    The answer holds for the life of the process; a probe that hangs counts as a no.
    """
    try:
        answer = subprocess.run(
            python_command("-m", "dentscope.core.rendering"),
            capture_output=True,
            timeout=_RENDER_S,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return answer.returncode == 0


def offscreen_plotter(width: int, height: int) -> Any:
    """Return pyvista's plotter for a picture of this size [pixels], without VTK's own warnings."""
    import pyvista
    from vtkmodules.vtkCommonCore import vtkLogger

    # without a screen VTK tries one, says so, and then renders without
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    return pyvista.Plotter(off_screen=True, window_size=[width, height])


def _probe() -> None:
    import pyvista

    plotter = offscreen_plotter(64, 64)
    plotter.add_mesh(pyvista.Sphere())
    image = plotter.screenshot(return_img=True)
    plotter.close()
    if image is None or image.max() == image.min():
        raise SystemExit(1)


if __name__ == "__main__":
    _probe()
