"""Registers: every tuned number of a stage named, with its unit, its source, and a use."""

import ast
import re
from dataclasses import fields, is_dataclass
from importlib import import_module
from itertools import takewhile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
STAGES = sorted(path.parent.name for path in ROOT.glob("*/rules.py"))
STANDING_APART = (
    "models/published",  # coefficients that a paper printed
    "campaigns/cases",  # what the published sets are made of
    "core/drag.py", "dynamics/tabulated/bits.py",  # printed curves, and polynomials of a library
    "dynamics/stepping/layout.py", "reduce/shared/units.py",  # places in arrays, and definitions
)  # fmt: skip
# constants of nature, of definitions, papers and standards, formats, exit codes, sizes of arrays
EXACT = {
    "campaigns/case.py": "_GROUP_DIGITS",
    "campaigns/contents.py": "SEALED_FROM _MOST_RATIO",
    "cli/doctor.py": "EXIT_ENVIRONMENT",
    "core/errors.py": "EXIT_INPUT_ERROR EXIT_NOT_CONVERGED",
    "core/inputs/flow_curve.py": "PROOF_STRAIN",
    "core/output.py": "_DIGEST",
    "core/rig.py": "TABOR TABOR_STRAIN",
    "dynamics/mechanisms/arithmetic.py": "_STEEL_DENSITY",
    "dynamics/mechanisms/squeeze_film.py": "_CRITICAL_STOKES",
    "dynamics/mechanisms/strength/flow_stress.py": "RATE",
    "dynamics/mechanisms/strength/strain_rate_hardening.py": "REFERENCE_RATE",
    "discrepancy/report/wording.py": "_UNIT",
    "discrepancy/metal/estimate.py": "_FROZEN",
    "discrepancy/unknowns/repeats.py": "_SURE_OF",
    "fem/assemble.py": "_ELASTIC DISTORTED",
    "fem/contact/forces.py": "_SUPPORT",
    "fem/contact/friction.py": "_SUPPORT",
    "fem/contact/point.py": "LOCAL",
    "fem/material/return_map.py": "RADIAL EXACT L",
    "fem/problem.py": "NUMERICS_VERSION",
    "fitting/calibrate.py": "SIGMAS",
    "fitting/form.py": "_START",
    "dynamics/force.py": "N_FORCE N_BRANCH N_FACTORS LOG_DEPTH_LAST DAMPING_DEPTH",
    "dynamics/scene.py": "STANDARD_GRAVITY",
    "dynamics/surface.py": "N_HEAD N_IMPRINT",
    "dynamics/tabulated/cells.py": "GUIDE _ORDER _START _BINS_PER_CELL",
    "dynamics/tabulated/energy_route.py": "_SERIES",
    "dynamics/tabulated/energy_table.py": "TERMS",
    "dynamics/tabulated/law_table.py": "_COLUMNS _BIN",
    "dynamics/export/collisions.py": "TSUJI_DAMPING",
    "dynamics/report/effect.py": "ATOM",
    "dynamics/report/flat.py": "_THICK",
    "dynamics/stepping/compiled.py": "_LANES",
    "dynamics/stepping/flight.py": "N_FAST _QUARTER",
    "dynamics/stepping/land.py": "NONE AGAIN",
    "models/choose.py": "_ELASTIC_DEPTH",
    "models/closed_form.py": "PI SHARPEST",
    "models/correction.py": "MOST",
    "models/hardening.py": "REPRESENTATIVE _COORDINATES",
    "models/table_kernels.py": "_COLUMNS",
    "recordings/checks/limits.py": "FULLY_PLASTIC FIRST_BENDING",
    "recordings/checks/press.py": "LOAD_CLASS",
    "recordings/checks/rigid.py": "_TURNING",
    "recordings/checks/motion.py": "_ELASTIC _PLASTIC",
    "recordings/fetch.py": "_PIECE",
    "recordings/questions.py": "_NITROGEN",
    "recordings/trials.py": "NORMAL",
    "reduce/bounces/fall.py": "_SMALL",
    "reduce/bounces/options.py": "GRAVITY",
    "reduce/images/edge_fit.py": "_POSE",
    "reduce/images/picture_file.py": "DOWN",
    "reduce/mocap/motion.py": "SHARED OWN",
    "reduce/press/curve.py": "_STIFFNESS_FROM _STIFFNESS_TO",
    "reduce/press/cycles.py": "_HELD",
    "reduce/shared/regression.py": "MAD_TO_STD",
    "reduce/scan/level.py": "LEVELS",
    "reduce/scan/picture.py": "UM",
    "reduce/table/cells.py": "OUT_OF_RANGE DAY",
    "reduce/table/leeb.py": "_LEEB_SPEED",
    "start/measured.py": "_STANDARD_GRAVITY",
}


def register(stage):
    return import_module(f"dentscope.{stage}.rules").RULES


def test_the_stages_that_choose_numbers_have_a_register() -> None:
    chosen = {"core", "fem", "fitting", "models", "campaigns", "dynamics", "recordings"}
    assert chosen | {"discrepancy", "reduce", "start"} == set(STAGES)


@pytest.mark.parametrize("stage", STAGES)
def test_each_number_says_what_it_is_and_where_it_is_from(stage) -> None:
    rules = register(stage)
    assert is_dataclass(rules)
    assert type(rules).__dataclass_params__.frozen
    for item in fields(rules):
        told = item.metadata
        assert re.search(r"\[[^\]]+\]", told["meaning"]), f"{item.name}: no unit"
        assert len(told["source"]) > 3, f"{item.name}: no source"
        for named in re.findall(r"(?:tools|docs)/[\w./-]+\w", told["source"]):
            assert (ROOT / named).is_file(), f"{item.name}: {named}"


@pytest.mark.parametrize("stage", STAGES)
def test_each_number_has_a_use(stage) -> None:
    used = set()
    for path in (
        p for folder in (*STAGES, "cli", "studies") for p in (ROOT / folder).rglob("*.py")
    ):
        own = path.relative_to(ROOT).parts[0] in (stage, "cli", "studies")
        word = rf"\b(?:RULES|{stage.upper()})" if own else rf"\b{stage.upper()}"
        if path.name != "rules.py":
            used |= set(re.findall(rf"{word}\.(\w+)", path.read_text(encoding="utf-8")))
    assert not {item.name for item in fields(register(stage))} - used


def test_a_register_is_made_in_one_place() -> None:
    for path in ROOT.glob("*/*.py"):
        assert "def _rule(" not in path.read_text(encoding="utf-8"), path


def numeric(node: ast.expr) -> bool:
    if isinstance(node, ast.Constant):
        return isinstance(node.value, int | float) and not isinstance(node.value, bool)
    if isinstance(node, ast.UnaryOp):
        return numeric(node.operand)
    if isinstance(node, ast.BinOp):
        return numeric(node.left) and numeric(node.right)
    parts = {ast.Tuple: "elts", ast.List: "elts", ast.Dict: "values"}.get(type(node))
    return bool(parts) and all(map(numeric, getattr(node, parts))) and bool(getattr(node, parts))


def is_limit(node: ast.stmt, lines: list[str]) -> bool:
    """Whether the comment above says that a number is a limit, and in which unit."""
    above = list(takewhile(lambda line: line.startswith("#"), reversed(lines[: node.lineno - 1])))
    said = " ".join(line.removeprefix("#") for line in reversed(above)).strip()
    return bool(re.match(r"limit: .*\[[^\]]+\]", said))


def constants(path: Path) -> list[str]:
    found = []
    text = path.read_text(encoding="utf-8")
    for node in ast.parse(text).body:
        if is_limit(node, text.splitlines()):
            continue
        if isinstance(node, ast.AnnAssign) and node.value is not None:
            pairs = [(node.target, node.value)]
        elif isinstance(node, ast.Assign):
            target, value = node.targets[0], node.value
            several = isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple)
            pairs = [*zip(target.elts, value.elts, strict=True)] if several else [(target, value)]
        else:
            continue
        found += [name.id for name, value in pairs if isinstance(name, ast.Name) and numeric(value)]
    return found


@pytest.mark.parametrize("stage", [*STAGES, "cli"])
def test_no_number_is_chosen_outside_a_register(stage) -> None:
    found = {}
    for path in sorted((ROOT / stage).rglob("*.py")):
        place = path.relative_to(ROOT).as_posix()
        if path.name != "rules.py" and not place.startswith(STANDING_APART):
            found[place] = " ".join(constants(path))
    exact = {place: names for place, names in EXACT.items() if place.startswith(f"{stage}/")}
    assert {place: names for place, names in found.items() if names} == exact
