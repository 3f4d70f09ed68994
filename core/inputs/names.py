"""Names that become names of files: those of trials, strikers and others that a user chooses.

A name is looked at where it is read, from a file or an option; a writer may then rely on it.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator

# limit: longest name that becomes a file's [bytes]; file systems take 255; what is written beside
# a trial gets up to 55 more
NAME_BYTES = 200

ALLOWED = "text that can name a file"

_NEVER = frozenset('/\\:*?"<>|')


def names_a_file(text: str) -> bool:
    r"""Whether a text can name a file here and elsewhere, and names no other folder.

    Examples
    --------
    >>> [names_a_file(text) for text in ("drop 3", "../x", "a\\b", "..", "")]
    [True, False, False, False, False]
    """
    return (
        0 < len(text.encode(errors="replace")) <= NAME_BYTES
        and text.isprintable()
        and not _NEVER & set(text)
        and text not in (".", "..")
    )


def trial_name(path: Path, /, **options: Any) -> str:
    """Return the name of a raw file, and of what is picked of it, as one that can name a trial."""
    picked = (str(options.get(key) or "").rpartition("=")[2] for key in ("sheet", "select"))
    name = "-".join(filter(None, (path.stem, *picked)))
    return re.sub(r'[/\\:*?"<>|\s]+', "_", name).strip("_.") or "trial"


def _checked(text: str) -> str:
    if not names_a_file(text):
        raise ValueError(ALLOWED)
    return text


FileName = Annotated[str, AfterValidator(_checked)]
FileNameIfAny = Annotated[str, AfterValidator(lambda text: text and _checked(text))]
