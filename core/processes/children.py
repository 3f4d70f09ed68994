"""Python processes that this one starts: what they may load, and that they end when it does.

None runs code of the folder that it happens to be in.

A downloaded folder may hold a `numpy.py`. Python looks there first when it is started with `-m` or
`-c`, unless told otherwise; the interpreters of multiprocessing are started like that.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from contextlib import suppress
from importlib import import_module
from pathlib import Path

# limit: between two looks whether the parent is still there [s]
_PARENT_LOOK_S = 0.5

_VARIABLE = "PYTHONSAFEPATH"


def python_command(*arguments: str) -> list[str]:
    """Return the command line of this Python with arguments, the current folder left out.

    Examples
    --------
    >>> python_command("-m", "dentscope")[1:]
    ['-P', '-m', 'dentscope']
    """
    return [sys.executable, "-P", *arguments]


def keep_current_folder_out() -> None:
    """Let Python processes that start from now on look for no modules in the current folder."""
    os.environ[_VARIABLE] = "1"


def forget_current_folder() -> None:
    """Look for no more modules in the current folder, where `python -m` has put it first.

    What was imported before is beyond reach: only `python -P -m` keeps it out from the beginning.
    """
    keep_current_folder_out()
    if _looks_in_current_folder():
        del sys.path[0]


def _looks_in_current_folder() -> bool:
    if sys.flags.safe_path or not sys.path:
        return False
    with suppress(OSError):  # a folder that was deleted meanwhile
        return sys.path[0] in ("", os.getcwd())
    return False


def plot_without_the_folders_settings() -> None:
    """Load matplotlib such that a `matplotlibrc` of the current folder has no say.

    It would come before the user's own. Pictures are drawn into files: a screen has no say either.
    """
    os.environ["MPLBACKEND"] = "agg"
    _load_elsewhere("matplotlib", "matplotlibrc")


def compile_without_the_folders_settings() -> None:
    """Load numba such that a `.numba_config.yaml` of the current folder has no say.

    It may name files to write and modules to load. numba reads it again whenever it compiles.
    Where Python itself still looks for modules in that folder, this is left to a later call.
    """
    settings = ".numba_config.yaml"
    if "numba" in sys.modules or (os.path.lexists(settings) and _looks_in_current_folder()):
        return
    if _load_elsewhere("numba", settings):
        sys.modules["numba.core.config"]._config_fname = os.devnull  # type: ignore[attr-defined]


def _load_elsewhere(module: str, settings: str) -> bool:
    """Load a module outside the current folder if that holds a file of settings for it."""
    if not os.path.lexists(settings):
        return False
    here = os.open(".", os.O_RDONLY)
    os.chdir(Path(__file__).parent)
    try:
        import_module(module)
    finally:
        os.chdir(here)
        os.close(here)
    return True


def die_with(parent: int) -> None:
    """End this process when the one that started it is gone: a killed run leaves nothing behind.

    `parent` is what `os.getppid()` gives it.
    """

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(_PARENT_LOOK_S)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
