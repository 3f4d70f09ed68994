"""Carry out a recipe of CONTRIBUTING.md: its files laid over the checkout's, in a process apart."""

import re
from pathlib import Path

import pytest
from made_processes import python

ROOT = Path(__file__).resolve().parents[3]
PAGE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
RECIPES = dict(re.findall(r"^## (.+)\n((?:(?!^## ).*\n)+)", PAGE, re.MULTILINE))

# modules come from the folder OVER where it has them, else from the checkout
OVERLAY = """
import sys
from importlib.machinery import SourceFileLoader
from importlib.util import spec_from_file_location
from pathlib import Path

ROOT, OVER = Path(sys.argv[1]), Path(sys.argv[2])

class Laid(SourceFileLoader):
    def get_code(self, fullname):
        return compile(self.over.read_bytes(), self.path, "exec", dont_inherit=True)

class Finder:
    def find_spec(self, name, path=None, target=None):
        first, _, rest = name.partition(".")
        if first != "dentscope" or not rest:
            return None
        part = Path(*rest.split("."))
        for file, package in ((part.with_suffix(".py"), False), (part / "__init__.py", True)):
            if (OVER / file).is_file():
                place = ROOT / file if (ROOT / file).is_file() else OVER / file
                loader = Laid(name, str(place))
                loader.over = OVER / file
                inside = [str(ROOT / part), str(OVER / part)] if package else None
                return spec_from_file_location(
                    name, place, loader=loader, submodule_search_locations=inside
                )

sys.meta_path.insert(0, Finder())
if sys.argv[3] == "pytest":
    import pytest
    sys.exit(pytest.main(sys.argv[4:]))
from dentscope.__main__ import main
sys.argv[:] = ["dentscope", *sys.argv[4:]]
main()
"""


class Recipe:
    def __init__(self, title, folder):
        self.words = RECIPES[title].replace("NAME", "toy")
        self.over, self.work = folder / "over", folder / "work"
        self.work.mkdir(parents=True)

    def _named(self, file):
        assert f"`{file}`" in self.words, f"the recipe does not speak of {file}"
        (self.over / file).parent.mkdir(parents=True, exist_ok=True)
        return self.over / file

    def write(self, file, text):
        assert not (ROOT / file).exists()
        self._named(file).write_text(text, encoding="utf-8")

    def change(self, file, *changes):
        """Change a file that the recipe names: pairs of what stands there once, and what will."""
        target = self._named(file)
        text = (ROOT / file).read_text(encoding="utf-8")
        for old, new in changes:
            assert text.count(old) == 1, f"{file} holds {old!r} {text.count(old)} times"
            text = text.replace(old, new)
        target.write_text(text, encoding="utf-8")

    def _run(self, *words):
        return python("-c", OVERLAY, ROOT, self.over, *words, cwd=self.work, timeout=600)

    def dentscope(self, *words):
        answer = self._run("dentscope", *words)
        assert answer.returncode == 0, answer.stderr
        return answer.stdout

    def pytest(self, file, *words):
        answer = self._run(
            "pytest", str(ROOT / file), "-q", "-p", "no:cacheprovider", "--rootdir", str(ROOT),
            "-c", str(ROOT / "pyproject.toml"), "-p", "no:xdist", *words,
        )  # fmt: skip
        return answer.returncode, answer.stdout + answer.stderr


@pytest.fixture
def recipe(tmp_path):
    return lambda title: Recipe(title, tmp_path)
