"""Every call that changes a file fails in turn, and power is lost after each; what is left?

`python tests/faults/disk_faults.py` prints the counts for all writers below. A loss of power is
played on a model of a disk: what was written and not synchronised is lost, torn at a sector, or
there though its name is not; names come and go with the synchronisation of their folder.
"""

import argparse
import errno
import json
import os
import shutil
import sys
import tempfile
from collections import Counter
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path
from unittest import mock

import numpy as np
from dentscope.campaigns import Design, Store, publish, read_published
from dentscope.core import InputError
from dentscope.core.disk import Disk
from dentscope.core.output import write_figure, write_file, write_files
from made_cases import case_of, solution_of

CALLS = ("create", "write", "sync", "rename", "remove", "make_folder", "sync_folder")
_SECTOR = 512


class Faulty:
    def __init__(self, at, code):
        self.at, self.code, self.calls, self.hit = at, code, 0, ""

    def __call__(self, name, real):
        def call(disk, *arguments):
            self.calls += name != "close"
            if self.calls != self.at or self.hit or name == "close":
                return real(disk, *arguments)
            self.hit = name
            if name == "write":  # a part of it reaches the disk
                file, content = arguments
                real(disk, file, content[: len(content) // 2])
            raise OSError(self.code, os.strerror(self.code))

        return call


@dataclass
class File:
    safe: bytes
    shown: bytes


class Powered:
    """The real disk, and a model of what a loss of power after the last call would leave."""

    def __init__(self, folder, at):
        self.at, self.calls, self.open = at, 0, {}
        found = {p: p.read_bytes() for p in folder.rglob("*") if p.is_file()}
        self.shown = {path: File(content, content) for path, content in found.items()}
        self.safe = dict(self.shown)
        self.folders = {p for p in folder.rglob("*") if p.is_dir()} | {folder}
        self.safe_folders = set(self.folders)

    def __call__(self, name, real):
        def call(disk, *arguments):
            answer = real(disk, *arguments)
            if name != "close":
                getattr(self, f"_{name}")(answer, *arguments)
                self.calls += 1
                if self.calls == self.at:
                    raise PowerLost
            return answer

        return call

    def _create(self, file, path, *_):
        self.shown[path] = self.open[file] = File(b"", b"")

    def _write(self, _, file, content):
        self.open[file].shown += bytes(content)

    def _sync(self, _, file):
        self.open[file].safe = self.open[file].shown

    def _rename(self, _, old, new):
        self.shown[new] = self.shown.pop(old)

    def _remove(self, _, path):
        self.shown.pop(path, None)

    def _make_folder(self, _, path):
        self.folders.add(path)

    def _sync_folder(self, _, folder):
        self.safe = {p: f for p, f in self.safe.items() if p.parent != folder}
        self.safe |= {p: f for p, f in self.shown.items() if p.parent == folder}
        self.safe_folders |= {p for p in self.folders if p.parent == folder}

    def left(self):
        """What may lie on the disk afterwards: (words, folders, contents by path)."""
        safe, shown = self.safe, self.shown
        yield "synchronised only", self.safe_folders, {p: f.safe for p, f in safe.items()}
        yield "everything", self.folders, {p: f.shown for p, f in shown.items()}
        yield "names before contents", self.folders, {p: f.safe for p, f in shown.items()}
        yield "contents before names", self.safe_folders, {p: f.shown for p, f in safe.items()}
        yield "torn", self.folders, {p: torn(f) for p, f in shown.items()}


class PowerLost(BaseException):
    """The process is gone."""


def torn(file):
    """Every other sector of what was not synchronised."""
    if file.safe == file.shown:
        return file.safe
    out = bytearray(file.shown)
    for at in range(0, len(out), 2 * _SECTOR):
        piece = file.safe[at : at + _SECTOR].ljust(min(_SECTOR, len(out) - at), b"\0")
        out[at : at + _SECTOR] = piece
    return bytes(out)


@contextmanager
def patched(hook):
    with ExitStack() as all_of_them:
        for name in (*CALLS, "close"):
            called = hook(name, getattr(Disk, name))
            all_of_them.enter_context(mock.patch.object(Disk, name, called))
        yield


@dataclass
class Writer:
    """What is tried: how a folder begins, what is done to it, what must hold at any moment."""

    name: str
    begin: object
    act: object
    check: object


def tried(writer, folder, *, every):
    """Lay the beginning out anew for each call, or each few, that something happens to."""
    for at in count(1, every):
        place = folder / str(at)
        place.mkdir(parents=True)
        writer.begin(place)
        yield at, place
        shutil.rmtree(place)


def faults(writer, folder, *, codes=(errno.ENOSPC, errno.EIO), every=1):
    """Let each call (or each few) fail in turn; return how often each did."""
    counts = Counter()
    for code in codes:
        for at, place in tried(writer, folder / str(code), every=every):
            fault, refused = Faulty(at, code), None
            with patched(fault):
                try:
                    writer.act(place)
                except InputError as error:
                    refused = error
            if not fault.hit:
                assert refused is None
                break
            assert refused is None or "\n" not in str(refused)
            counts[f"{fault.hit} failed"] += 1
            writer.check(place)
            writer.act(place)  # with room again
            assert writer.check(place) == "new"
    return counts


def losses(writer, folder, *, every=1):
    """Lose power after each call in turn; return how often each state of the disk was looked at."""
    counts = Counter()
    for at, place in tried(writer, folder, every=every):
        power, lost = Powered(place, at), False
        with patched(power):
            try:
                writer.act(place)
            except PowerLost:
                lost = True
        for file in power.open:
            with suppress(OSError):  # closed before
                os.close(file)
        for words, folders, contents in list(power.left()):
            _lay_out(place, folders, contents)
            writer.check(place)
            writer.act(place)  # the next run
            assert writer.check(place) == "new", (writer.name, at, words)
            counts["power lost: " + words] += 1
        if not lost:
            return counts


def _lay_out(place, folders, contents):
    shutil.rmtree(place)
    for path in sorted(folders):
        path.mkdir(parents=True, exist_ok=True)
    for path, content in contents.items():
        if path.parent.is_dir():
            path.write_bytes(content)


# --- writers ---


def solved(case):
    depth = np.array(case.depths)
    return solution_of(case, line=depth, force=case.pair.sphere.Sy * depth)


CASES = tuple(case_of(f"c{i}", Sy=4e8 + 1e6 * i, n_depths=12) for i in range(4))
DESIGN = Design("trial", "", lambda: CASES)


def put_writer(name, *others, failed=False):
    """The fourth case into a run: of others, of none yet, or of its own failure."""

    def begin(place):
        for case in others:
            Store(place / "out" / "run").put(case, solved(case))
        if failed:
            Store(place / "out" / "run").put(CASES[3], None, message="lost")

    def act(place):
        Store(place / "out" / "run").put(CASES[3], solved(CASES[3]))

    def check(place):
        records = Store(place / "out" / "run").read_all()
        found = {r.id: r for r in records}
        assert len(found) == len(records)
        for case in others:
            assert np.array_equal(found[case.id].curve["force"], solved(case).loading.force)
        mine = found.get(CASES[3].id)
        assert (mine.status == "done" or mine.message == "lost") if mine else not failed
        return "new" if mine and mine.status == "done" else "old"

    return Writer(name, begin, act, check)


def publish_writer(folder):
    source, older = folder / "source", folder / "older"
    for case in CASES:
        Store(source).put(case, solved(case))
    publish(replace(DESIGN, name="first", make=lambda: CASES[:2]), source, older)

    def begin(place):
        shutil.copytree(older, place / "data")

    def act(place):
        published = {r.id for r in read_published(place / "data")}
        if CASES[3].id not in published:
            publish(replace(DESIGN, make=lambda: CASES[2:]), source, place / "data")

    def check(place):
        found = {r.case.name for r in read_published(place / "data")}
        assert found in ({"c0", "c1"}, {"c0", "c1", "c2", "c3"})
        whole = len(found) == 4
        if whole:
            assert "trial-1.h5" in (place / "data" / "PARTS.md").read_text()
        return "new" if whole else "old"

    return Writer("publish", begin, act, check)


def reduced(place, speed):
    from dentscope.reduce.measured import Measured, Trial
    from dentscope.reduce.reduced import Reduced

    raw = place / "raw.csv"
    if not raw.exists():
        raw.write_text(f"1,{speed}\n")
    line = np.linspace(0.0, 1e-3, 40)
    trial = Trial(
        observables={"restitution": Measured(speed, 0.01)},
        trace={"time_s": line, "force_N": 1e3 * line},
    )  # fmt: skip
    return Reduced(
        source=raw, trials=(trial,), values={"restitution": Measured(speed, 0.01)}, notes=(),
        draw=lambda path: write_file(path, b"picture"),
    )  # fmt: skip


def into_writer(folder):
    """A reduction into a set that has trials already."""
    from dentscope.recordings import read
    from dentscope.recordings.template import write_template
    from dentscope.reduce.output.into_set import store
    from dentscope.reduce.output.row import Row

    older = folder / "set"
    write_template(older, shape="sphere")

    def add(place, name, value):
        row = Row(trial=name, impact_speed_m_s=1.0, spot=name)
        store(reduced(place.parent, value), place, row, kind="table", options={})

    add(older, "first", 0.61)

    def begin(place):
        shutil.copytree(older, place / "set")
        reduced(place, 0.5)

    def act(place):
        add(place / "set", "second", 0.62)

    def check(place):
        found = read(place / "set", unfinished=True)
        values = dict(zip(found.trials.trial, found.values("restitution"), strict=True))
        assert values["first"] == 0.61
        assert values.get("second", 0.62) == 0.62
        assert set(found.traces) >= {name for name in values if name != "T01"}
        record = place / "set" / "reduced" / "second-table.json"
        if record.exists():
            json.loads(record.read_text())
        return "new" if "second" in values else "old"

    return Writer("reduce --into", begin, act, check)


def publish_fit_writer(folder):
    """Coefficients, their page and its pictures in place of older ones."""
    from dentscope.cli import fit as fit_command
    from dentscope.fitting.coefficients import write_coefficients
    from dentscope.models import coefficients
    from dentscope.studies.closed_form.page import published_section

    old = json.loads(coefficients.COEFFICIENTS_FILE.read_text())
    new = json.loads(json.dumps(old))
    new["domain"]["combinations"] += 1
    page = fit_command._PAGE.read_text()
    out = folder / "out"
    for name in ("errors", "maps"):
        write_file(out / f"{name}.png", b"new picture")

    def begin(place):
        (place / "docs").mkdir()
        (place / "docs" / "closed-form.md").write_text(page)
        write_coefficients(old, place / "fitted.json")

    def act(place):
        with (
            mock.patch.object(coefficients, "COEFFICIENTS_FILE", place / "fitted.json"),
            mock.patch.object(fit_command, "_PAGE", place / "docs" / "closed-form.md"),
        ):
            fit_command._publish(new, out)

    section = published_section(new)

    def check(place):
        found = json.loads((place / "fitted.json").read_text())
        text = (place / "docs" / "closed-form.md").read_text()
        assert found in (old, new)
        assert text == page or section in text
        pictures = place / "docs" / "pictures"
        for path in pictures.glob("*.png") if pictures.exists() else ():
            assert path.read_bytes() == b"new picture"
        return "new" if found == new and section in text else "old"

    return Writer("fit --publish", begin, act, check)


def report_writer():
    from dentscope.dynamics.columns import Impacts
    from matplotlib.figure import Figure

    found = Impacts({"impact_speed_m_s": np.linspace(1.0, 2.0, 500), "restitution": np.ones(500)})
    figure = Figure()
    figure.subplots().plot(found["impact_speed_m_s"])

    def write(folder):
        found.to_csv(folder / "sweep.csv")
        found.to_parquet(folder / "sweep.parquet")
        write_figure(figure, folder / "sweep.png", dpi=40)

    with tempfile.TemporaryDirectory() as place:
        write(Path(place))
        whole = {path.name: path.read_bytes() for path in Path(place).iterdir()}

    def check(place):
        folder = place / "out"
        # a draft that a loss of power left is hidden and bears no name of ours
        there = {p.name: p.read_bytes() for p in folder.glob("[!.]*")} if folder.exists() else {}
        assert all(whole[name] == content for name, content in there.items())
        return "new" if there.keys() == whole.keys() else "old"

    return Writer("report files", lambda place: None, lambda place: write(place / "out"), check)


def together_writer():
    """Files that belong together: all or none, whatever happens."""

    def begin(place):
        write_files(place / "set", {"a": b"1" * 5000, "b/c": "1", "d": "1"})

    def act(place):
        write_files(place / "set", {"a": b"2" * 5000, "b/c": "2", "d": "2"})

    def check(place):
        from dentscope.core.output import finish

        finish(place / "set")
        found = {(place / "set" / name).read_text()[0] for name in ("a", "b/c", "d")}
        assert len(found) == 1
        return "new" if found == {"2"} else "old"

    return Writer("files together", begin, act, check)


def writers(folder):
    folder.mkdir(parents=True, exist_ok=True)
    return {
        "put": lambda: put_writer("put", *CASES[:3]),
        "put, new run": lambda: put_writer("put, new run"),
        "put, tried again": lambda: put_writer("put, tried again", failed=True),
        "publish": lambda: publish_writer(folder),
        "reduce --into": lambda: into_writer(folder),
        "fit --publish": lambda: publish_fit_writer(folder),
        "report files": report_writer,
        "files together": together_writer,
    }


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--only", default="")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for name, make in writers(folder / "ready").items():
            if chosen.only in name:
                writer, here = make(), folder / name.replace(" ", "-")
                found = faults(writer, here / "faults") + losses(writer, here / "losses")
                sys.stdout.write(f"{name}: {dict(found)}\n")
                sys.stdout.flush()


if __name__ == "__main__":
    main()
