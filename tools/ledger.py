"""Print how large each part of the project is, beside its last release, and refuse silent growth.

    python tools/ledger.py            # exit code 1 where a part grew and CHANGELOG does not say why
    python tools/ledger.py --release  # keep today's sizes as those of the release

A part that is more than 2 % larger in lines, modules, tuned numbers or words needs a line under
"For developers" of CHANGELOG's newest version: "- PART grew: what for". Density stands beside the
size, so that fewer lines are not longer or more tangled ones.
"""

from __future__ import annotations

import ast
import io
import json
import re
import subprocess
import sys
import tokenize
import tomllib
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
KEPT = ROOT / "tools" / "ledger.json"
SIZES = ("lines", "code", "modules", "numbers", "words")
BOUND = SIZES[1:]
DENSITY = ("complexity", "most", "longest", "line")
GROWTH = 1.02
WORKSHOP = ("examples", "studies", "tests", "tools")
SILENT = {
    tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT,
    tokenize.ENCODING, tokenize.ENDMARKER,
}  # fmt: skip
Row = dict[str, float]


def parts() -> tuple[str, ...]:
    """Folders at the top that hold source: the package's stages, and what stands beside them."""
    told = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    names = (name.split(".")[1:2] for name in told["tool"]["setuptools"]["packages"])
    return tuple(sorted({*WORKSHOP, *(name[0] for name in names if name)}))


def code_lines(text: str, tree: ast.Module) -> set[int]:
    """Lines that hold code: no blank, comment or docstring."""
    found: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in SILENT:
            found.update(range(token.start[0], token.end[0] + 1))
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    for node in (n for n in ast.walk(tree) if isinstance(n, kinds)):
        first = node.body[0] if node.body else None
        if isinstance(first, ast.Expr) and isinstance(getattr(first.value, "value", None), str):
            found.difference_update(range(first.lineno, (first.end_lineno or first.lineno) + 1))
    return found


def add_module(row: Row, path: Path) -> None:
    """Add a module to its part."""
    text = path.read_text(encoding="utf-8")
    tree = ast.parse(text)
    row["lines"] += len(text.splitlines())
    row["code"] += len(code_lines(text, tree))
    row["modules"] += path.name != "__init__.py"
    row["line"] = max(row["line"], *(len(line) for line in [*text.splitlines(), ""]))
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            row["longest"] = max(row["longest"], (node.end_lineno or 0) - node.lineno + 1)
        called = node.func if isinstance(node, ast.Call) else None
        chosen = isinstance(called, ast.Name) and called.id == "rule"
        row["numbers"] += path.name == "rules.py" and chosen


def complexities(parts: Iterable[str]) -> dict[str, list[int]]:
    """McCabe's number of every function, by part."""
    ruff = Path(sys.executable).with_name("ruff")
    told = subprocess.run(
        [ruff, "check", "--isolated", "--select", "C901", "--config",
         "lint.mccabe.max-complexity=0", "--output-format", "json", "--exit-zero", *parts],
        cwd=ROOT, check=True, capture_output=True, text=True,
    ).stdout  # fmt: skip
    found: dict[str, list[int]] = {}
    for one in json.loads(told):
        number = re.search(r"\((\d+) > 0\)", one["message"])
        part = Path(one["filename"]).relative_to(ROOT).parts[0]
        found.setdefault(part, []).append(int(number[1]) if number else 0)
    return found


def measured() -> dict[str, Row]:
    """Return size and density of every part."""
    rows: dict[str, Row] = {}
    for part in parts():
        row = rows[part] = dict.fromkeys((*SIZES, *DENSITY), 0.0)
        for path in sorted((ROOT / part).rglob("*.py")):
            add_module(row, path)
    for part, numbers in complexities(rows).items():
        rows[part]["complexity"] = round(sum(numbers) / len(numbers), 2)
        rows[part]["most"] = max(numbers)
    pages = (ROOT / "docs").rglob("*.md")
    words = sum(len(path.read_text(encoding="utf-8").split()) for path in pages)
    rows["docs"] = dict.fromkeys((*SIZES, *DENSITY), 0.0) | {"words": words}
    return rows


def grown(now: dict[str, Row], before: dict[str, Row]) -> dict[str, list[str]]:
    """Sizes of each part that went up by more than 2 %."""
    found: dict[str, list[str]] = {}
    for part, row in now.items():
        old = before.get(part, {})
        up = [s for s in BOUND if row[s] > GROWTH * old.get(s, 0) and row[s] > old.get(s, 0)]
        if up:
            found[part] = up
    return found


def accounted(changelog: str) -> set[str]:
    """Parts whose growth CHANGELOG's newest version says what for."""
    versions = re.split(r"^## ", changelog, flags=re.MULTILINE)
    newest = versions[1] if len(versions) > 1 else ""
    told = re.split(r"^For developers:?$", newest, flags=re.MULTILINE)[1:]
    return set(re.findall(r"^- `?([\w-]+)`? grew: \S", "".join(told), flags=re.MULTILINE))


def table(now: dict[str, Row], before: dict[str, Row]) -> str:
    """Return the ledger as text: every size with its change since the release, and the density."""
    lines = [f"{'':20}" + "".join(f"{s:>17}" for s in SIZES) + "".join(f"{d:>11}" for d in DENSITY)]
    tool = [p for p in now if p not in (*WORKSHOP, "docs")]
    sums = {"tool": tool, "tool without reduce": [p for p in tool if p != "reduce"]}
    for name in (*now, *sums):
        members = sums.get(name, [name])
        text = f"{name:20}"
        for size in SIZES:
            new, old = (
                sum(kept.get(p, {}).get(size, 0) for p in members) for kept in (now, before)
            )
            text += f"{f'{new:.0f} ({new - old:+.0f})':>17}"
        lines.append(text + "".join(f"{now[name][d]:>11g}" for d in DENSITY if name in now))
    return "\n".join(lines)


def main(arguments: list[str]) -> int:
    """Print the ledger; with `--release`, keep it."""
    now = measured()
    if "--release" in arguments:
        from dentscope import __version__

        rows = (
            f"{json.dumps(p)}: {json.dumps([int(r[s]) for s in SIZES])}" for p, r in now.items()
        )
        parts = ",\n".join(rows)
        text = f'{{"version": {json.dumps(__version__)}, "parts": {{\n{parts}\n}}}}\n'
        KEPT.write_text(text, encoding="utf-8")
    last = json.loads(KEPT.read_text(encoding="utf-8"))
    before = {part: dict(zip(SIZES, row, strict=True)) for part, row in last["parts"].items()}
    print(f"ledger: sizes, and in brackets what changed since {last['version']}")
    print(table(now, before))
    excused = accounted((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))
    found = {p: up for p, up in grown(now, before).items() if p not in excused}
    for part, up in found.items():
        print(
            f"ledger: {part} grew by more than 2 % in {', '.join(up)}: take out what it replaces, "
            f"or say under 'For developers:' of CHANGELOG.md '- {part} grew: what for'",
            file=sys.stderr,
        )
    return 1 if found else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
