"""Sound raw files of every kind that `reduce` takes, and damage that recordings meet.

Options, some drawn beside those that a file needs, stand in a line before it.
"""

import io
import json
import tempfile
import zipfile
from pathlib import Path
from typing import Literal, get_args, get_origin

import numpy as np
from made_records import tracker_project, workbook

UNITS = (b"mm", b"um", b"kN", b"furlong", b"m/s2", b"g", b"%", b"V", b"px", b"MPa", b"ms", b"")
TEXTS = (
    "µ\u202e💥", "١٢٣", "\u2212", "1,5", "1.5e", "0x1p3", "1e308", "-1e308", "1e-320", "nan",
    "-inf", "#", '"', ";", "\t", "=1+1", "\x00", "\x1b[2J", "\ufeff", "1" * 400, "1 000", "--",
)  # fmt: skip
ENCODINGS = ("utf-16", "utf-32", "utf-8-sig", "cp1252")


def _table(head, *columns):
    rows = "\n".join(",".join(f"{v:.7g}" for v in row) for row in zip(*columns, strict=True))
    return f"{head}\n{rows}\n".encode()


def _pulse():
    t = np.arange(300) / 4e5
    f = 900.0 * np.sin(np.pi * (t - 2e-4) / 3e-4) * ((t > 2e-4) & (t < 5e-4))
    return t, f + np.random.default_rng(0).normal(0.0, 1.0, t.size)


def bouncing():
    t = np.arange(0.0, 1.3, 0.005)
    z, start, speed = 0.5 - 4.9 * t**2, 0.319, 3.13 * 0.8
    while start < 1.3:
        late = t - start
        z = np.where(late > 0.0, speed * late - 4.9 * late**2, z)
        start, speed = start + 2.0 * speed / 9.8, 0.8 * speed
    return t, z + np.random.default_rng(1).normal(0.0, 2e-4, t.size)


def _markers(end):
    t, z = bouncing()
    places = [c for k in range(3) for c in (0.1 * (k == 1) + 0 * z, 0.1 * (k == 2) + 0 * z, z)]
    if end == ".csv":
        return _table("time_s," + ",".join(f"{m}_{a}_m" for m in "ABC" for a in "xyz"), t, *places)
    import ezc3d

    made = ezc3d.c3d()
    made["parameters"]["POINT"]["RATE"]["value"] = [200]
    made["parameters"]["POINT"]["LABELS"]["value"] = ["A", "B", "C"]
    made["parameters"]["POINT"]["UNITS"]["value"] = ["m"]
    points = np.ones((4, 3, t.size))
    points[:3] = np.array(places).reshape(3, 3, -1).transpose(1, 0, 2)
    made["data"]["points"] = points
    return _written(lambda path: made.write(str(path)), "a.c3d")


def _frames():
    y, x = np.mgrid[:60, :48]
    rows = 50.0 - 10.0 - np.abs(np.arange(16) - 7.4) * 3.0
    discs = [np.clip(10.5 - np.hypot(x - 24.2, y - row), 0.0, 1.0) for row in rows]
    noise = np.random.default_rng(2).normal(0.0, 2.0, (16, 60, 48))
    return np.clip(25.0 + 200.0 * np.array(discs) + noise, 0, 255).astype(np.uint8)


def _written(write, name):
    """The bytes of a file that `write` makes at a path."""
    with tempfile.TemporaryDirectory() as folder:
        write(Path(folder) / name)
        return (Path(folder) / name).read_bytes()


def _video():
    from dentscope.studies.synthetic.clips import write_video

    return _written(lambda path: write_video(_frames(), path), "a.avi")


def _stack():
    import tifffile

    out = io.BytesIO()
    tifffile.imwrite(out, _frames(), photometric="minisblack")
    return out.getvalue()


def _photron():
    return b"""#Camera Information Header
Record Rate(fps) : 1000
Total Frame : 16
Image Width : 48
Image Height : 60
Color Bit : 8
EffectiveBit Depth : 8
EffectiveBit Side : Lower
"""


def _picture(suffix, grey=None):
    from PIL import Image

    if grey is None:
        grey = np.full((60, 80), 220, dtype=np.uint8)
        y, x = np.mgrid[:60, :80]
        grey[(x - 40) ** 2 + (y - 10) ** 2 < 30**2] = 30
    out = io.BytesIO()
    Image.fromarray(grey).save(out, suffix)
    return out.getvalue()


def _crater():
    y, x = np.mgrid[-1:1:48j, -1:1:48j]
    z = -1e-5 * np.maximum(0.0, 0.3 - x**2 - y**2)
    return z + np.random.default_rng(3).normal(0.0, 2e-8, z.shape)


def _grid():
    return "\n".join(",".join(f"{v:.3e}" for v in row) for row in _crater()).encode()


def _surface(end):
    from SurfaceTopography import Topography

    made = Topography(_crater(), physical_sizes=(4.8e-4, 4.8e-4), unit="m")
    return _written(made.to_netcdf if end == ".nc" else made.to_matrix, f"a{end}")


def _sound():
    from scipy.io import wavfile

    rng = np.random.default_rng(2)
    heard = rng.normal(0.0, 20.0, 6000)
    for at in (1000, 2500, 3700, 4660):
        heard[at : at + 200] += 9000.0 * np.exp(-np.arange(200) / 40.0) * rng.normal(size=200)
    out = io.BytesIO()
    wavfile.write(out, 8000, heard.astype(np.int16))
    return out.getvalue()


def _zipped():
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("Raw Data.csv", _table("Time (s),Force (N)", *_pulse()))
        archive.writestr("meta/device.csv", "property,value\n")
    return out.getvalue()


def _tracker():
    _t, z = bouncing()
    return tracker_project(
        {2 * k: (100.0, 200.0 - 500.0 * h) for k, h in enumerate(z[::2])}
    ).encode()


def _tension():
    strain = np.arange(0.0, 2.0, 0.02)
    return _table("strain (%),stress (MPa)", strain, np.minimum(2e3 * strain, 250.0 + 5.0 * strain))


def _book():
    rows = [["time_s", "force_N"], *np.transpose(_pulse()).tolist()]
    return _written(lambda path: workbook(path, rows), "a.xlsx")


def _pressed():
    rng = np.random.default_rng(4)
    load = np.concatenate([np.zeros(40), np.linspace(0.0, 800.0, 150), np.linspace(800.0, 0.0, 90)])
    back = 9.0 * (1.0 - (load[190:] / 800.0) ** 0.7)
    depth = np.concatenate([np.linspace(-5.0, 0.0, 40), 60.0 * load[40:190] / 800.0, 60.0 - back])
    noise = rng.normal(size=(2, load.size))
    return _table("depth_um,load_N", depth + 0.05 * noise[0], load + 0.5 * noise[1])


def _force():
    return _table("time_s,force_N", *_pulse())


_BALL = {"shape": "sphere", "tip_radius_m": 0.02}
_FILM = {"shape": "sphere", "frame_rate_hz": 1000.0}

FILES = {
    # ending of the file, what makes it, kind of reduction, options
    "force": (".csv", _force, "table", {"holds": "force", "mass_kg": 0.1}),
    "volts": (".txt", _force, "table", {"holds": "acceleration", "gain": 3.0}),
    "press": (".csv", _pressed, "press", {}),
    "height": (".csv", lambda: _table("t_s,h_m", *bouncing()), "table", {"holds": "height"}),
    "bounces": (".csv", lambda: b"t (s)\n0.5\n1.0\n1.4\n1.72\n1.98\n2.18\n2.34\n", "table",
                {"holds": "bounces"}),
    "rebounds": (".csv", lambda: b"drop_cm,a,b\n50,20,19\n40,17,18\n30,13,12.5\n", "table",
                 {"holds": "rebounds", "value": "1"}),
    "leeb": (".csv", lambda: b"first,second\n780,775\n782,779\n", "table",
             {"holds": "leeb", "value": "1"}),
    "tension": (".csv", _tension, "table", {"holds": "tension"}),
    "trials": (".csv", lambda: b"impact_speed_mm/s,restitution\n1500,0.6\n2000,0.55\n", "table",
               {"holds": "trials"}),
    "workbook": (".xlsx", _book, "table", {"holds": "force"}),
    "packed": (".zip", _zipped, "table", {"holds": "force"}),
    "tracker": (".trk", _tracker, "table", {"holds": "height", "value": "3"}),
    "markers": (".csv", lambda: _markers(".csv"), "mocap", _BALL),
    "c3d": (".c3d", lambda: _markers(".c3d"), "mocap", _BALL),
    "sound": (".wav", _sound, "sound", {}),
    "grid": (".csv", _grid, "scan", {"shows": "crater", "unit": "m", "step_m": 1e-5}),
    "netcdf": (".nc", lambda: _surface(".nc"), "scan", {"shows": "crater"}),
    "matrix": (".txt", lambda: _surface(".txt"), "scan",
               {"shows": "crater", "unit": "m", "step_m": 1e-5}),
    "video": (".avi", _video, "video", _FILM),
    "stack": (".tif", _stack, "video", _FILM),
    "photron": (".cih", _photron, "video", _FILM),
    "frame": (".png", lambda: _picture("PNG", _frames()[3]), "video", _FILM),
    "png": (".png", lambda: _picture("PNG"), "tip", {"pixel_m": 1e-5}),
    "jpeg": (".jpg", lambda: _picture("JPEG"), "tip", {"pixel_m": 1e-5}),
}  # fmt: skip


def sound(name):
    _end, make, _kind, given = FILES[name]
    return json.dumps(given).encode() + b"\n" + make()


def drawn_options(draw, kind, given):
    """Options of a kind: those given, and now and then another, within what is allowed."""
    from dentscope.reduce.kinds import load_kind

    found = dict(given)
    for name, field in load_kind(kind).options.model_fields.items():
        if name not in found and draw.random() < 0.02:
            found[name] = _option(draw, field.annotation)
    return found


def _option(draw, wanted):
    if get_origin(wanted) is Literal:
        return draw.choice(get_args(wanted))
    if wanted is str or str in get_args(wanted):
        return draw.choice(("1", "3", "99", "force", "A:B", "1=2", "", "mm", "0,1,0,1", "\x1b"))
    if wanted is int or int in get_args(wanted):
        return draw.choice((0, 1, 7, 10**9))
    return draw.choice((0.0, 1.0, 1e-3, 1e-300, 1e300, 10 ** draw.uniform(-9.0, 9.0)))


def damaged(name, content, draw, mutated):
    """Return a changed copy with options of its own, and whether a number was made none."""
    _, _, raw = content.partition(b"\n")
    changed, refuse = _damaged(name, raw, draw, mutated)
    return json.dumps(drawn_options(draw, *FILES[name][2:])).encode() + b"\n" + changed, refuse


def _damaged(name, content, draw, mutated):
    """Change its units, words or encoding, or do what `mutated` does to any file."""
    text = FILES[name][0] in (".csv", ".txt", ".trk", ".cih")
    kind = draw.choice(("units", "words", "encoding", "any", "any") if text else ("any",))
    data = bytearray(content)
    if kind == "units":
        found = [u for u in UNITS if u and u in content] or [b","]
        return bytes(data.replace(draw.choice(found), draw.choice(UNITS))), False
    if kind == "encoding":
        return content.decode().encode(draw.choice(ENCODINGS), errors="replace"), False
    if kind == "words":
        for _ in range(draw.choice((1, 3, 20))):
            at = draw.randrange(len(data))
            data[at : at + draw.randrange(6)] = draw.choice(TEXTS).encode()
        return bytes(data), False
    return mutated(content, draw)


def lay_out(name, content, folder):
    said, _, content = content.partition(b"\n")
    (folder / "options.json").write_bytes(said)
    end = FILES[name][0]
    if name != "frame":
        (folder / f"raw{end}").write_bytes(content)
        if name == "photron":
            (folder / "raw.mraw").write_bytes(_frames().tobytes())
        return folder / f"raw{end}"
    clip = folder / "clip"
    clip.mkdir()
    for k, frame in enumerate(_frames()):
        (clip / f"{k}{end}").write_bytes(content if k == 3 else _picture("PNG", frame))
    return clip


def read(name, path):
    from dentscope.reduce.kinds import load_kind
    from dentscope.reduce.output.record import write_record

    kind, options = FILES[name][2], json.loads((path.parent / "options.json").read_text())
    reduced = load_kind(kind).run(path, options, source="options")
    for trial in reduced.trials:
        for key, value in trial.observables.items():
            assert np.isfinite(value.value), f"{key} is {value.value}"
    write_record(reduced, path.parent / "out", "t", kind=kind, options=options)
