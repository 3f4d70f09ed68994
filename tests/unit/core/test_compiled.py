"""Compiled code: kept apart for each state of the source; arrays without a count of references."""

import ast
import gc
import os
import shutil
import stat
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
from dentscope.core import compiled
from dentscope.core.compiled import compiled_sources, source_digest
from dentscope.core.unowned import unowned
from made_files import put
from made_processes import python
from numba import njit


def test_the_folder_follows_compiled_files_and_what_they_import(tmp_path):
    text = "from numba import njit\nfrom ..core.constants import X\n"
    kernel = put(tmp_path / "fem" / "kernel.py", text)
    constants = put(tmp_path / "core" / "constants.py", "X = 1\n")
    other = put(tmp_path / "fem" / "other.py", "y = 1\n")
    before = source_digest(tmp_path)
    other.write_text("y = 2\n")
    assert source_digest(tmp_path) == before
    constants.write_text("X = 2\n")
    renewed = source_digest(tmp_path)
    assert renewed != before
    kernel.write_text(kernel.read_text() + "# changed\n")
    assert source_digest(tmp_path) != renewed


def test_whatever_is_compiled_is_among_the_sources():
    root = Path(compiled.__file__).parents[1]
    stages = ("core", "fem", "models", "dynamics", "fitting", "campaigns", "discrepancy", "reduce",
              "recordings", "studies", "start", "cli")  # fmt: skip
    files = {path for stage in stages for path in (root / stage).rglob("*.py")}
    kernels = {path for path in files if decorators(path) & KERNELS}
    assert {p.stem for p in kernels} > {"ceb", "stronge", "compiled", "assemble", "energy_table"}
    assert kernels - compiled_sources(root) == set()
    # what only tells or draws compiles nothing anew
    assert not any(p.stem in ("draw", "report", "app") for p in compiled_sources(root))


KERNELS = {"njit", "kernel", "loading_kernel", "branch_kernel", "residual_kernel", "intrinsic"}


def decorators(path: Path) -> set[str]:
    """Names by which functions of a file are decorated or, as `njit(f)`, wrapped."""
    names = (
        name.func if isinstance(name, ast.Call) else name
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        for name in (getattr(node, "decorator_list", None) or [node])
    )
    return {name.id for name in names if isinstance(name, ast.Name)}


def test_an_edited_law_reaches_the_law_that_takes_it_in(tmp_path):
    root = Path(compiled.__file__).parents[1]
    copy = tmp_path / "dentscope"
    for stage in (".", "core", "fem", "models", "dynamics"):
        for path in (root / stage).glob("*.py" if stage == "." else "**/*.py"):
            target = copy / path.relative_to(root)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, target)
    shutil.copytree(root / "data" / "coefficients", copy / "data" / "coefficients")
    code = """
from dentscope.core import Material, Pair
from dentscope.models.published.stronge import STRONGE
ball, flat = Material(E=2e11, nu=0.3), Material(E=2e11, nu=0.3, Sy=1e9)
print(float(sum(STRONGE.residual(Pair(ball, flat, 0.01), 3e-4))))
"""

    def residual(cache="cache"):
        # as a user's: no other cache, sources as they are
        env = {k: v for k, v in os.environ.items() if not k.startswith("NUMBA_")}
        env |= {"XDG_CACHE_HOME": str(tmp_path / cache), "PYTHONPATH": str(tmp_path)}
        return float(python("-c", code, env=env, cwd=tmp_path, check=True).stdout)

    before = residual()
    # the same code, shipped with the sources, is taken as it is by a user who has none
    (kept,) = (tmp_path / "cache" / "dentscope").iterdir()
    shipped = copy / compiled.SHIPPED / source_digest(copy)
    for part in ("models", "models/published"):
        shutil.copytree(kept / compiled.name_by_numba(copy / part), shipped / part)
    assert residual("new-home") == before
    if compiled.runs_compiled():
        (taken,) = (tmp_path / "new-home" / "dentscope").iterdir()
        assert contents(taken) == contents(kept)
    law = copy / "models" / "published" / "ceb.py"
    text = law.read_text()
    radius = "math.sqrt(par[R] * (2.0"
    assert text.count(radius) == 1
    law.write_text(text.replace(radius, "math.sqrt(1.2 * par[R] * (2.0"))
    assert abs(residual() / before - 1.0) > 1e-3


def contents(folder):
    """Every file below a folder by its place, as bytes: an index tells what was compiled anew."""
    return {p.relative_to(folder): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def test_numba_is_pointed_there_and_a_choice_of_the_user_is_kept(tmp_path):
    code = "import dentscope, numba; print(numba.config.CACHE_DIR)"
    plain = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"}

    def answer(**extra):
        return python("-c", code, env=plain | extra, check=True).stdout.strip()

    assert answer(XDG_CACHE_HOME=str(tmp_path)).startswith(str(tmp_path / "dentscope"))
    assert answer(NUMBA_CACHE_DIR="/elsewhere") == "/elsewhere"


def test_a_folder_that_others_may_write_is_passed_over(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    planted = tmp_path / "dentscope"
    planted.mkdir()
    planted.chmod(0o777)
    compiled.keep_compiled_code()
    chosen = Path(os.environ["NUMBA_CACHE_DIR"])
    assert chosen.parent == tmp_path / "dentscope-2"
    assert stat.S_IMODE(chosen.stat().st_mode) == 0o700
    # a link to elsewhere is no folder of one's own either
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    (tmp_path / "dentscope-2").rename(tmp_path / "kept")
    (tmp_path / "dentscope-2").symlink_to(tmp_path / "kept")
    compiled.keep_compiled_code()
    assert Path(os.environ["NUMBA_CACHE_DIR"]).parent == tmp_path / "dentscope-3"


def test_without_a_home_the_next_command_finds_what_was_compiled(tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    monkeypatch.setattr(compiled.tempfile, "gettempdir", lambda: str(tmp_path))
    first = compiled.cache_folder("compiled-1")
    assert first.parent.parent == tmp_path
    assert compiled.cache_folder("compiled-1") == first


class Rows(NamedTuple):
    x: np.ndarray
    inner: tuple


@njit
def _row(x, k):
    return x[k]


@njit
def _doubled(rows, out, factor):
    rows, out = unowned(rows), unowned(out)
    for k in range(rows.x.shape[0]):
        row, to = _row(rows.x, k), out[k]
        for j in range(row.shape[0]):
            to[j] = factor * row[j] + rows.inner[0][k] + rows.inner[1]


def test_a_kernel_reads_and_writes_what_its_caller_holds():
    x, more = np.arange(12.0).reshape(4, 3), np.array([1.0, 2.0, 3.0, 4.0])
    out = np.empty((4, 3))
    _doubled(Rows(x, (more, 10)), out, 2.0)
    assert np.array_equal(out, 2.0 * x + more[:, None] + 10.0)


def test_nothing_is_kept_or_freed_too_soon():
    x, more, out = np.ones((200, 3)), np.zeros(200), np.empty((200, 3))
    held = [sys.getrefcount(array) for array in (x, more, out)]
    for _ in range(50):
        _doubled(Rows(x, (more, 1)), out, 1.0)
    assert [sys.getrefcount(array) for array in (x, more, out)] == held
    gc.collect()
    other = np.full((200, 3), 7.0)  # would take memory that was freed too soon
    assert np.all(x == 1.0)
    assert np.all(out == 2.0)
    assert np.all(other == 7.0)
