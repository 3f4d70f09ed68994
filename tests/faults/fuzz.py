"""Malformed input to every reader: nothing but one line may come of it, soon and in little memory.

`python tests/faults/fuzz.py --inputs 5000` makes that many files from sound ones by a seed (bits,
slices, numbers, types, nesting, sizes), reads each in a child process, and prints for each reader
how many were refused with a line, how many were read, and what else happened: another exception,
the end of the process, more than 20 s, more than 1 GB. Where a number of a TOML file is replaced by
what is none (`true`, "0.01", a date, a list), reading it is a fault as well. `--raw` takes raw
recordings of every kind instead (raw_files.py) and reduces them to numbers and a picture.
"""

import argparse
import importlib.util
import io
import json
import random
import re
import resource
import subprocess
import sys
import tempfile
import time
import traceback
import wave
import zipfile
from collections import Counter
from contextlib import suppress
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
SLOW_S = 20.0
MEMORY_MB = 1000.0

NUMBER = re.compile(rb"(?<![\w.\"])-?\d+\.?\d*(?:[eE][-+]?\d+)?(?![\w.\"])")
NO_NUMBERS = (
    b"true", b'"0.010"', b"[1.0]", b"1979-05-27", b"{ a = 1 }", b"nan", b"inf", b"-inf", b'""',
)  # fmt: skip
ODD_NUMBERS = (
    b"1e400", b"-1e300", b"1e-320", b"-0.0", b"0", b"-1", b"9" * 400, b"9" * 5000, b"1_0", b"0x10",
    b"1e30", b"1e-30", "\uff11\uff12".encode(), b"", b"NaN", b"1,5",
)  # fmt: skip
INSERTS = (
    b"[" * 3000, b"{a=" * 3000, b"\x1b[2J\x1b]0;x\x07", b"\0" * 50, b"\xff\xfe", b"\r", b"\n\n\n",
    b'"', b"'''", b"," * 3000, b"= 1\n", b"a." * 2000 + b"b = 1\n", "\u202e".encode(),
    b"=cmd|' /C'",
)  # fmt: skip


def mutated(content, draw):
    """Return a changed copy and whether it must be refused."""
    kind = draw.choice(("bits", "cut", "slice", "repeat", "insert", "number", "number", "none"))
    data = bytearray(content)
    if kind == "bits":
        for _ in range(draw.choice((1, 1, 3, 20))):
            at = draw.randrange(8 * len(data))
            data[at // 8] ^= 1 << at % 8
    elif kind == "cut":
        del data[draw.randrange(len(data)) :]
    elif kind == "slice":
        at = draw.randrange(len(data))
        del data[at : at + draw.choice((1, 10, 200))]
    elif kind == "repeat":
        at = draw.randrange(len(data))
        piece = data[at : at + draw.choice((1, 30, 300))]
        data[at:at] = piece * draw.choice((1, 10, 1000))
    elif kind == "insert":
        at = draw.randrange(len(data) + 1)
        data[at:at] = draw.choice(INSERTS)
    else:
        found = list(NUMBER.finditer(content))
        if not found:
            return bytes(data), False
        token = draw.choice(found)
        choices = ODD_NUMBERS if kind == "number" else NO_NUMBERS
        data[token.start() : token.end()] = draw.choice(choices)
        return bytes(data), kind == "none"
    return bytes(data), False


# --- sound files and their readers ---


def table_book():
    """The smallest workbook that is one."""
    sheet = "".join(
        f'<row r="{r}"><c r="A{r}"><v>{0.1 * r}</v></c><c r="B{r}"><v>{r}</v></c></row>'
        for r in range(1, 20)
    )
    parts = {
        "[Content_Types].xml": '<Types xmlns="http://schemas.openxmlformats.org/package/2006/'
        'content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-'
        'package.relationships+xml"/><Override PartName="/xl/workbook.xml" ContentType="application'
        '/vnd.openxmlformats-officedocument.spreadsheetml.sheet.main+xml"/><Override PartName="/xl/'
        'worksheets/sheet1.xml" ContentType="application/vnd.openxmlformats-officedocument.'
        'spreadsheetml.worksheet+xml"/></Types>',
        "_rels/.rels": '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/'
        'relationships"><Relationship Id="r1" Type="http://schemas.openxmlformats.org/officeDocument'
        '/2006/relationships/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": '<workbook xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/'
        'main" xmlns:r="http://schemas.openxmlformats.org/officeDocument/2006/relationships">'
        '<sheets><sheet name="S" sheetId="1" r:id="r1"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": '<Relationships xmlns="http://schemas.openxmlformats.org/'
        'package/2006/relationships"><Relationship Id="r1" Type="http://schemas.openxmlformats.org/'
        'officeDocument/2006/relationships/worksheet" Target="worksheets/sheet1.xml"/>'
        "</Relationships>",
        "xl/worksheets/sheet1.xml": '<worksheet xmlns="http://schemas.openxmlformats.org/'
        f'spreadsheetml/2006/main"><sheetData>{sheet}</sheetData></worksheet>',
    }
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as book:  # stored: what is changed in it is seen
        for name, text in parts.items():
            book.writestr(name, text)
    return out.getvalue()


def sound():
    out = io.BytesIO()
    t = np.arange(8000) / 8000.0
    y = sum(np.exp(-((t - k) * 60.0)) * (t > k) * np.sin(6000.0 * t) for k in (0.2, 0.5, 0.75))
    with wave.open(out, "wb") as file:
        file.setparams((1, 2, 8000, 0, "NONE", ""))
        file.writeframes((8000.0 * y).astype("<i2").tobytes())
    return out.getvalue()


def picture(suffix):
    from PIL import Image

    grey = np.full((60, 80), 220, dtype=np.uint8)
    y, x = np.mgrid[:60, :80]
    grey[(x - 40) ** 2 + (y - 10) ** 2 < 30**2] = 30
    out = io.BytesIO()
    Image.fromarray(grey).save(out, suffix)
    return out.getvalue()


def scan_text():
    y, x = np.mgrid[-1:1:20j, -1:1:20j]
    rows = 1e-5 * np.maximum(0.0, 0.3 - x**2 - y**2)
    return "\n".join(",".join(f"{-v:.3e}" for v in row) for row in rows).encode()


def markers():
    t = np.arange(60) / 200.0
    lines = ["time_s," + ",".join(f"{m}_{a}_m" for m in "ABC" for a in "xyz")]
    for s in t:
        z = 0.5 - 4.9 * s**2 if s < 0.2 else 0.3 + 1.2 * (s - 0.2) - 4.9 * (s - 0.2) ** 2
        row = [s, 0, 0, z, 0.1, 0, z, 0, 0.1, z]
        lines.append(",".join(f"{v:.6g}" for v in row))
    return "\n".join(lines).encode()


def c3d():
    import ezc3d

    made = ezc3d.c3d()
    made["parameters"]["POINT"]["RATE"]["value"] = [200]
    made["parameters"]["POINT"]["LABELS"]["value"] = ["A", "B", "C"]
    made["parameters"]["POINT"]["UNITS"]["value"] = ["m"]
    made["data"]["points"] = np.random.default_rng(0).random((4, 3, 40))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.c3d"
        made.write(str(path))
        return path.read_bytes()


def beside(name):
    """Return the module of a script beside this one."""
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, Path(__file__).with_name(f"{name}.py"))
        sys.modules[name] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[name])
    return sys.modules[name]


def campaign():
    faults = beside("disk_faults")
    from dentscope.campaigns import Store

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "c.h5"
        for case in faults.CASES[:2]:
            Store(path).put(case, faults.solved(case))
        return path.read_bytes()


def resealed(content):
    """A campaign file that is damaged and then sealed: what one who means ill would send."""
    from dentscope.campaigns.contents import SEALED_FROM, seal

    return seal(content) + content[SEALED_FROM:]


def force_table():
    t = np.arange(400) / 4e5
    f = 900.0 * np.sin(np.pi * (t - 2e-4) / 4e-4) * ((t > 2e-4) & (t < 6e-4))
    rows = "\n".join(f"{a:.6g},{b:.6g}" for a, b in zip(t, f, strict=True))
    return f"time_s,force_N\n{rows}\n".encode()


def _data(*parts):
    return ROOT.joinpath(*parts).read_bytes()


TARGETS = {
    "set.toml": lambda: _data("data", "recordings", "thesis-chapter-5", "set.toml"),
    "trials.csv": lambda: _data("data", "recordings", "kharaz-2001-oblique", "trials.csv"),
    "CASE.toml": lambda: _data("examples", "case_mild_steel_fast.toml"),
    "impact.toml": lambda: _data("examples", "impact_rod.toml"),
    "inverse.toml": lambda: _data("examples", "inverse_scar.toml"),
    "flow_curve.csv": lambda: _data("examples", "flow_curve.csv"),
    "fetch.toml": lambda: _data("data", "recordings", "fetch.toml")[:3000],
    "campaign.h5": campaign,
    "SHA256SUMS": lambda: _data("data", "campaign", "SHA256SUMS"),
    "table.csv": force_table,
    "table.xlsx": table_book,
    "scan.csv": scan_text,
    "markers.csv": markers,
    "markers.c3d": c3d,
    "sound.wav": sound,
    "tip.png": lambda: picture("PNG"),
    "tip.tif": lambda: picture("TIFF"),
}


def read(name, path):
    """Read a file as the program does; whatever it gives is dropped."""
    if name not in TARGETS:
        beside("raw_files").read(name, path)
        return
    from dentscope.recordings.reduce.kinds import load_kind

    def kind(which, **options):
        load_kind(which).run(path, options, source="options")

    if name in ("set.toml", "trials.csv"):
        from dentscope.recordings import audit
        from dentscope.recordings import read as read_set

        audit(read_set(path.parent))
    elif name == "CASE.toml":
        from dentscope.start.case_file import read_case

        read_case(path)
    elif name == "impact.toml":
        from dentscope.impact.files.setup import read_setup

        read_setup(path)
    elif name == "inverse.toml":
        from dentscope.impact.files.inverse_file import read_inverse

        _rod, rows = read_inverse(path)
        for row in rows:
            assert np.isfinite([row.inferred.duration, row.inferred.mean_force]).all(), "NaN"
    elif name == "flow_curve.csv":
        from dentscope.start.case_file import read_flow_curve

        read_flow_curve(path)
    elif name == "fetch.toml":
        from dentscope.recordings.fetch import read_catalogue

        read_catalogue(path)
    elif name in ("campaign.h5", "SHA256SUMS"):
        from dentscope.campaigns import read_curves

        read_curves(path.parent if name == "SHA256SUMS" else path)
    elif name == "table.csv":
        kind("table", holds="force")
    elif name == "table.xlsx":
        kind("table", holds="height", approach_speed_m_s=1.0)
    elif name == "scan.csv":
        kind("scan", shows="crater", unit="m", step_m=1e-5)
    elif name.startswith("markers"):
        kind("mocap", shape="sphere", tip_radius_m=0.02)
    elif name == "sound.wav":
        kind("sound")
    else:
        kind("tip", pixel_m=1e-5)


def lay_out(name, content, folder):
    """Put a file where its reader looks for it, with what belongs beside it."""
    if name not in TARGETS:
        return beside("raw_files").lay_out(name, content, folder)
    path = folder / name
    if name == "set.toml":
        (folder / "trials.csv").write_bytes(
            _data("data", "recordings", "thesis-chapter-5", "trials.csv")
        )
    if name == "trials.csv":
        (folder / "set.toml").write_bytes(
            _data("data", "recordings", "kharaz-2001-oblique", "set.toml")
        )
    if name == "CASE.toml":
        (folder / "flow_curve.csv").write_bytes(_data("examples", "flow_curve.csv"))
    path.write_bytes(content)
    return path


def targets(raw):
    """Return what makes each sound file."""
    return {k: f[1] for k, f in beside("raw_files").FILES.items()} if raw else TARGETS


def made_inputs(count, seed, *, raw):
    """Yield (number, reader, content, must be refused); the same for the same seed."""
    sound_ones, makers = {}, targets(raw)
    for number in range(count):
        draw = random.Random(f"{seed}-{number}")
        name = list(makers)[number % len(makers)]
        if name not in sound_ones:
            sound_ones[name] = makers[name]()
        if raw:
            content, refuse = beside("raw_files").damaged(name, sound_ones[name], draw, mutated)
        else:
            content, refuse = mutated(sound_ones[name], draw)
        if name == "campaign.h5" and draw.random() < 0.5:
            content = resealed(content)
        yield number, name, content, refuse and name.endswith(".toml")


def child(count, seed, first, last, *, raw):
    """Read inputs first to last; a line of JSON before and after each."""
    from dentscope.core import InputError

    for name, make in targets(raw).items():  # what is imported once is no input's time
        with tempfile.TemporaryDirectory() as folder, suppress(Exception):
            read(name, lay_out(name, make(), Path(folder)))
    for number, name, content, refuse in made_inputs(count, seed, raw=raw):
        if not first <= number < last:
            continue
        tell({"number": number, "reader": name})
        with tempfile.TemporaryDirectory() as folder:
            path = lay_out(name, content, Path(folder))
            started, told, where = time.process_time(), "", ""
            try:
                read(name, path)
                told = "NONSENSE READ" if refuse else "read"
            except InputError:
                told = "refused with a line"
            except BaseException as error:
                told = f"EXCEPTION {type(error).__name__}"
                where = "".join(traceback.format_exception(error)[-3:])
            tell(
                {
                    "told": told, "where": where, "seconds": time.process_time() - started,
                    "MB": peak_mb(),
                    "content": content[:300].decode("latin-1") if told[0].isupper() else "",
                }
            )  # fmt: skip


def peak_mb():
    """Largest memory of this process alone: ru_maxrss keeps what the parent held when it forked."""
    status = Path("/proc/self/status")
    if not status.exists():
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    (line,) = (one for one in status.read_text().splitlines() if one.startswith("VmHWM"))
    return float(line.split()[1]) / 1e3


def tell(line):
    sys.stdout.write(json.dumps(line) + "\n")
    sys.stdout.flush()


def run(count, seed, *, raw=False, slow_s=SLOW_S, say=lambda line: None):
    """Read all inputs in children; return counts by reader, and what went wrong."""
    counts, faults, first, most = {name: Counter() for name in targets(raw)}, [], 0, 0.0
    while first < count:
        command = [sys.executable, __file__, "--child", str(first), "--inputs", str(count)]
        process = subprocess.Popen(
            [*command, "--seed", str(seed), *(["--raw"] if raw else [])],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        last, reader = first - 1, ""
        for line in process.stdout:
            said = json.loads(line)
            if "number" in said:
                last, reader = said["number"], said["reader"]
                continue
            most = max(most, said["MB"])
            told = said["told"] if said["seconds"] < slow_s else "SLOW"
            told = told if said["MB"] < MEMORY_MB else "MEMORY"
            counts[reader][told] += 1
            if told[0].isupper():
                faults.append({"number": last, "reader": reader, **said, "told": told})
                say(f"{last} {reader}: {told} {said['where']}")
            reader = ""
            if last % 500 == 0:
                say(f"{last} of {count}")
        process.wait()
        process.stdout.close()
        if reader:
            counts[reader]["PROCESS ENDED"] += 1
            faults.append({"number": last, "reader": reader, "told": "PROCESS ENDED"})
            say(f"{last} {reader}: PROCESS ENDED {process.returncode}")
        first = last + 1 if last >= first else count
    return counts, faults, most


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--inputs", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--child", type=int)
    parser.add_argument("--raw", action="store_true")
    chosen = parser.parse_args()
    if chosen.child is not None:
        child(chosen.inputs, chosen.seed, chosen.child, chosen.inputs, raw=chosen.raw)
        return
    counts, faults, most = run(
        chosen.inputs, chosen.seed, raw=chosen.raw,
        say=lambda line: sys.stdout.write(line + "\n"),
    )  # fmt: skip
    for name, found in counts.items():
        sys.stdout.write(f"{name}: {dict(found)}\n")
    sys.stdout.write(f"{len(faults)} faults; most memory {most:.0f} MB\n")


if __name__ == "__main__":
    main()
