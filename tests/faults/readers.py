"""Every reader of files that may come from others: a sound file for each, and how it is read."""

import hashlib
import json
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache, partial
from pathlib import Path
from typing import Any

import disk_faults
import numpy as np
import raw_files
from dentscope.campaigns import Design, Store, publish, read_curves
from dentscope.campaigns.parts import CHECKSUMS
from dentscope.core.material import Material, Pair
from dentscope.core.output import PENDING
from dentscope.core.output import _pending as pending
from dentscope.dynamics.files.inverse_file import read_inverse
from dentscope.dynamics.files.setup import read_setup
from dentscope.models import law_named
from dentscope.models.table import LoadingCurve, PairTable, Turns
from dentscope.models.table_file import write_table
from dentscope.recordings import audit, read
from dentscope.recordings.fetch import read_catalogue
from dentscope.start.case_file import read_case, read_flow_curve
from mutations import mutated, resealed, tampered

ROOT = Path(__file__).resolve().parents[2]
SET = """format = "recording-set/1"
name = "rod and ball"
gravity_m_s2 = 9.81
[target]
E_Pa = { value = 2.0e11, std = 4.0e9 }
nu = 0.3
flow_curve = "iron.csv"
thickness_m = 0.03
density_kg_m3 = 7870
[strikers.rod]
shape = "rod"
tip_radius_m = { value = 0.01, std = 1e-4 }
mass_kg = 0.5
radius_m = 0.01
length_m = 0.3
[strikers."steel ball"]
shape = "sphere"
tip_radius_m = 0.01
density_kg_m3 = 7800
[noise]
restitution = 0.01
"""
TRIALS = b"""trial,striker,angle_deg,drop_height_m,impact_speed_m_s,\
restitution,permanent_depth_m,note
a,rod,90,0.2,,0.5,1.0e-5,
b,rod,90,0.2,,0.51,1.1e-5,first
c,rod,90,0.2,,,1.2e-5,
d,rod,45,0.4,,0.4,,
e,steel ball,30,0.4,,0.4,,
f,steel ball,30,,1.5,0.4,,
"""
FLOW = (
    b"plastic_strain,true_stress_Pa,strain_rate_per_s,temperature_K\n"
    b"0,3e8,1e-3,293\n0.01,3.3e8,1e-3,293\n0.2,4e8,1e-3,293\n"
    b"0,3.6e8,10,293\n0.05,4.1e8,10,293\n"
)
RECORD = {
    "trials": ["a"], "files": ["raw.csv"], "sha256": {"raw.csv": 64 * "0"}, "kind": "table",
    "options": {"holds": "force"},
}  # fmt: skip
IMPACT = """
[sweep]
impact_speed_m_s = { from = 0.1, to = 5.0, count = 12, spacing = "log" }
angle_deg = [20, 45, 90]
"""


@dataclass(frozen=True)
class Reader:
    """A file that is damaged: its place, what makes, reads, lays it out, and stands beside it."""

    name: str
    make: Callable[[], bytes]
    read: Callable[[Path], Any]
    beside: Mapping[str, Callable[[], bytes]] = field(default_factory=dict)
    change: Callable[..., tuple[bytes, bool]] = mutated
    put: Callable[[bytes, Path], Path] | None = None


def lay_out(reader, content, folder):
    """Put a file where its reader looks for it, with what belongs beside it."""
    if reader.put:
        folder.mkdir()
        return reader.put(content, folder)
    for name, make in {**reader.beside, reader.name: lambda: content}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(make())
    return folder / reader.name


# --- recording sets ---


def _read_set(path):
    folder = path.parent if path.parent.name not in ("traces", "profiles", "reduced") else (
        path.parent.parent
    )  # fmt: skip
    found = read(folder)
    audit(found)
    assert np.isfinite(found.approach.normal).all(), "NaN"


def _curve(head, rows):
    return "\n".join([head, *(",".join(f"{v:.6g}" for v in row) for row in rows)]).encode()


def _trace():
    t = np.linspace(0.0, 1e-3, 30)
    return _curve("time_s,force_N", zip(t, 500.0 * np.sin(np.pi * 1e3 * t), strict=True))


def _profile():
    x = np.linspace(-1e-3, 1e-3, 40)
    z = -1e-5 * np.maximum(0.0, 1.0 - (x / 5e-4) ** 2)
    return _curve("x_m,z_m", zip(x, z, strict=True))


WHOLE = {
    "set.toml": SET.encode,
    "trials.csv": lambda: TRIALS,
    "iron.csv": lambda: FLOW,
    "traces/a.csv": _trace,
    "profiles/a.csv": _profile,
    "reduced/a-table.json": lambda: json.dumps(RECORD).encode(),
}


def in_set(name):
    return Reader(name, WHOLE[name], _read_set, WHOLE)


def shipped_set(name, folder):
    files = {
        file: partial(_data, "data", "recordings", folder, file)
        for file in ("set.toml", "trials.csv")
    }
    return Reader(name, files[name], _read_set, files)


def _pending():
    with tempfile.TemporaryDirectory() as folder:
        lay_out(in_set("trials.csv"), TRIALS, Path(folder))
        return pending(Path(folder), {"trials.csv": TRIALS + b"g,rod,90,0.2,,0.5,,\n"})


def _other_pending(content, draw):
    """Damage it; or name other files in it, with its digest made anew."""
    body, head = content[:-32], b"dentscope-pending-1\n"
    if draw.random() < 0.3:
        return mutated(content, draw)
    at = len(head) + 8
    end = at + int.from_bytes(body[at - 8 : at], "little")
    odd = ("../out", "/tmp/out", "a/../../out", "", ".", "set.toml/x", "\0", "x" * 300, 3, None)
    entries = json.loads(body[at:end])
    entries[0][draw.randrange(3)] = draw.choice((*odd, -1, 2**70, []))
    text = json.dumps(entries).encode() if draw.random() < 0.8 else mutated(body[at:end], draw)[0]
    made = head + len(text).to_bytes(8, "little") + text + body[end:]
    return made + hashlib.sha256(made).digest(), False


# --- pairs and impacts ---


def _read_setup(path):
    setup = read_setup(path)
    scene = setup.scene(law_named("hertz"))
    numbers = (scene.approach.speed, scene.striker.mass, scene.pair.R, scene.pair.E_reduced)
    assert np.isfinite(numbers).all(), "NaN"


def _read_inverse(path):
    rows = read_inverse(path)
    for row in rows:
        assert np.isfinite([row.inferred.duration, row.inferred.mean_force]).all(), "NaN"


def _law():
    d = np.geomspace(1e-4, 0.05, 30)
    spread = np.full(30, 0.003)
    pair = Pair(Material(E=2e11, nu=0.3, Sy=8e8), Material(E=2e11, nu=0.3, Sy=3e8), 0.01)
    curve = LoadingCurve(d, 4 / 3 * d**1.5, np.sqrt(d), np.full(30, 0.4), spread, spread, spread)
    turns = Turns(d[[15, 20, 29]], *(np.full(3, v) for v in (0.6, 0.3, 1.4)))
    with tempfile.TemporaryDirectory() as folder:
        return write_table(PairTable(pair, curve, turns), Path(folder) / "law.json").read_bytes()


def _read_law(path):
    law = law_named(str(path))
    pair = law.tables[0].pair
    depth = law.tables[0].curve.depth
    assert np.isfinite(law.tables[0].numbers).all(), "NaN"
    assert np.isfinite(law.share(pair, depth * pair.R)).all(), "NaN"


# --- campaigns ---


@cache
def _published():
    cases = disk_faults.CASES
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        store = Store(place / "run")
        for case in cases[:2]:
            store.put(case, disk_faults.solved(case))
        publish(Design("trial", "", lambda: cases[:2]), store.folder, place)
        part = (place / "trial-1.h5").read_bytes()
        sums = (place / CHECKSUMS).read_bytes()
        case = store.files()[0].read_bytes()
        return {"case.h5": case, "trial-1.h5": part, CHECKSUMS: sums}


def of_campaign(name, change):
    return Reader(name, lambda: _published()[name], read_curves, {}, change)


def _broken_seal(content, draw):
    found, _ = mutated(content, draw)
    return (resealed(found) if draw.random() < 0.7 else found), False


# --- raw recordings ---


def raw(name):
    def change(content, draw):
        return raw_files.damaged(name, content, draw, mutated)

    sound, read, lay_out = (
        partial(do, name) for do in (raw_files.sound, raw_files.read, raw_files.lay_out)
    )
    return Reader(name, sound, read, {}, change, lay_out)


def _data(*parts):
    return ROOT.joinpath(*parts).read_bytes()


CASE = _data("examples", "case_mild_steel_fast.toml")
CURVE = {"flow_curve.csv": partial(_data, "examples", "flow_curve.csv")}
READERS = {
    "set.toml": in_set("set.toml"),
    "trials.csv": in_set("trials.csv"),
    "set's flow curve": in_set("iron.csv"),
    "trace": in_set("traces/a.csv"),
    "profile": in_set("profiles/a.csv"),
    "record": in_set("reduced/a-table.json"),
    "pending": Reader(PENDING, _pending, _read_set, WHOLE, _other_pending),
    "thesis set.toml": shipped_set("set.toml", "thesis-chapter-5"),
    "oblique trials.csv": shipped_set("trials.csv", "kharaz-2001-oblique"),
    "CASE.toml": Reader("CASE.toml", lambda: CASE, read_case, CURVE),
    "flow_curve.csv": Reader("flow_curve.csv", CURVE["flow_curve.csv"], read_flow_curve),
    "impact.toml": Reader(
        "impact.toml", lambda: _data("examples", "impact_rod.toml") + IMPACT.encode(), _read_setup
    ),
    "inverse.toml": Reader(
        "inverse.toml", partial(_data, "examples", "inverse_scar.toml"), _read_inverse
    ),
    "law.json": Reader("law.json", _law, _read_law),
    "fetch.toml": Reader(
        "fetch.toml", partial(_data, "data", "recordings", "fetch.toml"), read_catalogue
    ),
    "case's file": of_campaign("case.h5", _broken_seal),
    "case's values": of_campaign("case.h5", tampered),
    "part's values": of_campaign("trial-1.h5", tampered),
}  # fmt: skip
RAW = {name: raw(name) for name in raw_files.FILES}
