"""The documentation site: every page is in its menu, every public name in its reference."""

import importlib
import re
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
GATHER = runpy.run_path(str(ROOT / "tools" / "site" / "gather.py"))
MADE = {"index.md", "changes.md", "contributing.md", "keys.md", "laws.md", "examples.md",
        "try-it.md"}  # fmt: skip


def test_every_page_is_in_the_menu():
    menu = (ROOT / "tools" / "site" / "mkdocs.yml").read_text().split("nav:")[1]
    named = set(re.findall(r"[\w/-]+\.md", menu))
    docs = ROOT / "docs"
    pages = {str(p.relative_to(docs)) for p in docs.rglob("*.md")}
    assert named == pages | MADE


@pytest.mark.parametrize("stage", GATHER["STAGES"])
def test_every_public_name_has_its_place_in_the_reference(stage):
    page = GATHER["reference_page"](stage)
    module = importlib.import_module(f"dentscope.{stage}")
    for name in getattr(module, "__all__", ()):
        assert f"::: dentscope.{stage}.{name}\n" in page
        assert hasattr(module, name)


def test_the_tables_are_made_from_the_code():
    keys, laws = GATHER["keys_page"](), GATHER["laws_page"]()
    assert "| `tip_radius_m` |" in keys
    assert "a quantity from 1000 to 2e+12 [Pa]" in keys
    assert "`kogut-etsion`" in laws
    assert all(len(row.split(" | ")) == 6 for row in laws.splitlines() if row.startswith("| `"))


def test_links_of_the_top_pages_lead_into_the_site():
    text = GATHER["_relinked"]((ROOT / "README.md").read_text(encoding="utf-8"))
    targets = re.findall(r"\]\(([^)#]+)", text)
    assert len(targets) > 15
    for target in targets:
        there = target in MADE | {"LICENSE.txt"} or (ROOT / "docs" / target).exists()
        assert there, target
