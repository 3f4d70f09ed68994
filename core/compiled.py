"""Where numba keeps its compiled code: one folder for each state of the source.

numba renews a cached function when the file that holds it changes, but not when a function that
it calls, in another file, does. A folder named after all compiled sources can never be stale, and
it works where the package itself cannot be written to.
"""

from __future__ import annotations

import hashlib
import os
import platform
import re
import shutil
import stat
import tempfile
from contextlib import suppress
from pathlib import Path

from .processes.children import compile_without_the_folders_settings

_STAGES = ("core", "fem", "models", "dynamics", "discrepancy", "studies")
# limit: names that are tried for a folder of one's own [-]: more are an attack
_MOST_NAMES = 20
_VARIABLE = "NUMBA_CACHE_DIR"
SHIPPED = "compiled"
"""Folder of the package with compiled code that came with it: SHIPPED/DIGEST/ as the sources."""
COMPILED_FOR = {"NUMBA_CPU_NAME": "x86-64-v3", "NUMBA_CPU_FEATURES": "+avx2,+fma"}
"""What all is compiled for, as numba is told: processors since 2013, which then compute alike."""
_COMPILES = re.compile(r"numba|njit|_kernel\b|@kernel\b")
_RELATIVE = re.compile(r"^\s*from (\.+)([\w.]*) import (\([^)]*\)|.*)", re.MULTILINE)


def source_digest(root: Path) -> str:
    """First 16 hexadecimal digits of the SHA-256 of the sources under `root` that are compiled."""
    digest = hashlib.sha256()
    for path in sorted(compiled_sources(root)):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def compiled_sources(root: Path) -> set[Path]:
    """Return the files of the package at `root` whose change may change compiled code.

    These are the files that compile something, by numba or by a decorator of `models.kernel`, and
    all that they import, and so on: compiled code takes in other files' functions and constants.
    """
    files: set[Path] = set()
    for stage in _STAGES:
        for path in (root / stage).rglob("*.py"):
            if path not in files and _COMPILES.search(path.read_text(encoding="utf-8")):
                _add_with_imports(path, files)
    return files


def _add_with_imports(path: Path, files: set[Path]) -> None:
    if path in files:
        return
    files.add(path)
    for dots, name, what in _RELATIVE.findall(path.read_text(encoding="utf-8")):
        base = path.parents[len(dots) - 1].joinpath(*filter(None, name.split(".")))
        # a module; of a package its modules by name, or what it re-exports
        for word in what.partition("#")[0].strip("()").split(","):
            module = base / f"{word.split(' as ')[0].strip()}.py"
            for file in (base.with_suffix(".py"), module, base / "__init__.py"):
                if file.is_file():
                    _add_with_imports(file, files)
                    break


def keep_compiled_code() -> None:
    """Point numba at this source's folder, unless the user chose one.

    What came compiled with the package is put there where this machine can run it. To be called
    before numba is imported; afterwards it has no effect. Settings of numba that lie in the current
    folder have none either.
    """
    if not os.environ.get(_VARIABLE):
        root = Path(os.path.abspath(__file__)).parents[1]  # links are not followed: numba's way
        digest = source_digest(root)
        folder = cache_folder(f"compiled-{digest}")
        os.environ[_VARIABLE] = str(folder)
        if runs_compiled() and "NUMBA_CPU_NAME" not in os.environ:
            os.environ.update(COMPILED_FOR)
        if COMPILED_FOR.items() <= os.environ.items():
            take(root / SHIPPED / digest, root, folder)
    compile_without_the_folders_settings()


def runs_compiled() -> bool:
    """Whether this machine can run what is compiled for `COMPILED_FOR`."""
    if (platform.system(), platform.machine()) != ("Linux", "x86_64"):
        return False
    with suppress(OSError), Path("/proc/cpuinfo").open() as lines:
        # of the first processor: hundreds of them take a while to be told
        flags = next((line for line in lines if line.startswith("flags")), "")
        return {"avx2", "fma", "bmi1", "bmi2", "abm", "movbe", "f16c"} <= set(flags.split())
    return False


def take(shipped: Path, root: Path, folder: Path) -> None:
    """Copy compiled code of the package at `root` to where numba looks for it, if not there."""
    with suppress(OSError):
        for file in sorted(shipped.rglob("*.nb?")):  # an index, .nbi, after what it names
            place = folder / name_by_numba(root / file.parent.relative_to(shipped)) / file.name
            if not place.exists():
                place.parent.mkdir(exist_ok=True)
                draft = place.with_suffix(f".{os.getpid()}")  # another process may do the same
                shutil.copyfile(file, draft)
                draft.rename(place)


def name_by_numba(source: Path) -> str:
    """Return what numba calls its folder for the code of the modules in a folder."""
    return f"{source.name}_{hashlib.sha1(str(source).encode()).hexdigest()}"


def cache_folder(name: str) -> Path:
    """Return the user's own folder for what can be made again; made if there is none."""
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    kept = Path(tempfile.gettempdir()) / f"dentscope-of-{os.geteuid()}"
    return _own(_own(base / "dentscope", kept) / name)


def _own(place: Path, *others: Path) -> Path:
    """Return a folder that is this user's and that nobody else may write; made if there is none.

    numba runs what it finds there: where the name is taken by a folder of others, or by one that
    others may have put something into, the next name is; where none can be made, the next place.
    """
    for name in (place.name, *(f"{place.name}-{k}" for k in range(2, _MOST_NAMES))):
        folder = place.with_name(name)
        with suppress(OSError):
            folder.parent.mkdir(parents=True, exist_ok=True)
            folder.mkdir(mode=0o700)
        with suppress(OSError):
            about = folder.lstat()
            shared = about.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
            if stat.S_ISDIR(about.st_mode) and about.st_uid == os.geteuid() and not shared:
                return folder
    return _own(*others) if others else Path(tempfile.mkdtemp(prefix="dentscope-"))
