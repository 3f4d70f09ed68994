"""Build backend: setuptools', which would ship every module at the root; these refuse others."""

from pathlib import Path

from setuptools import build_meta
from setuptools.build_meta import (
    build_editable,
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
