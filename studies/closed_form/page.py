"""The sections of docs/closed-form.md that a fit writes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ...core.errors import InputError
from ...core.tables import markdown
from ...fitting.prediction import Errors
from ...fitting.report import (
    MARKS,
    Within,
    about_hardening,
    coefficient_rows,
    domain_rows,
    error_rows,
    uncertainty_rows,
)

BEGIN = "<!-- coefficients: begin, written by dentscope fit --publish -->"
END = "<!-- coefficients: end -->"
JUDGED_BEGIN = "<!-- judged: begin, written by dentscope fit --judge data/challenge --publish -->"
JUDGED_END = "<!-- judged: end -->"


def published_section(content: dict[str, Any]) -> str:
    """Return the part of docs/closed-form.md that follows from a coefficients file."""
    errors = content["errors"]
    kinds = {
        "compact, left out": errors["compact"]["left_out"],
        "fitted, left out": errors["fitted"]["left_out"],
    }
    rows = [["beyond first yield", *(f"{kind}: mean, largest" for kind in kinds)]]
    for name, (title, scale, aim) in MARKS.items():
        if not aim:
            continue
        cells = [", ".join(f"{scale * x:.3g}" for x in kind[name]) for kind in kinds.values()]
        rows.append([title, *cells])
    levels = sorted({x for c in content["provenance"]["campaigns"] for x in c["accuracy"]})
    return "\n".join(
        [
            BEGIN,
            f"{content['domain']['combinations']} combinations; accuracy of the finite elements: "
            f"{', '.join(levels)}.\n",
            _coefficients(content),
            markdown(rows),
            *about_hardening(content)[:1],
            markdown(domain_rows(content, "domain")) + END,
        ]
    )


def _coefficients(content: dict[str, Any]) -> str:
    """Coefficients, five a line."""
    cells = [f"{name:<4}{value:>9}   " for name, value, _ in coefficient_rows(content)[1:]]
    lines = ["".join(cells[k : k + 5]).rstrip() for k in range(0, len(cells), 5)]
    return "\n".join(["```", *lines, "```\n"])


def judged_section(
    errors: Sequence[tuple[str, Errors]],
    names: Sequence[str],
    digest: str,
    *,
    within: Mapping[str, Within],
) -> str:
    """Return the part of docs/closed-form.md on pairs that no fit has read.

    - `errors`: names of the laws in use, and their errors on these pairs.
    - `names`: of the cases; those of a challenge carry the beginning of the checksum that drew
      them.
    - `digest`: checksum of the coefficients in use.
    - `within`: shares of the errors within one and two stated deviations, by law and quantity.
    """
    drawn = sorted({name.split("-")[1] for name in names if name.startswith("challenge-")})
    about = f"{len(names)} pairs, drawn from {', '.join(drawn) or 'a seed of their own'}"
    if drawn == [digest[:12]]:
        about += ": the checksum of the coefficients above"
    elif drawn:
        about += f": earlier coefficients; those above have {digest[:12]}"
    rows = [row for row in error_rows(errors) if row[-1]]
    deviations = markdown(uncertainty_rows(within))
    return f"{JUDGED_BEGIN}\n{about}.\n\n{markdown(rows)}\n{deviations}{JUDGED_END}"


def update_page(page: Path, section: str) -> None:
    """Put a section into the page in place of the one that has its marks."""
    begin, end = section.splitlines()[0], section.splitlines()[-1]
    text = page.read_text(encoding="utf-8")
    before, found, rest = text.partition(begin)
    if not found:
        raise InputError("has no place for this section", source=str(page), allowed=begin)
    _, _, after = rest.partition(end)
    page.write_text(before + section + after, encoding="utf-8")
