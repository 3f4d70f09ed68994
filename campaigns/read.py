"""One way to read completed cases, whatever they lie in: a run's file, a part, a data set."""

from __future__ import annotations

from pathlib import Path

from .parts import CHECKSUMS, is_part, read_part
from .publish import read_published
from .records import CaseRecord
from .store import Store


def read_curves(path: Path) -> list[CaseRecord]:
    """Read all completed cases of a campaign file, a published part or a folder of parts.

    Where a file holds cases of several numerics versions, only those of the present one are given:
    the same pair would otherwise come twice.

    Raises
    ------
    InputError
        The file is missing, is no campaign file, or is damaged.
    """
    if (path / CHECKSUMS).exists():
        done = read_published(path)
    elif is_part(path):
        done = [record for record in read_part(path) if record.status == "done"]
    else:
        done = [record for record in Store(path).read_all() if record.status == "done"]
    return [record for record in done if record.id == record.case.id] or done
