"""What the layout promises: no circle of imports, small folders and functions, a wheel, sizes."""

import ast
import re
import runpy
import subprocess
import sys
import tomllib
import zipfile
from functools import cache
from pathlib import Path

import grimp
import numpy as np
import pytest
from dentscope.campaigns import read_curves
from dentscope.cli import studies
from dentscope.core.inputs.added import READERS, names_added
from dentscope.models.coefficients import drawn_from
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
APART = {"tests", "examples", "docs", "tools", "data", "build"}
ITS_OWN = ("__init__.py", "__main__.py")  # the build refuses any other module at the root
KERNELS_KEY = "disallow_untyped_defs"


@cache
def sources() -> tuple[Path, ...]:
    # a user's folder beside them, what `export` wrote for one, is no package
    packages = sorted(p.parent for p in ROOT.glob("*/__init__.py") if p.parent.name not in APART)
    modules = (p for folder in packages for p in sorted(folder.rglob("*.py")))
    return tuple(p.relative_to(ROOT) for p in (*(ROOT / n for n in ITS_OWN), *modules))


@cache
def tree(path: Path) -> ast.Module:
    return ast.parse((ROOT / path).read_text(encoding="utf-8"))


def in_workshop(path: Path) -> bool:
    return path.parts[0] == "studies"


def functions(path: Path) -> list[ast.FunctionDef | ast.AsyncFunctionDef]:
    kinds = ast.FunctionDef | ast.AsyncFunctionDef
    return [node for node in ast.walk(tree(path)) if isinstance(node, kinds)]


def lengths(*, tool_only: bool) -> dict[str, int]:
    return {
        f"{path}:{f.name}": f.end_lineno - f.lineno + 1
        for path in sources()
        if not (tool_only and in_workshop(path))
        for f in functions(path)
    }


def test_the_root_holds_the_packages_own_modules_alone():
    """The root is the package: any other module there would ship in the wheel."""
    assert {p.name for p in ROOT.glob("*.py")} == {"__init__.py", "__main__.py"}


def test_a_public_class_has_a_name_of_its_own():
    places: dict[str, list[str]] = {}
    for path in (p for p in sources() if p.parts[0] != "studies"):
        for node in tree(path).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                places.setdefault(node.name, []).append(str(path))
    assert not {name: found for name, found in places.items() if len(found) > 1}


def test_each_kind_of_array_has_one_name():
    named = [
        str(path)
        for path in sources()
        for kind in ("float64", "int64", "intp", "int_", "bool_")
        if f"NDArray[np.{kind}]" in (ROOT / path).read_text(encoding="utf-8")
    ]
    assert set(named) == {"core/arrays.py"}


def test_no_circle_of_imports():
    graph = grimp.build_graph("dentscope", exclude_type_checking_imports=True, cache_dir=None)
    names = sorted(n for n in graph.modules if n.split(".")[1:2] not in [[a] for a in APART])
    place = {name: i for i, name in enumerate(names)}
    edges = [
        (place[name], place[other])
        for name in names
        for other in graph.find_modules_directly_imported_by(name)
        if other in place
    ]
    assert len(edges) > 500  # the graph was read
    rows, columns = np.array(edges).T
    size = (len(names), len(names))
    links = csr_array((np.ones(len(edges)), (rows, columns)), shape=size)
    _, label = connected_components(links, connection="strong")
    groups = [[n for n in names if label[place[n]] == k] for k in np.unique(label)]
    assert [g for g in groups if len(g) > 1] == []


def test_a_folder_of_modules_shows_at_most_twenty_names():
    """Modules and folders, of the package and of its tests; what a package says of itself aside."""
    tests = (p.relative_to(ROOT) for p in (ROOT / "tests").rglob("*.py"))
    names: dict[Path, set[str]] = {}
    for path in (*sources(), *tests):
        for part in (path, *path.parents):
            if part.parent != part and part.name not in ("__init__.py", "conftest.py"):
                names.setdefault(part.parent, set()).add(part.name)
    names.pop(Path())  # the root, where tools look for their files
    assert len(names) > 60
    # a folder that a recipe adds to has room for one more
    recipes = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    growing = {Path(folder) for folder in re.findall(r"`([\w/]+)/NAME\b", recipes)}
    assert Path("reduce") in growing
    full = {str(folder): len(n) for folder, n in names.items() if len(n) > 20 - (folder in growing)}
    assert full == {}, "give what belongs together a folder of its own"


def test_no_function_is_longer_than_a_hundred_lines():
    assert {k: n for k, n in lengths(tool_only=False).items() if n > 100} == {}


def test_few_functions_are_longer_than_a_screen():
    long = {k: n for k, n in lengths(tool_only=True).items() if n > 60}
    assert len(long) <= 10, long


def test_every_command_is_used_out_of_the_wheel():
    """`make wheel` fails for a command that it leaves out, but only after minutes."""
    wheel = runpy.run_path(str(ROOT / "tools" / "try_wheel.py"))
    uses = wheel["SOLVER"] + wheel["IMPACT"] + wheel["WITH_EXTRAS"]
    # those of the workshop as one, as a wheel has them
    commands = {
        next((one for one in studies.COMMANDS if f"{name} ".startswith(f"{one} ")), name)
        for name in wheel["commands"](Path(sys.prefix))
    }
    assert len(commands) > 40
    commands -= {f"reduce {name}" for name in names_added(READERS)}  # of whoever tries one
    missed = {c for c in commands if not any(use.is_of(c) for use in uses)}
    assert missed == set(), "each needs a Use in tools/try_wheel.py"


def test_the_wheel_holds_every_package_but_the_workshop():
    packages = {
        ".".join(("dentscope", *path.parent.parts))
        for path in sources()
        if path.name == "__init__.py" and not in_workshop(path)
    }
    assert set(PROJECT["tool"]["setuptools"]["packages"]) == packages


def kernel_modules() -> list[str]:
    (override,) = (o for o in PROJECT["tool"]["mypy"]["overrides"] if o.get(KERNELS_KEY) is False)
    named = [name.partition(".")[2].replace(".", "/") + ".py" for name in override["module"]]
    # a name without a file stays, and fails where it is read
    found = [p for name in named for p in sorted(ROOT.glob(name)) or [ROOT / name]]
    return [str(p.relative_to(ROOT)) for p in found if p.name != "__init__.py"]


def typed(function: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    a = function.args
    named = [*a.posonlyargs, *a.args, *a.kwonlyargs, *filter(None, (a.vararg, a.kwarg))]
    bare = [one for one in named if one.annotation is None and one.arg not in ("self", "cls")]
    return not bare and (function.returns is not None or function.name == "__init__")


def compiled(module: ast.Module) -> set[str]:
    makers = {"njit", "register_jitable", "vectorize", "guvectorize", "overload", "cfunc"}
    makers |= {"kernel", "loading_kernel", "branch_kernel", "residual_kernel"}

    def makes(node: ast.expr) -> bool:
        while isinstance(node, ast.Call):
            node = node.func
        return isinstance(node, ast.Name) and node.id in makers

    found = set()
    for node in ast.walk(module):
        if isinstance(node, ast.FunctionDef) and any(map(makes, node.decorator_list)):
            found.add(node.name)
        if isinstance(node, ast.Call) and makes(node.func):
            found |= {a.id for a in node.args if isinstance(a, ast.Name)}
    return found


@pytest.mark.parametrize("name", kernel_modules())
def test_only_kernels_go_without_types(name):
    """What mypy is told to pass over is numba's, and each module of the list has such a kernel."""
    path = Path(name)
    bare = {f.name for f in functions(path) if not typed(f)}
    assert bare, f"{name} needs no exemption"
    assert bare - compiled(tree(path)) == set()


def last_name(node: ast.expr) -> str:
    return ast.unparse(node.func if isinstance(node, ast.Call) else node).rsplit(".", 1)[-1]


def test_a_dataclass_with_an_unstated_number_compares_by_what_is_stated():
    """nan is not nan: `core/unstated.py` makes two values equal that leave the same unstated."""
    found = {}
    for node in (n for path in sources() for n in ast.walk(tree(path))):
        if isinstance(node, ast.ClassDef):
            decorators = {last_name(d) for d in node.decorator_list}
            values = [b.value for b in node.body if isinstance(b, ast.AnnAssign) and b.value]
            if "dataclass" in decorators and any(last_name(v) == "nan" for v in values):
                found[node.name] = decorators
    assert {"Material", "Striker", "Surroundings"} <= set(found)
    assert not [name for name, decorators in found.items() if "unstated_equal" not in decorators]


def test_the_version_is_the_same_wherever_it_stands():
    (version,) = (
        node.value.value
        for node in tree(Path("__init__.py")).body
        if isinstance(node, ast.Assign) and node.targets[0].id == "__version__"
    )
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8").splitlines()
    assert f"version: {version}" in citation
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8").splitlines()
    heads = [line.split() for line in changes if line.startswith("## ")]
    if heads[0][2:] == ["(unreleased)"]:  # what is being made stands above what went out
        assert heads.pop(0)[1] > version
    assert heads[0][1] == version


LEDGER = runpy.run_path(str(ROOT / "tools" / "ledger.py"))
SIZE = {"lines": 150.0, "code": 100.0, "modules": 50.0, "numbers": 10.0, "words": 0.0}


def test_a_part_that_grew_by_more_than_two_percent_is_found():
    assert LEDGER["grown"]({"fem": SIZE | {"code": 102.0, "lines": 900.0}}, {"fem": SIZE}) == {}
    assert LEDGER["grown"]({"fem": SIZE | {"code": 103.0}}, {"fem": SIZE}) == {"fem": ["code"]}
    assert LEDGER["grown"]({"new": SIZE}, {}) == {"new": ["code", "modules", "numbers"]}


def test_growth_is_excused_where_the_newest_version_says_what_for():
    older = "## 0.3.0\n\nFor developers:\n\n- cli grew: long ago\n"
    newest = "## 0.4.0\n\n- cli grew: to users\n\nFor developers:\n\n- fem grew: C\n- core grew:\n"
    assert LEDGER["accounted"]("# Changelog\n\n" + newest + older) == {"fem"}


def test_lines_of_code_are_without_blanks_comments_and_docstrings():
    text = '"""Told\nwell."""\n\nX = (  # a comment\n    1,\n)\n# alone\ndef f():\n    """Do."""\n'
    assert LEDGER["code_lines"](text, ast.parse(text)) == {4, 5, 6, 8}


def test_every_stage_is_in_it():
    assert {"fem", "fitting", "models", "campaigns", "dynamics", "reduce"} < set(LEDGER["parts"]())


SMALLEST = """
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
    (tmp_path / "pyproject.toml").write_text(SMALLEST)
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


DIGESTS = runpy.run_path(str(ROOT / "tools" / "digests.py"))


def test_the_page_of_digests_is_what_the_files_say():
    told, found = DIGESTS["PAGE"].read_text(), DIGESTS["page"]()
    assert told == found, "run `python tools/digests.py`, after making anew what it names"


def test_the_coefficients_come_from_published_parts():
    assert all("-" in name and name.endswith(".h5") for name in DIGESTS["parts_read"]())


def test_the_challenge_was_drawn_from_these_coefficients():
    fitted = drawn_from()
    names = [
        r.case.name
        for part in sorted((ROOT / "data" / "challenge").glob("*.h5"))
        for r in read_curves(part)
    ]
    assert len(names) == 24
    assert all(any(fitted.startswith(bit) for bit in name.split("-") if len(bit) > 5)
               for name in names), names[:2]  # fmt: skip


def test_benchmarks_import_without_the_paths_of_the_tests():
    code = (
        "import runpy, sys\n"
        "for file in sys.argv[1:]:\n"
        "    kept = sys.path[:]\n"
        "    runpy.run_path(file, run_name='imported')\n"
        "    sys.path[:] = kept\n"
        "    for name in [n for n in sys.modules if n.startswith('made_')]: del sys.modules[name]\n"
    )
    folder = ROOT / "tools" / "benchmarks"
    files = [f for f in folder.glob("*.py") if "__main__" in f.read_text(encoding="utf-8")]
    assert len(files) > 15
    ended = subprocess.run(
        [sys.executable, "-c", code, *map(str, files)], cwd=folder, capture_output=True, text=True
    )
    assert ended.returncode == 0, ended.stderr
