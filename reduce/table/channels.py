"""Channels of measuring programs: TDMS of LabVIEW and DIAdem, HDF5 of whoever writes it.

Read in a process of its own (`core.processes`). A group becomes a table: its channels of one length
are the columns, and where they state the time between two samples a column of the time comes first.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError, optional, reading
from .heading import in_short

# limit: samples of a channel at most [-]: memory of a small machine
_CHANNEL_SAMPLES = 50_000_000

CHANNELS = (".tdms", ".h5", ".hdf5", ".hdf")
"""Endings of such files."""

_STEPS = ("wf_increment", "dt", "sample_interval", "time_step")
_RATES = ("sampling_rate", "sample_rate", "fs", "rate")
_UNITS = ("unit_string", "units", "unit")


class Shown(Sequence[tuple[str, ...]]):
    """Rows of numbers as a table's cells, made when one is asked for."""

    def __init__(self, values: Array) -> None:
        self.values = values

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, k: Any) -> Any:
        if isinstance(k, slice):
            return Shown(self.values[k])
        return tuple(map(repr, map(float, self.values[k])))


def channels_of(path: Path, group: str) -> tuple[list[str], Array]:
    """Return names and numbers (n, m) of a group, by default the first with some."""
    tables = _tdms(path) if path.suffix.lower() == ".tdms" else _hdf5(path)
    wanted = group.strip("/ ")
    if wanted and wanted not in tables:
        raise InputError(
            f"no group {group!r}", source=str(path), key="sheet", allowed=", ".join(tables) or "-"
        )
    name = wanted or next(iter(tables), "")
    if not tables.get(name):
        raise InputError("no channel of numbers", source=str(path), allowed="samples in a group")
    return _table(tables[name])


_Channel = tuple[str, Array, Mapping[str, Any]]


def _table(channels: list[_Channel]) -> tuple[list[str], Array]:
    """The channels that are as long as the longest, the time before them."""
    longest = max(values.size for _name, values, _said in channels)
    used = [c for c in channels if c[1].size == longest]
    names = [_with_unit(name, said) for name, _values, said in used]
    columns = [values.astype(float) for _name, values, _said in used]
    step = next(filter(None, (_step(said) for _name, _values, said in used)), None)
    if step is not None and not any(n.lower().startswith(("time", "zeit", "t [")) for n in names):
        names.insert(0, "time [s]")
        columns.insert(0, step * np.arange(float(longest)))
    return names, np.stack(columns, axis=1)


def _with_unit(name: str, said: Mapping[str, Any]) -> str:
    unit = next((said[k] for k in _UNITS if k in said), "")
    unit = unit.decode("utf-8", "replace") if isinstance(unit, bytes) else str(unit)
    return f"{name} [{in_short(unit)}]" if unit else name


def _step(said: Mapping[str, Any]) -> float | None:
    for names, turned in ((_STEPS, False), (_RATES, True)):
        for name in names:
            try:
                number = float(said.get(name, "nan"))
            except (TypeError, ValueError):
                continue
            if number > 0.0 and np.isfinite(number):
                return 1.0 / number if turned else number
    return None


def _tdms(path: Path) -> dict[str, list[_Channel]]:
    nptdms = optional("nptdms", "reading TDMS", "tables")
    allowed = "a TDMS file of LabVIEW or DIAdem"
    with reading(path, allowed), nptdms.TdmsFile.open(str(path)) as file:
        return {
            group.name: [
                (c.name, _read(c, len(c), path), dict(c.properties))
                for c in group.channels()
                if len(c) and c.dtype is not None and np.dtype(c.dtype).kind in "iufb"
            ]
            for group in file.groups()
        }


def _hdf5(path: Path) -> dict[str, list[_Channel]]:
    import h5py

    allowed = "an HDF5 file with columns of numbers"
    found: dict[str, list[_Channel]] = {}
    places: list[str] = []
    raised = (OSError, RuntimeError, KeyError, ValueError)
    with reading(path, allowed, raised=raised), h5py.File(path, "r") as file:
        file.visit(places.append)
        for place in places:
            data = file[place]
            if not (isinstance(data, h5py.Dataset) and data.dtype.kind in "iufb" and data.size):
                continue
            group, _, name = place.rpartition("/")
            said = {**dict(data.parent.attrs), **dict(data.attrs)}
            values = _read(data, data.size, path)
            if values.ndim == 2 and min(values.shape) <= 100:
                columns = values if values.shape[0] >= values.shape[1] else values.T
                found[place] = [
                    (f"{name} {k + 1}", column, said) for k, column in enumerate(columns.T)
                ]
            elif values.ndim == 1:
                found.setdefault(group, []).append((name, values, said))
    return found


def _read(data: Any, size: int, path: Path) -> Array:
    if size > _CHANNEL_SAMPLES:
        raise InputError(
            f"{size} samples in one channel", source=str(path), allowed=f"up to {_CHANNEL_SAMPLES}"
        )
    return np.asarray(data[:])
