"""A run: identity of cases, resuming, damage, full disks, death of workers and coordinator."""

import errno
import io
import json
import math
import multiprocessing
import operator
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace

import h5py
import made_cases
import meshio
import numpy as np
import pytest
from dentscope import fem
from dentscope.campaigns import (
    DESIGNS,
    Case,
    Design,
    Share,
    Store,
    case_file,
    contents,
    distinct_cases,
    read_curves,
    run_design,
    status_of,
    workers,
)
from dentscope.campaigns.executor import Ended
from dentscope.campaigns.workers import answers
from dentscope.core import COMPLETED, Ending, InputError, Outcome
from dentscope.core.flow import Flow, Heating, Rate, swift
from dentscope.core.output import cannot_write
from dentscope.fem import Profile, Snapshot
from made_cases import case_of as case
from made_cases import solution_of as solution


class FakeExecutor:
    workers = 1

    def __init__(self, outcome=COMPLETED):
        self.computed = []
        self.outcome = outcome

    def run(self, cases, *, time_limit_s):
        for key, item in cases.items():
            self.computed.append(key)
            yield Ended(key, solution(item, self.outcome))


def design(n=5):
    made = tuple(case(f"case-{i}", Sy=4e8 + 1e7 * i) for i in range(n))
    return Design("test", "", lambda: made)


def ran(path, n=5, executor=None, **how):
    return run_design(design(n), path, executor=executor or FakeExecutor(), time_limit_s=1.0, **how)


def test_a_case_is_its_dimensionless_groups():
    assert case().id == case(scale=7.0, R=3.0).id
    assert case().id != case(Sy=5.001e8).id
    finer = replace(case(), accuracy=fem.Accuracy.quick())
    assert finer.id != case().id


def flowing(scale=1.0, R=1e-3, speed=5.0, **changes):
    """A case whose flat hardens, feels the rate and its heat; all stresses, times, sizes scaled."""
    laws = {"K": 6e8 * scale, "D": 4e3 * speed / (5.0 * R / 1e-3)} | changes
    flow = Flow(
        swift(Sy=3e8 * scale, K=laws["K"], n=0.2),
        Rate("cowper-symonds", laws["D"], 5.0),
        Heating(0.9, 3.6e6 * scale, 1200.0),
    )
    plain = case(scale=scale, R=R)
    metals = replace(plain.pair, flat=plain.pair.flat.with_(flow=flow))
    return replace(plain, problem=replace(plain.problem, pair=metals, speeds=((0.0, speed),)))


def test_a_flow_law_belongs_to_the_case_without_its_units():
    one = flowing()
    assert one.id != case().id
    assert one.id == flowing(scale=7.0, R=3.0, speed=11.0).id
    assert one.id != flowing(K=6.1e8).id
    assert one.id != flowing(D=4.1e3).id
    assert Case.from_specification(json.loads(json.dumps(one.specification()))) == one


def test_the_smoke_design_has_twelve_distinct_cases_of_three_pairs():
    cases = distinct_cases(DESIGNS["smoke"])
    assert len(cases) == 12
    ratios = sorted({round(c.pair.Sy_ratio, 6) for c in cases.values()})
    assert ratios == [0.1, 1.0, 1.5, 10.0]
    assert len({round(c.pair.E_reduced / c.pair.Sy_min) for c in cases.values()}) == 3
    assert min(c.depths[-1] for c in cases.values()) >= 0.04


def test_a_second_run_computes_nothing(tmp_path):
    path, first, second = tmp_path / "run", FakeExecutor(), FakeExecutor()
    status = ran(path, executor=first)
    assert (status.designed, status.done, status.failed, status.missing) == (5, 5, 0, 0)
    ran(path, executor=second)
    assert (len(first.computed), second.computed) == (5, [])
    record = read_curves(path)[0]
    assert record.curve["force"] == pytest.approx(np.linspace(1.0, 2.0, 4))
    assert record.case.id == record.id


def test_a_failed_case_is_stored_with_its_reason_and_retried_on_demand(tmp_path):
    path = tmp_path / "run"
    failing = FakeExecutor(Outcome(Ending.NOT_CONVERGED, "stuck at 0.003.", "Refine."))
    status = ran(path, 2, failing)
    assert (status.done, status.failed) == (0, 2)
    assert "stuck at 0.003" in Store(path).read_all()[0].message
    again = FakeExecutor()
    ran(path, 2, again, again=frozenset({"failed"}))
    assert len(again.computed) == 2
    assert status_of(design(2), Store(path)).done == 2
    # the second try was finer, and the case is still the one that was designed
    record = read_curves(path)[0]
    assert record.id == record.case.id
    assert record.accuracy["step_ratio"] < record.case.accuracy.step_ratio


def test_profiles_are_kept_out_to_twice_the_contact_radius(tmp_path):
    one = case()
    assert len(one.problem.profiles) == 4
    assert set(one.problem.profiles) <= set(one.depths)
    r = np.linspace(0.0, 9.0, 19)
    made = tuple(Profile(d, r, r - d, 2.0 * r, r[:10], -r[:10]) for d in one.problem.profiles)
    Store(tmp_path / "run").put(one, replace(solution(one), profiles=made))
    kept = read_curves(tmp_path / "run")[0].profiles
    # the stand-in's largest contact radius is 2, so that the surface ends with the node at 4
    assert kept["depth"] == pytest.approx(one.problem.profiles, rel=1e-6)
    assert kept["sphere_z"] == pytest.approx(
        np.array([r[:9] - d for d in one.problem.profiles]), rel=1e-6, abs=1e-6
    )
    assert kept["flat_z"].shape == (4, 9)


def snapshot(depth):
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    one, line = np.array([3e8]), np.linspace(0.0, 1.0, 3)
    return Snapshot(
        depth=depth, points=corners, quads=np.array([[0, 1, 2, 3]]), n_sphere_quads=1,
        displacement=0.1 * corners, von_mises=one, plastic_strain=one, mean_stress=one,
        stress=np.full((1, 4), 2.0), profile=Profile(depth, line, line, line, line, line),
    )  # fmt: skip


def test_fields_lie_beside_the_file_and_belong_to_the_case(tmp_path, monkeypatch):
    plain = case()
    chosen = replace(plain, problem=replace(plain.problem, snapshots=(plain.depths[1],)))
    assert chosen.id != plain.id
    assert Case.from_specification(chosen.specification()) == chosen
    states = (snapshot(chosen.depths[1]),)
    Store(tmp_path / "run").put(chosen, replace(solution(chosen), snapshots=states))
    [file] = (tmp_path / "run" / "fields").glob(f"{chosen.id[:16]}-*.vtu")
    mesh = meshio.read(file)
    assert mesh.cell_data["von_mises_Pa"][0] == pytest.approx([3e8])
    assert mesh.points[2, :2] == pytest.approx([1.1, 1.1])

    # where there is no room for them the case is not stored, and nothing half written stays
    def full(_, path):
        raise cannot_write(OSError(errno.ENOSPC, "No space left on device"), path)

    monkeypatch.setattr(case_file, "write_vtu", full)
    with pytest.raises(InputError, match="the disk is full; all completed cases are kept"):
        Store(tmp_path / "full").put(chosen, replace(solution(chosen), snapshots=states))
    assert not (tmp_path / "full").exists()


def test_results_of_another_numerics_version_do_not_come_twice(tmp_path, monkeypatch):
    path = tmp_path / "run"
    monkeypatch.setattr(fem, "NUMERICS_VERSION", -1)
    ran(path, 3)
    old = {record.id for record in read_curves(path)}
    monkeypatch.undo()
    assert {record.id for record in read_curves(path)} == old
    ran(path, 2)
    assert {record.id for record in read_curves(path)} == set(distinct_cases(design(2)))


def test_runs_that_share_a_folder_compute_each_case_once(tmp_path):
    path, first, second = tmp_path / "run", FakeExecutor(), FakeExecutor()
    counts = ran(path, executor=first, share=Share(1, 2))
    assert (counts.done, counts.missing) == (3, 2)
    ran(path, executor=second, share=Share(2, 2))
    assert sorted(first.computed + second.computed) == sorted(distinct_cases(design()))
    assert status_of(design(), Store(path)).done == 5


def test_a_completed_case_is_never_replaced_by_a_failed_one(tmp_path):
    store, one = Store(tmp_path), case()
    store.put(one, None, message="lost")
    assert store.statuses() == {one.id: "failed"}
    store.put(one, solution(one))
    store.put(one, None, message="lost")
    assert store.statuses() == {one.id: "done"}
    [file] = store.files()
    assert file == tmp_path / "cases" / one.id[:2] / f"{one.id}.h5"
    # a loss of power may leave both
    file.with_name(f"{one.id}.failed.h5").write_bytes(b"")
    assert [record.status for record in store.read_all()] == ["done"]


def files_of(folder):
    return {p: p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def flipped(image):
    image = bytearray(image)
    image[len(image) // 2] ^= 8
    return image


def another_format(_):
    with h5py.File(stream := io.BytesIO(), "w") as file:
        file.attrs["format"] = "something else"
    return stream.getvalue()


@pytest.mark.parametrize(
    "damage",
    [lambda image: image[:900], lambda _: b"nothing", another_format, flipped, None],
    ids=["truncated", "text", "other", "one bit", "another case"],
)
def test_a_damaged_case_is_reported_and_left_alone(tmp_path, damage):
    ran(tmp_path, 2)
    path, other = Store(tmp_path).files()
    path.write_bytes(damage(path.read_bytes()) if damage else other.read_bytes())
    before = files_of(tmp_path)
    for read in (read_curves, lambda folder: Store(folder).summaries()):
        with pytest.raises(InputError, match=path.name):
            read(tmp_path)
    ran(tmp_path, 2)
    assert files_of(tmp_path) == before


def without_forces(path, change=lambda *_: None):
    """Take the forces out of a sealed file, change it, and seal it as one who knows how."""
    with contents.open_image(path.read_bytes()) as old, contents.new_image() as new:
        for name in old:
            old.copy(name, new.file)
        for name, value in old.attrs.items():
            new.file.attrs[name] = value
        del new.file["loading/force"]
        change(new.file, path)
    path.write_bytes(new.sealed)


def test_a_missing_dataset_names_itself(tmp_path):
    ran(tmp_path, 1)
    without_forces(*Store(tmp_path).files())
    with pytest.raises(InputError, match="loading/force"):
        read_curves(tmp_path)


def outside(cases, path):
    path.with_name("raw").write_bytes(b"\1" * 32)
    raw = [(str(path.with_name("raw")), 0, 32)]
    cases.create_dataset("loading/force", (4,), "f8", external=raw)


def linked(cases, path):
    cases["loading/force"] = h5py.ExternalLink(str(path.with_name("other.h5")), "/x")


def soft(cases, _):
    cases["loading/force"] = h5py.SoftLink("/loading")


@pytest.mark.parametrize(
    "trick",
    [linked, soft, outside,
     lambda c, _: c.create_dataset("loading/force", data=[c.ref] * 4, dtype=h5py.ref_dtype),
     lambda c, _: c.create_dataset("loading/force", (10**12,), "f8", chunks=(10**6,)),
     lambda c, _: c.create_dataset("loading/force", data=np.zeros(200_000), compression="gzip")],
    ids=["linked", "soft", "outside", "referring", "absurd", "bomb"],
)  # fmt: skip
def test_what_leads_elsewhere_or_claims_too_much_is_refused(tmp_path, trick, monkeypatch):
    monkeypatch.setattr(contents, "_MOST_DATA", 1_000_000)
    ran(tmp_path, 1)
    [path] = Store(tmp_path).files()
    with h5py.File(path.with_name("other.h5"), "w") as other:
        other["x"] = np.ones(4)
    without_forces(path, trick)
    with pytest.raises(InputError, match=r"force (is a link|is of kind|lies in|claims)"):
        Store(tmp_path).read(path.name[:64])


def test_a_damaged_case_is_set_aside_and_computed_again(tmp_path):
    ran(tmp_path, 4)
    whole = {record.id: record for record in read_curves(tmp_path)}
    hit = Store(tmp_path).files()[0]
    image = bytearray(hit.read_bytes())
    image[-100] ^= 1
    hit.write_bytes(image)
    with pytest.raises(InputError, match=f"campaign repair --out {tmp_path}`"):
        read_curves(tmp_path)
    kept, lost = Store(tmp_path).repair()
    assert kept == 3
    assert [line.split(":")[0] for line in lost] == [min(whole)[:12]]
    found = {record.id: record for record in read_curves(tmp_path)}
    assert set(found) == set(whole) - {min(whole)}
    assert hit.with_name(f"{hit.name}.damaged").read_bytes() == bytes(image)
    assert ran(tmp_path, 4).done == 4


def test_a_stray_file_among_the_cases_is_passed_over_with_a_word(tmp_path, prints):
    ran(tmp_path, 2)
    first = Store(tmp_path).files()[0]
    strays = [first.with_name(n) for n in ("zz.h5", f"{first.stem} (1).h5")]
    for path in strays:
        path.write_bytes(first.read_bytes())
    assert len(Store(tmp_path).read_all()) == 2
    told = prints("campaign", "status", "--out", tmp_path)
    assert all(f"{path}: passed over" in told for path in strays)


@pytest.mark.fe
def test_a_dying_worker_costs_no_case(tmp_path):
    from dentscope.campaigns.executor import LocalExecutor

    cases = distinct_cases(design(3))
    killed, ended = [], []
    for item in LocalExecutor(workers=2).run(cases, time_limit_s=600.0):
        for child in multiprocessing.active_children()[: not killed]:
            os.kill(child.pid, signal.SIGKILL)
            killed.append(child.pid)
        ended.append(item.id)
        assert item.solution is not None, item.message
    assert killed
    assert sorted(ended) == sorted(cases)


MADE = os.path.dirname(made_cases.__file__)

# the product's store and main path with a solver that takes no time: writing is what is tested
WRITER = """
import resource, signal, sys, time
from pathlib import Path
import numpy as np
from dentscope.campaigns import Design, run_design
from dentscope.campaigns.executor import Ended
sys.path.append(sys.argv.pop(1))
from made_cases import case_of, solution_of

if len(sys.argv) > 4:
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[4]), resource.RLIM_INFINITY))

def made():
    return tuple(case_of(f"c{i}", Sy=4e8 + 1e5 * i) for i in range(int(sys.argv[2])))

class Quick:
    workers = 1
    def run(self, cases, *, time_limit_s):
        for key, case in cases.items():
            line = np.random.default_rng(0).random(int(sys.argv[3]))
            yield Ended(key, solution_of(case, line=line))

try:
    run_design(Design("d", "", made), Path(sys.argv[1]), executor=Quick(), time_limit_s=1.0,
               report=lambda step: print("STORED", step.case.name, flush=True))
except Exception as error:
    print(type(error).__name__, error, flush=True)
    sys.exit(2)
"""


def start(path, n=200, values=48, limit=()):
    return subprocess.Popen(
        [sys.executable, "-c", WRITER, MADE, *map(str, (path, n, values, *limit))],
        stdout=subprocess.PIPE,
        text=True,
    )


def test_readers_and_the_writer_wait_for_each_other(tmp_path):
    path = tmp_path / "run"
    process = start(path, n=40)
    seen = [0]
    while process.poll() is None:
        if path.exists():
            seen.append(len(Store(path).statuses()))
    process.stdout.close()
    assert process.returncode == 0
    assert seen == sorted(seen)
    assert len(Store(path).statuses()) == 40


@pytest.mark.skipif(
    os.geteuid() != 0 or shutil.which("mount") is None, reason="a small disk needs root"
)
def test_a_full_disk_keeps_what_is_there(tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=6m", "none", str(disk)]
    if subprocess.run(mount, check=False, capture_output=True).returncode:
        pytest.skip("mounting is not allowed here")
    try:
        process = start(disk / "run", n=200, values=5000)
        *lines, last = process.communicate()[0].splitlines()
        assert process.returncode == 2
        assert last.startswith("InputError")
        assert "the disk is full" in last
        assert len(lines) > 1
        assert len(read_curves(disk / "run")) == len(lines)
    finally:
        subprocess.run(["umount", str(disk)], check=True)


def test_a_file_that_may_not_grow_keeps_what_is_there(tmp_path):
    path = tmp_path / "run"
    start(path, n=3).communicate()
    process = start(path, n=5, values=5000, limit=(100_000,))
    *lines, last = process.communicate()[0].splitlines()
    assert process.returncode == 2
    assert "a file may not be larger here; all completed cases are kept" in last
    assert lines == []
    assert len(read_curves(path)) == 3


def test_each_order_has_its_answer_and_its_own_death(monkeypatch):
    monkeypatch.setattr(workers, "_TRIES", 1)
    orders = {
        "kills": (signal.raise_signal, signal.SIGKILL),
        "root": (math.sqrt, 9.0),
        "error": (int, "three"),
        "lock": (threading.Lock,),
        "name": (str.upper, "a"),
    }
    found = dict(answers(operator.call, orders, workers=2, timeout_s=300.0))
    assert found.keys() == orders.keys()
    assert (found["root"].value, found["name"].value) == (3.0, "A")
    assert found["error"].message.startswith("ValueError: invalid literal")
    assert "pickle" in found["lock"].message
    assert found["kills"].message == "the worker died 1 times"
    assert not multiprocessing.active_children()


@pytest.mark.parametrize("end", ["killed", "hung", "closed"])
def test_a_worker_that_ends_or_hangs_costs_no_other_order(monkeypatch, end):
    orders = {"a": (math.sqrt, 9.0), "b": (time.sleep, 3600.0 * (end != "killed"))}
    found = answers(operator.call, orders, workers=1, timeout_s=300.0)
    assert next(found)[1].value == 3.0
    (worker,) = multiprocessing.active_children()
    if end == "killed":
        os.kill(worker.pid, signal.SIGKILL)
        assert next(found) == ("b", workers.Answer())
    elif end == "hung":
        now = time.monotonic
        monkeypatch.setattr(workers.time, "monotonic", lambda: now() + 1e4)
        assert "hung" in next(found)[1].message
    found.close()
    assert not multiprocessing.active_children()
