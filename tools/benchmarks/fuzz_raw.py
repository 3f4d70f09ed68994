"""Raw files as instruments and people write them, with legal but extreme numbers and options.

`python tools/benchmarks/fuzz_raw.py --inputs 1000` writes that many files by a seed, no two alike,
and reduces each to numbers, a record and a picture in a child (tests/faults/watched.py): a
traceback, a number that is none, more than 20 s of the processor or more than 1 GB is a fault.
Every 25 files it says how far it is; `--first 500` goes on with file 500, after `--inputs 500`.
Where `fuzz.py --raw` damages sound files, here the grammar is drawn: separators, marks of
decimals, headers, clocks, cells that are no number, exports of trackers, widths and rates of
sounds, sizes and depths of pictures.
"""

import argparse
import io
import json
import sys
import zipfile
from functools import partial
from pathlib import Path
from typing import Literal, get_args, get_origin

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "faults"))
import fuzz
import raw_files
import watched
from readers import Reader

MARKS = ("", "OL", "nan", "-inf", "9.9E37", "******", "#DIV/0!", "n/a", "∞", '"', "1.2.3", "--")
UNITS = ("s", "ms", "N", "kN", "g", "m/s2", "mm", "V", "%", "MPa", "", "furlong", "µs", "1/s", "px")
WORDS = ("time", "Zeit", "force", "Kraft", "X", "a", "height", "Höhe", "load", "strain", "Ch 1", "")


def wave(draw, rng, count, like=()):
    """Numbers of a channel: pulses, bounces, a level, a count, noise, at any size.

    `like` names what a channel usually shows; one in five shows anything.
    """
    like = like if draw.random() < 0.8 else ()
    t = np.linspace(0.0, 1.0, count)
    kind = draw.choice(like or ("pulse", "bounces", "level", "count", "noise", "steps", "square"))
    size = draw.choice(5 * (1.0,) + (1e3, 1e-6, 1e300, 1e-300, -1.0))
    if kind == "ball":
        times, heights = raw_files._bouncing()
        y = np.interp(t * times[-1], times, heights)
    elif kind == "press":
        y = np.interp(t, (0.0, 0.1, 0.6, 0.7, 1.0), (0.0, 0.0, 1.0, 1.0, draw.choice((0.0, 0.5))))
    elif kind == "pulse":
        at, wide = draw.uniform(0.1, 0.8), 10 ** draw.uniform(-2.0, -0.7)
        y = np.sin(np.pi * np.clip((t - at) / wide, 0.0, 1.0))
    elif kind == "bounces":
        y = np.abs(np.sin(np.pi * t * draw.uniform(0.5, 9.0))) * np.exp(-draw.uniform(0.0, 5.0) * t)
    elif kind == "square":
        y = np.sign(np.sin(2.0 * np.pi * t * draw.uniform(0.5, 40.0)))
    else:
        y = {"level": 0.0 * t + 1.0, "count": np.arange(count) + 0.0, "steps": np.round(5.0 * t),
             "noise": rng.normal(size=count)}[kind]  # fmt: skip
    return size * (y + draw.choice((0.0, 0.0, 1e-3, 0.1)) * rng.normal(size=count))


def stamp(draw):
    """How a time is written."""
    return draw.choice((
        lambda t: f"{t:.6f}", lambda t: f"{t:.6f}", lambda t: f"{1e3 * t:g}",
        lambda t: f"12:{int(t // 60) % 60:02d}:{t % 60:09.6f}",
        lambda t: f"2024-02-30T23:59:{t % 60:06.3f}Z", lambda t: f"{-t:.3f}", lambda t: "0.1",
    ))  # fmt: skip


def table(draw, like=("pulse",), rates=(0.0, 6.0), units=UNITS):
    """A table as text: its header, separators, cells and encoding are drawn.

    What stands in it is usually `like` a sound one, so that odd cells and forms reach the numbers.
    """
    rng = np.random.default_rng(draw.randrange(2**32))
    count = draw.choice((0, 1, 3, 25) + 4 * (300, 3000))
    columns = draw.choice((1, 3, 8) + 8 * (2,))
    rate = 10 ** draw.uniform(*rates)
    write = stamp(draw) if draw.random() < 0.3 else "{:.6f}".format
    cells = [[write(k / rate) for k in range(count)]]
    form = draw.choice(("{:.6g}", "{:.3f}", "{:e}", "{:,.2f}", "{!r}"))
    for _ in range(columns - 1):
        cells.append([form.format(float(v)) for v in wave(draw, rng, count, like)])
    for _ in range(draw.choice((0, 0, 0, 0, 1, 30)) if count else 0):
        draw.choice(cells)[draw.randrange(count)] = draw.choice(MARKS)
    comma, between = draw.choice(((".", ","), (".", "\t"), (",", ";"), (",", ","), (".", "  ")))
    quote = draw.choice(("", "", '"'))
    lines = [draw.choice(("# made {}", "Sample Interval,{}", "{}", "Rate={} Hz", "***End {}***"))
             .format(draw.choice(("", "1e-5", "-1", "nan", "1000", 300 * "x")))
             for _ in range(draw.choice((0, 0, 2, 40)))]  # fmt: skip
    names = [f"{draw.choice(WORDS)}{draw.choice((' ({})', '_{}', ' [{}]')).format(u)}"
             for u in (draw.choice(units if draw.random() < 0.8 else UNITS)
                       for _ in range(columns))]  # fmt: skip
    lines += draw.choice(([], [between.join(names)], [between.join(names)] * 2))
    for row in zip(*cells, strict=True):
        lines.append(between.join(f"{quote}{c.replace('.', comma)}{quote}" for c in row))
    text = draw.choice(("\n", "\n", "\r\n", "\r")).join(lines) + draw.choice(("", "\n", "\n\n"))
    return text.encode(draw.choice(("utf-8", "utf-8", "utf-8-sig", "utf-16", "cp1252")), "replace")


def packed(draw):
    """Tables in an archive."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        names = ((), ("0.csv",), ("../a.csv",), ("meta/b.csv", "1.csv"), ("a.csv", "b.csv"))
        for name in draw.choice(names):
            archive.writestr(name, table(draw))
    return out.getvalue()


def book(draw):
    """A workbook whose cells are numbers, words, times, formulas or nothing."""
    import openpyxl

    made = openpyxl.Workbook()
    rng = np.random.default_rng(draw.randrange(2**32))
    values = wave(draw, rng, draw.choice((0, 2, 300, 300, 300)), ("pulse",))
    made.active.append([draw.choice(WORDS), f"{draw.choice(WORDS)} ({draw.choice(('N', *UNITS))})"])
    often = draw.choice((0.0, 0.0, 0.01, 0.3))
    for k, v in enumerate(values):
        odd = draw.random() < often
        made.active.append([k / 1e3, draw.choice(("=A1", "x", None, True, "1,5")) if odd else v])
    out = io.BytesIO()
    made.save(out)
    return out.getvalue()


def markers(draw):
    """Positions of markers as one of the trackers writes them, some not seen."""
    rng = np.random.default_rng(draw.randrange(2**32))
    count, many = draw.choice((1, 20, 200, 200, 200)), draw.choice((1, 3, 5))
    at = np.stack([wave(draw, rng, count, ("level",)) for _ in range(3 * many)], axis=1)
    at[:, 2::3] += wave(draw, rng, count, ("ball",))[:, None]
    names = [draw.choice(("A", "B", "Ball:1", "", "M {}")).format(k) for k in range(many)]
    rows = [[f"{v:.4f}" if rng.random() > 0.02 else "" for v in row] for row in at]
    kind = draw.choice(("plain", "motive", "vicon", "qualisys"))
    if kind == "plain":
        head = ["time_s," + ",".join(f"{n}_{a}_mm" for n in names for a in "xyz")]
        lines = [f"{k / 200}," + ",".join(row) for k, row in enumerate(rows)]
    elif kind == "motive":
        rate = draw.choice(4 * ("240.0",) + ("0", "nan", ""))
        head = [f"Format Version,1.23,Export Frame Rate,{rate},Length Units,Meters", "",
                ",Type" + ",Marker" * 3 * many,
                ",Name," + ",".join(n for n in names for _ in "xyz"),
                ",ID" + ',"A"' * 3 * many, "," + ",Position" * 3 * many,
                "Frame,Time (Seconds)" + ",X,Y,Z" * many]  # fmt: skip
        lines = [f"{k},{k / 240}," + ",".join(row) for k, row in enumerate(rows)]
    elif kind == "vicon":
        head = ["Trajectories", draw.choice(4 * ("250",) + ("-1", "x")), ",," + ",,,".join(names),
                "Frame,Sub Frame" + ",X,Y,Z" * many,
                ",," + ",".join(["mm"] * 3 * many)]  # fmt: skip
        lines = [f"{k + 1},0," + ",".join(row) for k, row in enumerate(rows)]
    else:
        said = draw.choice((count, count, count, 7, -1))
        head = [f"NO_OF_FRAMES\t{said}", f"NO_OF_MARKERS\t{many}",
                f"FREQUENCY\t{draw.choice((100, 100, 100, 0))}", "DATA_INCLUDED\t3D",
                "MARKER_NAMES\t" + "\t".join(names)]  # fmt: skip
        lines = ["\t".join(row) for row in rows]
    return "\n".join(head + lines[: draw.choice((count, count, 3))]).encode()


def sound(draw):
    """A WAV of any width, rate and number of channels."""
    from scipy.io import wavfile

    rng = np.random.default_rng(draw.randrange(2**32))
    channels = draw.choice((1, 1, 2))
    rate = draw.choice((1, 192_000) + 4 * (8000, 44_100))
    if draw.random() < 0.7:  # contacts that come sooner every time
        heard = rng.normal(0.0, 1e-3, 2 * rate)
        at, gap = int(0.2 * rate), draw.uniform(0.02, 0.4) * rate
        while at + 40 < heard.size and gap > 30:
            heard[at : at + 30] += draw.uniform(0.05, 0.9) * rng.normal(size=30)
            at, gap = int(at + gap), draw.choice((0.8, 0.8, 0.8, 1.0, 0.3)) * gap
    else:
        heard = wave(draw, rng, draw.choice((10, 3000, 60_000)))
    heard = np.repeat(np.clip(np.nan_to_num(heard), -1.0, 1.0)[:, None], channels, axis=1)
    kind = draw.choice((np.int16, np.int32, np.uint8, np.float32))
    top = 1.0 if kind is np.float32 else np.iinfo(kind).max
    out = io.BytesIO()
    wavfile.write(out, rate, (top * heard).astype(kind))
    return out.getvalue()


def stack(draw):
    """Frames of any size and depth: a spot that moves, or nothing."""
    import tifffile

    rng = np.random.default_rng(draw.randrange(2**32))
    count, rows = draw.choice((1, 12, 30, 30, 30)), draw.choice((1, 40, 64, 64))
    columns = draw.choice((2, 48, 48, 48))
    y, x = np.mgrid[:rows, :columns]
    place = rows * (0.9 - np.abs(wave(draw, rng, count, ("ball",)))).clip(0.0, 1.0)
    frames = np.array([(9.0 - np.hypot(x - 20, y - r)).clip(0.0, 1.0) for r in place])
    frames = frames * draw.choice((0, 1, 200, 200, 200))
    frames = frames + draw.choice((0.0, 3.0)) * rng.random(frames.shape)
    out = io.BytesIO()
    kind = draw.choice(4 * (np.uint8, np.uint16) + (np.float32, bool))
    tifffile.imwrite(out, frames.astype(kind), photometric="minisblack")
    return out.getvalue()


def photograph(draw):
    """A picture of a round body, of a side, or of nothing."""
    rng = np.random.default_rng(draw.randrange(2**32))
    y, x = np.mgrid[: draw.choice((1, 60, 200, 200)), : draw.choice((1, 80, 150, 150))]
    inside = np.hypot(x - 40, y - draw.choice((0, 10, 10, 20, 1000))) < draw.choice((0, 15, 30, 30))
    inside |= (np.abs(x - 40) < 30) & (y < 10) & (draw.random() < 0.7)
    grey = 200.0 * ~inside + draw.choice((0.0, 2.0, 60.0)) * rng.random(inside.shape)
    return raw_files._picture("PNG", grey.astype(np.uint8))


def surface(draw):
    """A grid of heights, some not seen."""
    rng = np.random.default_rng(draw.randrange(2**32))
    y, x = np.mgrid[-1 : 1 : draw.choice((1, 5, 48, 48, 48)) * 1j,
                    -1 : 1 : draw.choice((2, 40, 40, 40)) * 1j]  # fmt: skip
    deep = draw.choice((0.0, 1e-5, 1e-5, 1e-5, 1e200))
    z = -deep * np.maximum(0.0, draw.choice((0.3, 0.3, 0.3, 2.0)) - x**2 - y**2)
    z = z + draw.choice((0.0, 1e-8, 1e-8, 1e-4)) * rng.normal(size=z.shape)
    z[rng.random(z.shape) < draw.choice((0.0, 0.0, 0.05, 1.0))] = np.nan
    between = draw.choice((",", ",", "\t", ";", " "))
    return "\n".join(between.join(f"{v:.3e}" for v in row) for row in z).encode()


def of_press(draw):
    """Load against depth in a machine's words."""
    return table(draw, ("press",), (0.0, 2.0), ("N", "mm", "um", "kN", ""))


def of_height(draw):
    """Heights of a ball."""
    return table(draw, ("ball",), (2.3, 2.5), ("mm", "m", ""))


FILES = {
    # ending, what writes it, kind, options that are always given
    "table": (".csv", table, "table", {}),
    "text": (".lvm", table, "table", {"holds": "force", "value_unit": "N"}),
    "height": (".txt", of_height, "table", {"holds": "height", "value_unit": "m"}),
    "archive": (".zip", packed, "table", {"holds": "force", "value_unit": "N"}),
    "book": (".xlsx", book, "table", {"holds": "force", "value_unit": "N"}),
    "press": (".csv", of_press, "press", {"depth": "1", "load": "2", "load_unit": "N",
                                          "depth_unit": "um"}),
    "markers": (".csv", markers, "mocap", {"shape": "sphere", "tip_radius_m": 0.02}),
    "tsv": (".tsv", markers, "mocap", {"shape": "sphere", "tip_radius_m": 0.02}),
    "sound": (".wav", sound, "sound", {}),
    "stack": (".tif", stack, "video", {"frame_rate_hz": 100.0, "shape": "sphere"}),
    "tip": (".png", photograph, "tip", {"pixel_m": 1e-5}),
    "grid": (".csv", surface, "scan", {"unit": "m", "step_m": 1e-5}),
}  # fmt: skip


def options(draw, kind, given):
    """Options of a kind, each within what is allowed."""
    from dentscope.reduce.kinds import load_kind

    found = dict(given)
    for name, field in load_kind(kind).options.model_fields.items():
        if name in found or not (field.is_required() or draw.random() < 0.02):
            continue
        found[name] = _option(draw, field.annotation)
    return found


def _option(draw, wanted):
    if get_origin(wanted) is Literal:
        return draw.choice(get_args(wanted))
    if wanted is str or str in get_args(wanted):
        return draw.choice(
            ("1", "2", "3", "99", "force", "A:B", "1=2", "", "mm", "0,1,0,1", "\x1b")
        )
    if wanted is int or int in get_args(wanted):
        return draw.choice((0, 1, 7, 10**9))
    return draw.choice((0.0, 1.0, 1e-3, 1e-300, 1e300, 10 ** draw.uniform(-9.0, 9.0)))


def written(name, _content, draw):
    """A file of a kind, its options in a line before it."""
    _end, write, kind, given = FILES[name]
    line = json.dumps(options(draw, kind, given)).encode()
    return line + b"\n" + write(draw), False


def lay_out(name, content, folder):
    """Put a file and its options into a folder."""
    said, _, raw = content.partition(b"\n")
    (folder / "options.json").write_bytes(said)
    path = folder / f"raw{FILES[name][0]}"
    path.write_bytes(raw)
    return path


def read(name, path):
    """Reduce a file with the options beside it."""
    given = json.loads((path.parent / "options.json").read_text())
    raw_files.reduce_whole(FILES[name][2], path, given)


SOUND = dict(
    table="force", text="force", height="height", archive="packed", book="workbook", press="press",
    markers="markers", tsv="markers", sound="sound", stack="stack", tip="png", grid="grid",
)  # fmt: skip
"""What is read first, of `raw_files.FILES`: it imports and compiles."""


def sound_file(name):
    """A file without a fault, its options in a line before it."""
    _end, make, _kind, given = raw_files.FILES[SOUND[name]]
    return json.dumps(given).encode() + b"\n" + make()


READERS = {
    name: Reader(name, partial(sound_file, name), partial(read, name), {}, partial(written, name),
                 partial(lay_out, name))
    for name in FILES
}  # fmt: skip


def run(count, seed, *, first=0, say=lambda line: None):
    """Read all files; return what `watched.run` returns."""
    return watched.run(count, seed, script=__file__, first=first, say=say, every=25)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--inputs", type=int, default=1000, help="one after the last file")
    parser.add_argument("--first", type=int, default=0, help="number of the first file")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--child", type=int)
    chosen = parser.parse_args()
    if chosen.child is not None:
        fuzz.child(chosen.seed, chosen.child, chosen.inputs, READERS)
        return

    def say(line):
        sys.stdout.write(f"{line}\n")
        sys.stdout.flush()

    counts, faults, most, longest = run(chosen.inputs, chosen.seed, first=chosen.first, say=say)
    for name, found in counts.items():
        say(f"{name}: {dict(found)}, {longest[name]:.1f} s at most")
    say(f"{len(faults)} faults; most memory {most:.0f} MB")


if __name__ == "__main__":
    main()
