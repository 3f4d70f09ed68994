"""Make a notebook of every example: its `# %%` cells, without output."""

from __future__ import annotations

import json
import re
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


def notebook(script: str) -> str:
    """Return the notebook of a script as JSON: its docstring, then a text and a code cell each."""
    head, *parts = re.split(r"^# %% ?", script, flags=re.MULTILINE)
    cells = [_cell("markdown", "# " + head.strip().strip('"'))]
    for part in parts:
        title, _, code = part.partition("\n")
        cells += [_cell("markdown", title), _cell("code", code.strip("\n"))]
    for number, cell in enumerate(cells):
        cell["id"] = f"cell-{number}"
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    content = {
        "cells": cells, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5,
    }  # fmt: skip
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def _cell(kind: str, text: str) -> dict[str, object]:
    code = {"execution_count": None, "outputs": []} if kind == "code" else {}
    return {"cell_type": kind, "metadata": {}, "source": text.splitlines(keepends=True), **code}


def main() -> None:
    """Write the notebooks beside the examples."""
    for script in sorted(EXAMPLES.glob("ex*.py")):
        target = script.with_suffix(".ipynb")
        target.write_text(notebook(script.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
