"""The recordings that interventions are made in, as recording sets.

Shipped sets are copied; the others are made, by the recipes of data/recordings/recipes and by what
stands here, from raw files that `dentscope recordings fetch` brings and that may not be shipped.
"""

from __future__ import annotations

import csv
import re
import runpy
import shutil
import tempfile
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from ...core.errors import InputError
from ...core.output import csv_text
from ...recordings.shipped import FOLDER, shipped_sets
from ...reduce.kinds import load_kind
from ...reduce.output.into_set import store_each
from ...reduce.output.row import Row
from ...reduce.reduced import Reduced

_GOLF_MASS, _GOLF_DIAMETER = 0.0459, 0.0427
"""Rules of golf: at most 45.93 g, at least 42.67 mm."""
_GOLF_CONTACT = 5e-4
_GRAVITY = 9.81
_TIMED = 0.018
"""Standard deviation of a speed from a timed flight, as the reduction gives it [m/s]."""

_GOLF = {
    "format": "recording-set/1",
    "name": "golf-ball",
    "description": "a golf ball on a hard floor",
    "source": "github giiulia/LabI-Dynamics-Thermodynamics, Coefficient_of_restitution, 2021",
    "licence": "none stated; not for shipping",
    "target": {"shape": "flat", "material": "hard floor", "law": "measured-restitution"},
    "strikers": {
        "ball": {
            "shape": "sphere", "tip_radius_m": _GOLF_DIAMETER / 2.0, "mass_kg": _GOLF_MASS,
            "material": "golf ball",
        },
    },
    "environment": {"fluid": "air"},
}  # fmt: skip

Rows = list[dict[str, str]]
Maker = Callable[..., None]


def base(name: str, given: Mapping[str, float], *, raw: Path, folder: Path) -> None:
    """Write the set `name` into a folder that isn't there yet.

    `name`: a shipped set, or one of `MADE`; `given`: options of the latter; `raw`: folder of the
    fetched recordings; `folder`: of the set.

    Raises `FileNotFoundError`: the raw files are not there.
    """
    if name in MADE:
        source, make = MADE[name]
        if not (raw / source).is_dir():
            raise FileNotFoundError(raw / source)
        make(raw / source, folder, **given)
        return
    if name not in shipped_sets():
        raise InputError(repr(name), key="base", allowed=", ".join((*shipped_sets(), *MADE)))
    shutil.copytree(FOLDER / name, folder)


def rows_of(folder: Path) -> Rows:
    """Read the rows of trials.csv, as text."""
    with (folder / "trials.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def write_rows(rows: Rows, folder: Path) -> None:
    """Replace trials.csv; a column that a row lacks is empty there."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    text = csv_text(([row.get(name, "") for name in names] for row in rows), header=names)
    (folder / "trials.csv").write_text(text, encoding="utf-8")


def _recipe(file: str, inside: str, raw: Path, folder: Path, *rest: Any) -> None:
    runpy.run_path(str(FOLDER / "recipes" / file))["recipe"](raw / inside, folder, *rest)


def _golf_drag(drag_off: float) -> dict[str, float]:
    return {"mass_kg": _GOLF_MASS, "diameter_m": _GOLF_DIAMETER} if drag_off else {}


def _golf_sounds(raw: Path, folder: Path, *, drag_off: float = 1.0) -> None:
    """Bounces timed by sound: each sheet of the workbook holds four runs side by side."""
    from python_calamine import CalamineWorkbook

    options = {"holds": "bounces", "contact_time_s": _GOLF_CONTACT, **_golf_drag(drag_off)}
    book = CalamineWorkbook.from_path(raw / "golf_ball" / "data_golfball.xlsx")
    with tempfile.TemporaryDirectory() as place:
        items = []
        for sheet in book.sheet_names:
            _, *rows = book.get_sheet_by_name(sheet).to_python()
            for run, column in enumerate((0, 3, 6, 9), start=1):
                file = Path(place) / f"{sheet.split()[0]}cm-{run}.csv"
                times = [str(row[column]) for row in rows if row[column] != ""]
                file.write_text("\n".join(["time_s", *times]) + "\n")
                items.append((file.stem, partial(_run, file, options)))
        store_each(items, folder, kind="table", setup=_GOLF)


def _run(file: Path, options: dict[str, Any]) -> tuple[Reduced, Row, dict[str, Any]]:
    found = load_kind("table").run(file, options, source="interventions")
    return found, Row(striker="ball", trial=file.stem), options


def _golf_both(raw: Path, folder: Path, *, height_error_m: float = 0.0) -> None:
    """By sound, and by the height of the first rebound in ten videos from each height of fall."""
    _golf_sounds(raw, folder)
    rows = rows_of(folder)
    options = {"holds": "rebounds", "value": "1", **_golf_drag(1.0)}
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "heights.csv"
        file.write_text("\n".join(_heights(raw, 100.0 * height_error_m)) + "\n")
        found = load_kind("table").run(file, options, source="interventions")
    for name, e in found.values.items():
        speed = float(name.split("_at_")[1].split("_")[0])
        rows.append({
            "trial": f"video-{speed:.2f}", "striker": "ball", "angle_deg": "90",
            # the reduction has taken the drag off: what is left is a fall under gravity alone
            "drop_height_m": f"{speed**2 / (2.0 * _GRAVITY):.5f}",
            "rebound_speed_m_s": f"{e.value * speed:.5f}",
            "rebound_speed_m_s_std": f"{e.std * speed:.5f}",
        })  # fmt: skip
    write_rows(rows, folder)


def _heights(raw: Path, error_cm: float) -> list[str]:
    """Return the golf ball's table: the authors' arrays of heights of fall and rebound [cm]."""
    text = (raw / "first_bounce_heights.txt").read_text(encoding="utf-8")
    falls, rebounds = (_array(text, f"pallina4_{name}") for name in ("H0", "H1"))
    head = ",".join(["drop_cm", *(f"rebound{i}_cm" for i, _ in enumerate(rebounds[0], start=1))])
    return [head, *(
        ",".join([str(float(fall) + error_cm), *heights])
        for (fall,), heights in zip(falls, rebounds, strict=True)
    )]  # fmt: skip


def _array(text: str, name: str) -> list[list[str]]:
    [body] = re.findall(rf"{name} = np\.array\(\[(.*?)\]\)", text, flags=re.DOTALL)
    return [row.split(", ") for row in re.findall(r"\[([^\[\]]+)\]?", body)]


def _rubber_sounds(raw: Path, folder: Path, *, height_error_m: float = 0.0) -> None:
    """The recipe's set; first bounces by their height of release and the flight after it."""
    _recipe("ball_sounds.py", "blue_ball", raw, folder)
    rows = rows_of(folder)
    for row in rows:
        if row["trial"].endswith("-bounce1"):
            speed, e = float(row.pop("impact_speed_m_s")), float(row.pop("restitution"))
            row["impact_speed_m_s_std"] = row["restitution_std"] = ""
            height = float(row["trial"].split("cm")[0]) / 100.0 + height_error_m
            row["drop_height_m"], row["drop_height_m_std"] = f"{height:g}", "0.005"
            row["rebound_speed_m_s"] = f"{speed * e:.5f}"
            row["rebound_speed_m_s_std"] = f"{_TIMED:g}"
    write_rows(rows, folder)


def _two_balls(raw: Path, folder: Path) -> None:
    """Both balls under the golf ball's name."""
    _golf_sounds(raw, folder)
    with tempfile.TemporaryDirectory() as place:
        _recipe("ball_sounds.py", "blue_ball", raw, Path(place) / "rubber")
        write_rows([*rows_of(folder), *rows_of(Path(place) / "rubber")], folder)


MADE: dict[str, tuple[str, Maker]] = {
    "golf-sounds": ("ball-bounce-acoustic", _golf_sounds),
    "golf-both": ("ball-bounce-acoustic", _golf_both),
    "rubber-sounds": ("ball-bounce-acoustic", _rubber_sounds),
    "two-balls": ("ball-bounce-acoustic", _two_balls),
    "marble-on-paper": ("marble-on-paper", partial(_recipe, "marble_paper.py", "a4")),
    "tabletennis-spin": ("tabletennis-spin", lambda raw, folder: _recipe(
        "tabletennis_spin.py", "trajectories.zip", raw, folder, 300)),
}  # fmt: skip
"""Sets that are made: the fetched source, and what makes them."""
