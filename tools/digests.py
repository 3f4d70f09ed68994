"""Write data/README.md: what is published, its digest, and what it was made from.

    python tools/digests.py

`tests/contract/test_structure.py` compares the page with the files.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from pathlib import Path

from dentscope.core.provenance import file_digest
from dentscope.models.coefficients import drawn_from
from dentscope.studies.challenge.archive import SEALS
from dentscope.studies.proof.seal import tree_hash

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "data" / "README.md"
COEFFICIENTS = ROOT / "data" / "coefficients" / "fitted.json"
SHORT = 12
RUN = "dentscope campaign run, publish"
PROOFS = {
    "ranks.jsonl": ("draws from the priors", "python -m dentscope.studies.calibration"),
    "ranks-at-data.jsonl": ("shipped recordings", "python -m dentscope.studies.at_data"),
    "third-world.json": ("its plan", "python -m dentscope.studies.proof.third_world run, score"),
}
LEVELS = "dentscope verify --only levels"
DRAWN = "python -m dentscope.studies.challenge.draw"

INTRO = """# What is published

Written by `python tools/digests.py`; a test compares it with the files. A digest is the beginning
of a SHA-256: of the file, or of the sorted names and digests of a folder's files.

| what | digest | made from | by |
| --- | --- | --- | --- |
"""
OUTRO = """
Whoever changes the campaign's data fits again; whoever changes the coefficients draws the challenge
and the figures again; a proof belongs to the source tree that it was drawn from.
"""


def digest(files: Iterable[Path]) -> str:
    """Return the digest of one file, or of several by their names."""
    found = sorted(files)
    if len(found) == 1:
        return file_digest(found[0])
    text = hashlib.sha256()
    for path in found:
        text.update(path.relative_to(ROOT).as_posix().encode() + b"\0")
        text.update(hashlib.sha256(path.read_bytes()).digest())
    return text.hexdigest()


def of_folder(name: str, *endings: str) -> list[Path]:
    """Files of a folder, of these endings only where some are given."""
    files = [p for p in (ROOT / name).rglob("*") if p.is_file() and "__pycache__" not in p.parts]
    return [p for p in files if not endings or p.suffix in endings]


def parts_read() -> list[str]:
    """Parts of the campaign that the coefficients were fitted to or judged by."""
    content = json.loads(COEFFICIENTS.read_text())
    parts = (content, content["hardening"])
    read = {one["sha256"] for part in parts for one in part["provenance"]["campaigns"]}
    names = {file_digest(p): p.name for p in of_folder("data/campaign", ".h5")}
    unknown = read - set(names)
    return sorted(names[one] for one in read & set(names)) + sorted(u[:SHORT] for u in unknown)


def rows() -> Iterable[tuple[str, str, str, str]]:
    """Yield what is published, its digest, what it was made from and the command."""
    fitted = digest([COEFFICIENTS])
    parts = of_folder("data/campaign", ".h5")
    for part in sorted(parts):
        yield f"campaign/{part.name}", digest([part]), "the solver", RUN
    read = ", ".join(name.removesuffix(".h5") for name in parts_read())
    yield "coefficients/fitted.json", fitted, f"campaign: {read}", "dentscope fit --publish"
    errors = ROOT / "data" / "coefficients" / "mesh_errors.json"
    yield "coefficients/mesh_errors.json", digest([errors]), "the solver", LEVELS
    challenge = of_folder("data/challenge", ".h5")
    drawn = f"coefficients {drawn_from()[:SHORT]}"
    yield "challenge", digest(challenge), drawn, "dentscope campaign run --design challenge"
    for place in ("blind-sets", "blind-sets/first"):
        sets = [ROOT / "data" / place / name for name in ("open.zip", "sealed.zip", SEALS)]
        yield place, digest(sets), "the proof's generators, secret seeds", DRAWN
    figures = of_folder("docs/thesis", ".png", ".md")
    yield "docs/thesis", digest(figures), drawn, "dentscope figures"
    laws = digest([ROOT / "data" / "proof" / "base_laws.json"])
    yield "proof/base_laws.json", laws, "the solver", "dentscope proof laws"
    for name, (made, command) in PROOFS.items():
        yield f"proof/{name}", digest([ROOT / "data" / "proof" / name]), made, command
    runs = ROOT / "data" / "proof" / "runs.json"
    full = [r for r in json.loads(runs.read_text()) if r["list"] == "full"][-1]
    tree, here = full["tree"], tree_hash(ROOT)
    whose = "the present one" if tree == here else "an earlier one"
    made = f"source tree {tree[:SHORT]}, {whose}"
    yield "proof/runs.json", digest([runs]), made, "dentscope proof run"


def page() -> str:
    """Return the whole page."""
    lines = [f"| `{what}` | `{sha[:SHORT]}` | {made} | `{by}` |" for what, sha, made, by in rows()]
    return INTRO + "\n".join(lines) + "\n" + OUTRO


if __name__ == "__main__":
    PAGE.write_text(page())
    print(PAGE.relative_to(ROOT))
