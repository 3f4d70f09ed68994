"""Gather the pages of the documentation site into build/docs-source, and its reference from code.

Tables of keys and laws, the examples and the pages of the Python reference are made here; all
other pages are those of docs/, README.md, CHANGELOG.md and CONTRIBUTING.md.
"""

from __future__ import annotations

import ast
import json
import math
import re
import shutil
from pathlib import Path

from dentscope.cli.shared.keys import FILES, keys_of
from dentscope.core.inputs.materials import materials
from dentscope.core.tables import markdown
from dentscope.models import LAWS, UNAVAILABLE
from dentscope.models.export.sources import NAME, javascript_source
from dentscope.start import material

HERE = Path(__file__).resolve().parent
ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "build" / "docs-source"
STAGES = (
    "core", "fem", "models", "campaigns", "fitting", "dynamics", "recordings", "reduce",
    "discrepancy", "start",
)  # fmt: skip
_LINKS = (
    (r"\]\(docs/", "]("),
    (r"\]\((?:\.\./)*README\.md\)", "](index.md)"),
    (r"\]\((?:\.\./)*CONTRIBUTING\.md\)", "](contributing.md)"),
    (r"\]\((?:\.\./)*CHANGELOG\.md\)", "](changes.md)"),
    (r"\]\(LICENSE\)", "](LICENSE.txt)"),
    (r"\]\((?:\.\./)*examples/?\)", "](examples.md)"),
    (r"\]\((?:\.\./)*examples/(\w+\.(?:toml|csv))\)", r"](inputs/\1)"),
)
_TOP = {
    "README.md": "index.md", "CHANGELOG.md": "changes.md", "CONTRIBUTING.md": "contributing.md",
}  # fmt: skip
_HEAD = "| key | meaning | allowed | without it |\n| --- | --- | --- | --- |"


def main() -> None:
    """Write everything that the site's builder reads."""
    shutil.rmtree(SOURCE, ignore_errors=True)
    shutil.copytree(ROOT / "docs", SOURCE)
    for path in SOURCE.glob("*.md"):
        path.write_text(_relinked(path.read_text(encoding="utf-8")), encoding="utf-8")
    (SOURCE / "inputs").mkdir()
    for kind in ("toml", "csv"):
        for path in (ROOT / "examples").glob(f"*.{kind}"):
            shutil.copyfile(path, SOURCE / "inputs" / path.name)
    for name, page in _TOP.items():
        _write(page, _relinked((ROOT / name).read_text(encoding="utf-8")))
    shutil.copyfile(ROOT / "LICENSE", SOURCE / "LICENSE.txt")
    _write("keys.md", keys_page())
    _write("laws.md", laws_page())
    _write("examples.md", examples_page())
    _write("try-it.md", try_page())
    _write(f"{NAME}.js", javascript_source(LAWS["fitted"]))
    for stage in STAGES:
        _write(f"python/{stage}.md", reference_page(stage))
    _write("python/index.md", names_page())
    for name in ("site.css", "scroll.js", "iframe-worker.js", "try-it.js"):
        shutil.copyfile(HERE / name, SOURCE / name)
    nav = "[python/index.md, " + ", ".join(f"python/{stage}.md" for stage in STAGES) + "]"
    settings = (HERE / "mkdocs.yml").read_text(encoding="utf-8")
    made = settings.replace("REFERENCE", nav).replace("../", f"{ROOT}/")
    made = made.replace("hooks.py", str(HERE / "hooks.py"))
    (SOURCE.parent / "mkdocs.yml").write_text(made, encoding="utf-8")


def _write(name: str, text: str) -> None:
    path = SOURCE / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def _relinked(text: str) -> str:
    for old, new in _LINKS:
        text = re.sub(old, new, text)
    return text


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")


def keys_page() -> str:
    """Return every key of every input file, read off the schemas."""
    out = [
        "# Keys of the input files",
        "A quantity is a number, or `{ value = ..., std = ... }`; all are in SI units. "
        "`dentscope keys` says the same in a terminal.",
    ]
    for kind, about in FILES.items():
        out.append(f"## {about[0].upper()}{about[1:]}")
        table = None
        for key in keys_of(kind):
            if key.table != table:
                table = key.table
                title = f"**`{table}`**\n\n" if table else ""
                out.append(f"{title}{_HEAD}")
            cells = (f"`{key.name}`", key.meaning, key.allowed, key.default or "an error: needed")
            out[-1] += "\n| " + " | ".join(map(_cell, cells)) + " |"
    return "\n\n".join(out) + "\n"


def laws_page() -> str:
    """Return every law with its source and what was read."""
    rows = [
        (f"`{law.name}`", law.title, law.regime, law.standing.told, law.read, law.source)
        for law in LAWS.values()
    ]
    head = ("law", "authors", "made for", "equations", "what was read", "source")
    table = markdown([head, *(list(map(_cell, row)) for row in rows)])
    left = "\n".join(f"- **{name}**: {reason}" for name, reason in UNAVAILABLE.items())
    return f"# Contact laws\n\n{table}\n## Not offered, and why\n\n{left}\n"


def examples_page() -> str:
    """Return the examples, each as text and code."""
    out = ["# Examples", "`dentscope examples --to FOLDER` copies them, scripts and notebooks."]
    for path in sorted((ROOT / "examples").glob("ex*.py")):
        head, *parts = re.split(r"^# %% ?", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
        out.append(f"## {path.stem}\n\n{head.strip().strip(chr(34))}")
        for part in parts:
            title, _, code = part.partition("\n")
            out.append(f"{title}\n\n```python\n{code.strip()}\n```")
    return "\n\n".join(out) + "\n"


def try_page() -> str:
    """Return the page that computes an impact by itself: its form, the metals, the law's limits."""
    metals = {}
    for name, entry in sorted(materials().items(), key=lambda named: named[1].title.lower()):
        body = material(name)
        strength = body.Sy if math.isfinite(body.Sy) else None
        metals[name] = {"title": entry.title, "E": body.E, "nu": body.nu, "Sy": strength,
                        "density": body.density}  # fmt: skip
    data = json.dumps({"metals": metals, "limits": LAWS["fitted"].limits})
    return (HERE / "try-it.md").read_text(encoding="utf-8").replace("DATA", data)


def public_names(tree: ast.Module) -> list[str]:
    """Return what a module offers by `__all__`; a stage that is used by its command has none."""
    for node in tree.body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return list(ast.literal_eval(node.value))
    return []


def names_page() -> str:
    """Return the page of `import dentscope as ds`: what it says, and every name of it."""
    tree = ast.parse((ROOT / "__init__.py").read_text(encoding="utf-8"))
    told = (ast.get_docstring(tree) or "").split("\n\n")
    calls, stages = told[2], told[4]
    names = [name for name in public_names(tree) if name != "LAWS"]
    parts = "\n\n".join(f"::: dentscope.{name}" for name in names)
    return (
        "# The names of `import dentscope as ds`\n\n"
        f"```\n{calls}\n```\n\n{told[3]}\n\n```\n{stages}\n```\n\n"
        f"## ds.LAWS\n\nEvery contact law by its name: [laws](../laws.md).\n\n{parts}\n"
    )


def reference_page(stage: str) -> str:
    """Return the page of a stage: what it says of itself, and every public name of it."""
    tree = ast.parse((ROOT / stage / "__init__.py").read_text(encoding="utf-8"))
    names = public_names(tree)
    about = ast.get_docstring(tree) or ""
    parts = (f"::: dentscope.{stage}.{name}" for name in names)
    return f"# {stage}\n\n{about}\n\n" + "\n\n".join(parts) + "\n"


if __name__ == "__main__":
    main()
