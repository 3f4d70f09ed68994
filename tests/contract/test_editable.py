"""An editable install is found by Python, and by type checkers, which run no hook."""

from __future__ import annotations

import runpy
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROJECT = """
[build-system]
requires = ["setuptools"]
build-backend = "setuptools.build_meta"
[project]
name = "dentscope"
version = "1"
[tool.setuptools]
package-dir = {"dentscope" = "."}
packages = ["dentscope", "dentscope.core"]
"""


@pytest.mark.filterwarnings("ignore")  # setuptools' own of what it may drop some day
def test_stubs_of_an_editable_install_are_the_sources(tmp_path, monkeypatch) -> None:
    (tmp_path / "core").mkdir()
    (tmp_path / "pyproject.toml").write_text(PROJECT)
    for name in ("__init__.py", "__main__.py", "py.typed", "core/__init__.py"):
        (tmp_path / name).write_text("")
    (tmp_path / "core/numbers.py").write_text("ONE: int = 1\n")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "made").mkdir()
    backend = runpy.run_path(str(ROOT / "tools/build_backend.py"))
    for _ in range(2):  # made again over itself
        name = backend["build_editable"](str(tmp_path / "made"))
    with zipfile.ZipFile(tmp_path / "made" / name) as wheel:
        leads = wheel.read("dentscope-stubs.pth").decode()
        (record,) = (n for n in wheel.namelist() if n.endswith("RECORD"))
        assert "dentscope-stubs.pth,sha256=" in wheel.read(record).decode()
    stubs = Path(leads.strip()) / "dentscope-stubs"
    assert stubs.resolve().is_relative_to(tmp_path)
    assert (stubs / "__init__.pyi").is_file()
    assert (stubs / "py.typed").is_file()
    assert (stubs / "core/numbers.py").read_text() == "ONE: int = 1\n"
