"""One way to read completed cases, whatever they lie in: a run, a part, a data set, one file."""

from __future__ import annotations

from pathlib import Path

from ..core.errors import InputError
from ..core.provenance import content_id, file_digest
from .parts import CHECKSUMS, is_part, read_part
from .publish import read_published
from .records import CaseRecord
from .store import Store, read_case_file


def read_curves(path: Path) -> list[CaseRecord]:
    """Read all completed cases of a run, a published part, a folder of parts or one case's file.

    Where a run holds cases of several numerics versions, only those of the present one are given:
    the same pair would otherwise come twice. Refused where there is nothing, or it is damaged.
    """
    if (path / CHECKSUMS).exists():
        found = read_published(path)
    elif path.is_dir():
        found = Store(path).read_all()
    elif not path.exists():
        raise InputError(
            "no such file", source=str(path), allowed="the folder of a run, or a published part"
        )
    elif is_part(path):
        found = read_part(path)
    else:
        found = [read_case_file(path)]
    done = [record for record in found if record.status == "done"]
    return [record for record in done if record.id == record.case.id] or done


def digest_of_source(path: Path) -> str:
    """SHA-256 of a file's bytes; of a run, of the list of its cases' files and theirs."""
    if not path.is_dir():
        return file_digest(path)
    return content_id({file.name: file_digest(file) for file in Store(path).files()})
