"""Seals: what was drawn is fixed before it is analysed, what was found before it is compared.

A ledger holds one line per event (truth sealed, verdict sealed, opened). Each line carries the hash
of the line before it, so that no line can be changed, dropped or put in later without a trace.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
from collections import Counter
from pathlib import Path
from typing import Any

_APART = ("studies/", "tests/", "docs/", "tools/", "build/", "examples/")
_DATA = ("data/coefficients", "discrepancy")
_DATA_ENDINGS = {".json", ".toml", ".npz", ".h5"}


def tree_hash(root: Path) -> str:
    """SHA-256 of the tool's source tree without the proof, coefficients included.

    Every Python file of the package and every data file that the diagnosis reads from it, by path.
    """
    text = hashlib.sha256()
    for path in _tool_files(root):
        text.update(path.relative_to(root).as_posix().encode() + b"\0")
        text.update(hashlib.sha256(path.read_bytes()).digest())
    return text.hexdigest()


def _tool_files(root: Path) -> list[Path]:
    files = [p for p in root.glob("*.py")]
    for stage in sorted(p for p in root.iterdir() if (p / "__init__.py").exists()):
        files += stage.rglob("*.py")
    for folder in _DATA:
        files += [p for p in (root / folder).rglob("*") if p.suffix in _DATA_ENDINGS]
    return sorted({p for p in files if not p.relative_to(root).as_posix().startswith(_APART)})


def digest_of(folder: Path) -> str:
    """SHA-256 of a file, as `sha256sum` tells it; of a folder over the names and digests in it."""
    if folder.is_file():
        return hashlib.sha256(folder.read_bytes()).hexdigest()
    text = hashlib.sha256()
    for path in sorted(p for p in folder.rglob("*") if p.is_file()):
        name = path.relative_to(folder).as_posix()
        text.update(name.encode() + b"\0" + hashlib.sha256(path.read_bytes()).digest())
    return text.hexdigest()


def digest_of_record(record: dict[str, Any]) -> str:
    """SHA-256 of a record as JSON, its keys in order."""
    return _chain("", record)


class SealBroken(ValueError):
    """A file or a line of the ledger is not what was sealed."""


class Ledger:
    """The chained list of events of one run.

    `path`: file of lines of JSON; made when the first event is written.
    """

    def __init__(self, path: Path) -> None:
        self.path = path

    def events(self) -> list[dict[str, Any]]:
        """All events, the chain checked.

        Raises `SealBroken`: a line does not fit the line before it.
        """
        if not self.path.exists():
            return []
        before, found = "", []
        for number, line in enumerate(self.path.read_text().splitlines(), start=1):
            try:
                event = json.loads(line)
            except ValueError as error:
                raise SealBroken(f"{self.path.name}, line {number}: unreadable") from error
            if not isinstance(event, dict) or event.pop("chain", None) != _chain(before, event):
                raise SealBroken(f"{self.path.name}, line {number}: the chain is broken")
            before = _chain(before, event)
            found.append(event)
        return found

    def add(self, **event: Any) -> None:
        """Append one event; a run and its scoring may write at the same time."""
        with self.path.open("a", encoding="utf-8") as stream:
            fcntl.flock(stream, fcntl.LOCK_EX)  # dropped as the file closes
            before = ""
            for old in self.events():
                before = _chain(before, old)
            line = event | {"chain": _chain(before, event)}
            stream.write(json.dumps(line, sort_keys=True) + "\n")

    def of(self, kind: str) -> dict[str, dict[str, Any]]:
        """Events of one kind by the name of their set; the last one counts."""
        return {e["set"]: e for e in self.events() if e["event"] == kind}


def _chain(before: str, event: dict[str, Any]) -> str:
    return hashlib.sha256((before + json.dumps(event, sort_keys=True)).encode()).hexdigest()


def sealed_twice(ledger: Ledger) -> set[str]:
    """Sets whose truth or verdict is sealed more than once, as by two processes at one run."""
    counts = Counter((e["event"], e.get("set", "")) for e in ledger.events())
    return {name for (kind, name), n in counts.items() if kind in ("truth", "verdict") and n > 1}


def check(ledger: Ledger, run: Path, name: str) -> None:
    """Check the seals of one set: truth and set before verdict, none changed since, none opened.

    Raises `SealBroken`: says which seal does not hold.
    """
    order = [(e["event"], e.get("set")) for e in ledger.events()]
    places = {pair: i for i, pair in reversed(list(enumerate(order)))}
    truth, verdict = places.get(("truth", name)), places.get(("verdict", name))
    if truth is None or verdict is None or verdict < truth:
        raise SealBroken(f"{name}: no truth sealed before its verdict")
    opened = places.get(("opened", name))
    if opened is not None and opened < verdict:
        raise SealBroken(f"{name}: opened before its verdict was sealed")
    if order.count(("truth", name)) > 1 or order.count(("verdict", name)) > 1:
        raise SealBroken(f"{name}: sealed more than once")
    sealed = ledger.of("truth")[name]
    if digest_of(run / "truths" / f"{name}.json") != sealed["truth"]:
        raise SealBroken(f"{name}: the truth is not the one sealed")
    if digest_of(run / "sets" / name) != sealed["recordings"]:
        raise SealBroken(f"{name}: the recordings are not those sealed")
    found = ledger.of("verdict")[name]
    path = run / "verdicts" / f"{name}.json"
    if found["verdict"] and digest_of(path) != found["verdict"]:
        raise SealBroken(f"{name}: the verdict is not the one sealed")
