"""The recipes of CONTRIBUTING.md, each carried out with a toy as it is written there."""

import re
import shutil
from pathlib import Path

import pytest
from dentscope import fem
from dentscope.campaigns.publish import published_designs
from made_files import rows_of

ROOT = Path(__file__).resolve().parents[3]
PAGE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


def neighbour(file, *changes):
    text = (ROOT / file).read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return text


def test_the_page_names_what_exists():
    named = {n for n in re.findall(r"`([\w./-]+)`", PAGE) if "/" in n and "NAME" not in n}
    assert len(named) > 15
    assert {n for n in named if not (ROOT / n).exists()} == set()


def test_a_law(recipe):
    toy = recipe("Add a contact law")
    # Tabor's ratio of hardness to strength, 3.0, in the place of 2.8
    changes = (("JOHNSON", "TOY"), ('"johnson"', '"toy"'), ("HARDNESS = 2.8", "HARDNESS = 3.0"))
    toy.write(
        "models/published/toy.py",
        neighbour("models/published/johnson.py", *changes, ("Johnson 1985, simple", "Toy")),
    )
    toy.change(
        "models/published/__init__.py",
        ("from .thornton import", "from .toy import TOY\nfrom .thornton import"),
        ("    CEB,\n", "    TOY,\n    CEB,\n"),
    )
    assert "Toy plastic" in toy.dentscope("laws", "show", "toy")
    toy.dentscope(
        "laws", "compare", str(ROOT / "examples/case_steel.toml"), "--law", "toy", "--law",
        "johnson", "--out", "laws",
    )  # fmt: skip
    rows = rows_of(toy.work / "laws/curves.csv")
    deepest = {row["law"]: float(row["force_N"]) for row in rows}
    assert deepest["toy"] / deepest["johnson"] == pytest.approx(3.0 / 2.8, rel=1e-9)
    code, told = toy.pytest("tests/contract/test_law_contract.py", "-k", "toy and not anchor")
    assert code == 0, told
    assert int(re.search(r"(\d+) passed", told)[1]) > 10


def test_a_mechanism(recipe):
    toy = recipe("Add a mechanism")
    toy.write(
        "dynamics/mechanisms/toy.py",
        neighbour(
            "dynamics/mechanisms/tangential_compliance.py",
            ("TangentialCompliance", "Toy"),
            ('name = "tangential-compliance"', 'name = "toy"'),
        ),
    )
    toy.change(
        "dynamics/mechanisms/__init__.py",
        ("from .truncated_tip", "from .toy import Toy\nfrom .truncated_tip"),
        ("    Tilt(),\n", "    Tilt(),\n    Toy(),\n"),
    )
    code, told = toy.pytest("tests/contract/test_mechanism_contract.py", "-k", "toy")
    assert code == 0, told
    assert int(re.search(r"(\d+) passed", told)[1]) >= 6
    # the recipe's last step is missing: the page's order is kept by a test
    code, told = toy.pytest("tests/contract/test_mechanism_contract.py", "-k", "documented")
    assert code == 1
    assert "toy" in told


def test_an_observable(recipe):
    toy = recipe("Add an observable")
    row = (
        'Observable(column="contact_work_J", label="work kept", meaning="kept by the contact", '
        'instrument="force", phase="unloading", log=True, power=2.0, simulated="contact_work_J"),'
    )
    toy.change("core/observables.py", ("_ROWS = (\n", f"_ROWS = (\n    {row}\n"))
    folder = shutil.copytree(ROOT / "data/recordings/leeb-steel-300hv", toy.work / "set")
    lines = (folder / "trials.csv").read_text().splitlines()
    work = ["contact_work_J", "0.0075", "0.0018", "0.06"]
    text = "\n".join(f"{line},{w}" for line, w in zip(lines, work, strict=True))
    (folder / "trials.csv").write_text(text + "\n")
    with (folder / "set.toml").open("a") as stream:
        stream.write("contact_work_J = 0.0005\n")
    assert "7 numbers (work kept, " in toy.dentscope("diagnose", "set", "--quiet")
    code, told = toy.pytest("tests/contract/test_observables.py")
    assert code == 0, told


OPTIONS = '''
"""Options of the toy."""

from pydantic import Field

from ...core.inputs.toml_input import InputTable


class Options(InputTable):
    """Options of the toy."""

    height_m_std: float = Field(0.0, ge=0.0, description="standard deviation of a height")
'''
KIND = '''
"""Two heights on a line: fall and rebound."""

from pathlib import Path

import numpy as np

from ..measured import Measured, Trial
from ..reduced import Reduced
from .options import Options
from .picture import draw


def reduce(path: Path, options: Options) -> Reduced:
    """Return the restitution, the root of the ratio of the heights."""
    fall, up = np.loadtxt(path)
    e = Measured(float(np.sqrt(up / fall)), options.height_m_std)
    trial = Trial(observables={"restitution": e}, label="")
    return Reduced(path, {"restitution": e}, (trial,), draw)
'''
PICTURE = '''
"""The picture of the toy."""

from ...core.output import figure
from ..pictures import save


def draw(path):
    """Draw nothing."""
    save(figure(1, 1, size=(1.0, 1.0))[0], path)
'''


def test_an_input_format(recipe):
    toy = recipe("Add an input format")
    toy.write("reduce/toy/options.py", OPTIONS)
    toy.write("reduce/toy/kind.py", KIND)
    toy.write("reduce/toy/picture.py", PICTURE)
    toy.write("reduce/toy/__init__.py", '"""Toy."""\n')
    toy.change("reduce/kinds.py", ("KINDS = {\n", 'KINDS = {\n    "toy": "two heights",\n'))
    (toy.work / "drop.txt").write_text("1.0 0.64\n")
    assert "--height-m-std" in toy.dentscope("reduce", "toy", "--help")
    told = toy.dentscope("reduce", "toy", "drop.txt", "--height-m-std", "0.01", "--out", "out")
    assert "restitution = 0.800 ± 0.010" in told
    shutil.copytree(ROOT / "data/recordings/leeb-steel-300hv", toy.work / "set")
    toy.dentscope(
        "reduce", "toy", "drop.txt", "--into", "set", "--striker", "D", "--impact-speed-m-s", "2"
    )
    rows = rows_of(toy.work / "set/trials.csv")
    assert [float(r["restitution"]) for r in rows if r["trial"].startswith("drop")] == [0.8]


DESIGN = '''
def toy() -> tuple[Case, ...]:
    """Brass on steel and steel on brass."""
    pairs = {"one": (100.0, 200.0), "other": (200.0, 100.0)}
    return tuple(
        standard_case(
            name, pair_of(E_s=s, E_f=f, Sy_min=300.0, ratio=1.5), deepest=0.01, n_depths=8,
            accuracy=fem.Accuracy.smoke(),
        )
        for name, (s, f) in pairs.items()
    )
'''


def test_a_design(recipe):
    toy = recipe("Add a design")
    toy.change(
        "campaigns/cases/drawn.py",
        ("\n\n@cache\ndef robustness(", f"\n\n{DESIGN}\n\n@cache\ndef robustness("),
    )
    toy.change(
        "campaigns/designs.py",
        ("from .cases.drawn import (\n", "from .cases.drawn import (\n    toy,\n"),
        (
            "    for design in (\n",
            '    for design in (\n        Design("toy", "brass and steel", toy),\n',
        ),
    )
    assert "brass and steel" in toy.dentscope("campaign", "designs")
    told = toy.dentscope("campaign", "status", "--design", "toy")
    assert "designed 2  done 0  failed 0  missing 2" in told


def test_a_change_of_the_mesh(recipe):
    toy = recipe("Change the mesh")
    now = f"NUMERICS_VERSION = {fem.NUMERICS_VERSION}\n"
    (published,) = {
        part.numerics_version
        for part in published_designs(ROOT / "data/campaign")
        if part.design == "smoke"
    }
    stale = {}
    for version in (published, published + 1):
        toy.change("fem/problem.py", (now, f"NUMERICS_VERSION = {version}\n"))
        told = toy.dentscope("campaign", "status", "--design", "smoke")
        (line,) = (line for line in told.splitlines() if line.split()[:1] == ["smoke"])
        stale[version] = "stale" in line
    assert stale == {published: False, published + 1: True}
    toy.change("fem/problem.py", (now, f"NUMERICS_VERSION = {fem.NUMERICS_VERSION + 1}\n"))
    code, told = toy.pytest("tests/golden/test_golden_curves.py", "-k", "moved", "-x")
    assert code == 1
    assert "NUMERICS_VERSION" in told
