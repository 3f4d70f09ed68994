"""A run of before 0.3, which kept all its cases in one file, into a file a case.

`campaign.h5` holds a group a case under `/cases/ID`, laid out within as a case's file is now, with
a digest of its own since format 2. A file that is damaged gives the cases that are whole.
"""

from __future__ import annotations

import fcntl
import json
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path

import h5py

from ..core.disk import DISK
from ..core.errors import InputError
from ..core.inputs.input_file import checked_file
from ..core.output import write_file
from .contents import DAMAGE, DIGEST, damage, new_image, open_image, read_tree
from .records import read_case
from .rules import RULES
from .schema import FORMAT
from .store import OLDER, file_of

_FORMATS = ("dentscope-campaign/1", "dentscope-campaign/2")


def upgrade(folder: Path) -> tuple[int, list[str]]:
    """Take over the cases of `campaign.h5`, which is kept as `campaign.h5.upgraded`.

    Parameters
    ----------
    folder
        The run's folder.

    Returns
    -------
    tuple
        How many cases were taken over, and a line for each that was not; those are computed again
        by the next run.

    Raises
    ------
    InputError
        There is no such file, it is written just now, or nothing in it can be read.
    """
    older = folder / OLDER
    lost: list[str] = []
    if older.with_name(f"{OLDER}.journal").exists():
        lost.append(f"{OLDER}.journal: the case that was being written when its run was killed")
    try:
        with open_image(_image(older)) as file:
            if file.attrs.get("format") not in _FORMATS:
                raise InputError(
                    f"format {file.attrs.get('format')!r}", source=str(older),
                    allowed=" or ".join(_FORMATS),
                )  # fmt: skip
            kept = 0
            for key in file["cases"]:
                try:
                    image, status = _case_image(key, file["cases"][key], older)
                except DAMAGE as error:
                    lost.append(f"{key[:12]}: {damage(error)}")
                    continue
                write_file(file_of(folder, key, status), image)
                kept += 1
    except InputError:
        raise
    except DAMAGE as error:
        raise InputError(f"nothing in it can be read: {damage(error)}", source=str(older)) from None
    DISK.rename(older, older.with_name(f"{OLDER}.upgraded"))
    DISK.sync_folder(folder)
    return kept, lost


def _image(older: Path) -> bytes:
    """Return the bytes of the file while no run of before writes it."""
    checked_file(older, most=RULES.old_run_bytes, allowed="a run of before 0.3")
    with ExitStack() as held:
        for place in (older.with_suffix(".lock"), older):
            if place.exists():
                stream = held.enter_context(place.open("rb"))
                try:
                    fcntl.flock(stream, fcntl.LOCK_SH | fcntl.LOCK_NB)
                except BlockingIOError:
                    raise InputError(
                        "its run still goes on", source=str(older), allowed="a run that ended"
                    ) from None
        return older.read_bytes()


def _case_image(key: str, group: h5py.Group, older: Path) -> tuple[bytes, str]:
    """Return a group of an older file as the file of its case, and the case's status."""
    tree = read_tree(group)
    if DIGEST in tree.attributes and tree.attributes[DIGEST] != tree.digest():
        raise ValueError("its digest is another")
    with new_image() as made:
        for name in tree.groups:
            group.copy(name, made.file)
        for name, value in tree.attributes.items():
            if name != DIGEST:
                made.file.attrs[name] = value
        made.file.attrs["format"] = FORMAT
        made.file.attrs["id"] = key
        record = read_case(made.file, older)
        if record.curve:
            made.file.attrs["quality"] = json.dumps(asdict(record.quality))
    return made.sealed, record.status
