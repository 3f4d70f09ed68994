"""Films and sounds as FFmpeg decodes them, from the one file that is named.

A playlist (`ffconcat`, HLS) or a container with references names other files: none is opened.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ...core.errors import InputError, optional


@contextmanager
def container_of(path: Path, kind: str, allowed: str) -> Iterator[Any]:
    """Open a film or a sound; refuse what cannot be decoded, or that PyAV is missing.

    A message calls the reading `kind`, and what the file may be `allowed`.
    """
    av = optional("av", f"reading {kind}", "video")
    try:
        # bytes come from our handle alone: FFmpeg has no protocol left to open a name with
        with (
            path.open("rb") as file,
            av.open(file, container_options={"protocol_whitelist": "none"}) as container,
        ):
            yield container
    except (av.FFmpegError, OSError) as error:  # of an empty file, the latter
        text = getattr(error, "strerror", None) or type(error).__name__
        raise InputError(f"cannot be decoded ({text})", source=str(path), allowed=allowed) from None
