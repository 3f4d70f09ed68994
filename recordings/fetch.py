"""Raw recordings that may not be shipped: fetched by pinned address and checksum."""

from __future__ import annotations

import logging
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Annotated
from urllib.parse import quote

import pooch  # type: ignore[import-untyped]
import requests  # type: ignore[import-untyped]
from pydantic import AfterValidator, Field
from requests.exceptions import RequestException

from ..core.errors import InputError
from ..core.inputs.toml_input import InputTable, Listed, read_model

# limit: wait for a server that says nothing [s]: a slow line
_SERVER_S = 30.0

# limit: longest time that one file may take [s]: a slow line
_FETCHED_S = 1800.0

# limit: largest file that is fetched [bytes]
_FETCHED_BYTES = 2_000_000_000

_PIECE = 1 << 20
_SHA256 = r"[0-9a-f]{64}"


def _inside(path: str) -> str:
    parts = PurePosixPath(path).parts
    if not parts or path.startswith("/") or ".." in parts or "\\" in path:
        raise ValueError("a path inside the source's folder")
    return path


class SourceFile(InputTable):
    """`[[source.files]]`: where a file is below the source's address, and what it must be."""

    path: str = Field(min_length=1)
    to: Annotated[str, AfterValidator(_inside)]
    sha256: str = Field(pattern=_SHA256)


class Source(InputTable):
    """`[[source]]`: raw files of one origin, pinned to one version."""

    name: Annotated[str, AfterValidator(_inside)]
    title: str = ""
    licence: str
    base: str = Field(pattern="^https?://.*/$")
    recipe: str = ""
    files: tuple[SourceFile, ...] = Field(min_length=1, strict=False)


class Catalogue(InputTable):
    """The whole list."""

    source: tuple[Source, ...] = Listed


@dataclass(frozen=True, slots=True)
class Fetched:
    """One source on this machine: its files, each with the right checksum."""

    name: str
    folder: Path
    files: tuple[Path, ...]
    recipe: str


def read_catalogue(path: Path) -> Catalogue:
    """Read a list of sources; every mistake is a line of one error."""
    return read_model(path, Catalogue)


def fetch_sources(catalogue: Catalogue, out: Path, names: Sequence[str]) -> Iterator[Fetched]:
    """Fetch sources one after the other, all if no names are given, into `out/NAME/raw` each.

    Files that are already there and right are kept. Refuses an unknown name, an address that does
    not answer, and a file with another checksum.
    """
    known = {source.name: source for source in catalogue.source}
    for name in names:
        if name not in known:
            raise InputError(f"no source {name!r}", source="fetch", allowed=", ".join(known))
    pooch.get_logger().setLevel(logging.WARNING)
    for name in names or known:
        source, folder = known[name], out / name / "raw"
        files = tuple(_file(source, item, folder) for item in source.files)
        yield Fetched(name, folder, files, source.recipe)


def _capped(url: str, output_file: str, pooch: object) -> None:
    """Fetch a file of a bearable size in a bearable time; the checksum is compared afterwards."""
    until, size = time.monotonic() + _FETCHED_S, 0
    with (
        requests.get(url, stream=True, timeout=_SERVER_S) as answer,
        Path(output_file).open("wb") as out,
    ):
        answer.raise_for_status()
        for piece in answer.iter_content(_PIECE):
            size += len(piece)
            if size > _FETCHED_BYTES or time.monotonic() > until:
                raise InputError(
                    f"{size / 1e6:.0f} MB fetched and no end", source=url,
                    allowed=f"a file of up to {_FETCHED_BYTES / 1e9:g} GB, within "
                    f"{_FETCHED_S / 60.0:g} minutes",
                )  # fmt: skip
            out.write(piece)


def _file(source: Source, item: SourceFile, folder: Path) -> Path:
    place = folder / item.to
    url = source.base + quote(item.path)
    try:
        pooch.retrieve(
            url, known_hash=f"sha256:{item.sha256}", fname=place.name, path=place.parent,
            downloader=_capped,
        )  # fmt: skip
    except InputError:
        raise
    except RequestException as error:
        reason = type(error).__name__
        raise InputError(
            f"cannot be fetched ({reason})", source=url, allowed="a network that reaches it"
        ) from None
    except ValueError:
        raise InputError(
            "the file behind this address has another checksum", source=url,
            allowed=f"sha256 {item.sha256}",
        ) from None  # fmt: skip
    except OSError as error:
        raise InputError(f"cannot be written ({error.strerror})", source=str(place)) from None
    return place
