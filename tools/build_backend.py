"""Build backend: setuptools', which would ship every module at the root; these refuse others.

An editable install has the types too: type checkers don't run the hook by which Python finds it.
"""

import base64
import hashlib
import zipfile
from pathlib import Path

from setuptools import build_meta
from setuptools.build_meta import (
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

__all__ = [
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
    "prepare_metadata_for_build_editable",
    "prepare_metadata_for_build_wheel",
]
OWN = {"__init__.py", "__main__.py"}
TYPING = Path(".typing")
"""Links by which mypy and editors find the package under its name, whatever the clone is called."""


def _refuse_others() -> None:
    """The root is the package: a module left there by chance would be shipped."""
    others = sorted(path.name for path in Path.cwd().glob("*.py") if path.name not in OWN)
    if others:
        raise SystemExit(f"{', '.join(others)}: no module of the package; move or delete it")


def build_wheel(directory, config_settings=None, metadata_directory=None):
    """Return the name of the wheel that is built into a folder."""
    _refuse_others()
    return build_meta.build_wheel(directory, config_settings, metadata_directory)


def build_sdist(directory, config_settings=None):
    """Return the name of the source archive that is built into a folder."""
    _refuse_others()
    return build_meta.build_sdist(directory, config_settings)


def build_editable(directory, config_settings=None, metadata_directory=None):
    """Return the name of the wheel that leads to this checkout, for Python and type checkers."""
    name = build_meta.build_editable(directory, config_settings, metadata_directory)
    path = Path(directory) / name
    with zipfile.ZipFile(path) as made:
        files = {entry: made.read(entry) for entry in made.namelist()}
    leads = f"{_stubs()}\n".encode()
    digest = base64.urlsafe_b64encode(hashlib.sha256(leads).digest()).rstrip(b"=").decode()
    files["dentscope-stubs.pth"] = leads
    (record,) = (entry for entry in files if entry.endswith(".dist-info/RECORD"))
    files[record] += f"dentscope-stubs.pth,sha256={digest},{len(leads)}\n".encode()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as wheel:
        for entry, content in files.items():
            wheel.writestr(entry, content)
    return name


def _stubs():
    """Make the links anew; return the folder with the package as stubs, which Python passes over.

    A link to the root itself would hold itself: there is one for each part.
    """
    package = TYPING / "dentscope"
    for old in package.glob("*"):
        old.unlink()
    package.mkdir(parents=True, exist_ok=True)
    parts = [path.parent.name for path in Path.cwd().glob("*/__init__.py")]
    for part in [*OWN, "py.typed", *parts]:
        (package / part).symlink_to(Path("../..", part))
    (package / "__init__.pyi").symlink_to("../../__init__.py")
    stubs = TYPING / "stubs"
    stubs.mkdir(exist_ok=True)
    link = stubs / "dentscope-stubs"
    link.unlink(missing_ok=True)
    link.symlink_to("../dentscope")
    return stubs.resolve()
