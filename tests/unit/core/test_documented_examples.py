"""What the documentation shows is run; its site and the page that computes are whole."""

import doctest
import importlib
import json
import math
import re
import runpy
import shutil
import subprocess
from pathlib import Path

import pytest
from dentscope.core import Material, Pair
from dentscope.dynamics import Approach, Striker, scene_of, strike
from dentscope.models import LAWS
from dentscope.models.export.sources import NAME, javascript_source

ROOT = Path(__file__).resolve().parents[3]
STAGES = sorted(p.parent.name for p in ROOT.glob("*/__init__.py"))
EXAMPLES = [
    "dentscope." + ".".join(path.relative_to(ROOT).with_suffix("").parts)
    for stage in STAGES
    for path in sorted((ROOT / stage).rglob("*.py"))
    if ">>>" in path.read_text(encoding="utf-8")
]


@pytest.mark.parametrize("name", EXAMPLES)
def test_docstring_examples_show_what_happens(name):
    outcome = doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS)
    assert outcome.attempted > 0
    assert outcome.failed == 0


def test_readme_block_gives_a_force_below_hertz():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)
    names = {}
    exec(compile(block, "README.md", "exec"), names)
    pair, depth = names["pair"], 20e-6
    assert isinstance(pair, Pair)
    # Johnson, Contact Mechanics (1985), Eq. 4.23: the elastic force, which yielding lowers
    hertz = 4.0 / 3.0 * pair.E_reduced * math.sqrt(pair.R * depth**3)
    assert 0.2 * hertz < float(names["force"]) < hertz


def test_every_target_that_the_readme_names_exists():
    named = set(re.findall(r"`make ([a-z]+)`", (ROOT / "README.md").read_text(encoding="utf-8")))
    listed = re.findall(r"^([a-z]+):.*## ", (ROOT / "Makefile").read_text(), flags=re.MULTILINE)
    assert {"install", "campaign", "docs", "test"} <= named <= set(listed)


def test_the_lock_of_every_supported_python_pins_each_dependency_with_hashes():
    declared = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    direct = re.search(r"^dependencies = \[(.*?)\]", declared, flags=re.MULTILINE | re.DOTALL)
    names = re.findall(r'"([A-Za-z0-9-]+)', direct.group(1))
    locks = sorted((ROOT / "tools" / "requirements").glob("py3*.txt"))
    assert [lock.stem for lock in locks] == ["py311", "py312", "py313", "py314"]
    for lock in locks:
        blocks = re.split(r"\n(?=\S)", lock.read_text(encoding="utf-8"))
        pinned = {block.split("==")[0].lower() for block in blocks if "--hash=sha256:" in block}
        assert len(pinned) == len(blocks)
        assert {name.lower() for name in names} <= pinned
        assert "http" not in "".join(re.findall(r"^--.*$", "\n".join(blocks), flags=re.MULTILINE))


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


SITE = ROOT / "tools" / "site"
LAW = LAWS["fitted"]
node = pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")


def asked(folder, code):
    (folder / f"{NAME}.js").write_text(javascript_source(LAW))
    shutil.copyfile(SITE / "try-it.js", folder / "try-it.js")
    script = (
        f"const law = require('./{NAME}.js'), {{ upright, outside }} = require('./try-it.js');"
        f"console.log(JSON.stringify({code}));"
    )
    done = subprocess.run(
        ["node", "-e", script], cwd=folder, capture_output=True, text=True, check=True, timeout=60
    )
    return json.loads(done.stdout)


def written(body):
    numbers = {name: getattr(body, name) for name in ("E", "nu", "Sy", "density")}
    return json.dumps(numbers)  # Infinity and NaN as JavaScript has them


@node
@pytest.mark.parametrize("speed", [0.02, 1.0, 20.0])
@pytest.mark.parametrize(
    ("ball", "plate"),
    [
        (Material(200e9, 0.3, 1.7e9, density=7800.0), Material(200e9, 0.3, 3.05e8, density=7870.0)),
        (Material(70e9, 0.33, 2e8, density=2700.0), Material(200e9, 0.3, 1.2e9, density=7870.0)),
        (Material(300e9, 0.24, density=3900.0), Material(193e9, 0.29, 5e8, density=8000.0)),
    ],
    ids=["dent in the plate", "dent in the ball", "elastic ball"],
)
def test_its_numbers_are_those_of_impact(tmp_path, ball, plate, speed):
    R = 5e-3
    found = asked(tmp_path, f"upright(law, {written(ball)}, {written(plate)}, {R}, {speed})")
    mass = 4.0 / 3.0 * math.pi * R**3 * ball.density
    ours = strike(
        scene_of(
            LAW, sphere=ball, flat=plate, gravity=0.0, striker=Striker(mass=mass, tip_radius=R),
            approach=Approach(speed),
        )
    )  # fmt: skip
    assert found["restitution"] == pytest.approx(ours.restitution, rel=1e-5)
    assert found["deepest"] == pytest.approx(ours.peak_depth_m, rel=1e-5)
    assert found["force"] == pytest.approx(ours.peak_force_N, rel=1e-5)
    assert found["residual"] == pytest.approx(ours.residual_m, rel=1e-5, abs=1e-12)
    assert found["time"] == pytest.approx(ours.contact_time_s, rel=1e-3)


@node
def test_two_elastic_bodies_meet_as_hertz_says(tmp_path):
    # Johnson, Contact Mechanics, 11.4: 2.94 times the approach over the speed
    body = Material(200e9, 0.3, density=7800.0)
    found = asked(tmp_path, f"upright(law, {written(body)}, {written(body)}, 0.005, 0.1)")
    assert found["restitution"] == pytest.approx(1.0, abs=1e-6)
    assert found["time"] == pytest.approx(2.9432 * found["deepest"] / 0.1, rel=1e-3)


@node
def test_a_line_says_where_no_pair_was_fitted(tmp_path):
    limits = json.dumps(LAW.limits)
    soft, hard = Material(200e9, 0.3, 3e8), Material(200e9, 0.3, 9e9)
    pair = f"{written(hard)}, {written(soft)}"
    said = asked(tmp_path, f"outside({limits}, {pair}, 0.01, 0.003)")
    assert len(said) == 2
    assert said[0].startswith("strength of the ball over that of the plate is 30;")
    assert said[1] == "depth over radius is 0.3; the law was fitted from 0 to 0.179"
    assert asked(tmp_path, f"outside({limits}, {written(soft)}, {written(soft)}, 0.01, 1e-4)") == []
    with pytest.warns(UserWarning, match="Sy_ratio"):  # as the law itself says
        LAW.loading(Pair(hard, soft, 0.01), 1e-4)


def test_the_page_has_every_metal_and_both_scripts():
    page = GATHER["try_page"]()
    data = json.loads(page.split('type="application/json">')[1].split("</script>")[0])
    assert data["metals"]["steel-52100-hardened"]["E"] == pytest.approx(2.06e11, rel=0.05)
    for select in ("steel-52100-hardened", "steel-1018-hot-rolled"):
        assert f'data-first="{select}"' in page
        assert select in data["metals"]
    assert set(data["limits"]) >= {"Sy_ratio", "nu", "Delta_over_R"}
    for script in (f"{NAME}.js", "try-it.js"):
        assert f'<script src="{script}">' in page
