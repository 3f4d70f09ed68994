"""Published parts: complete, small, never rewritten, checked when read, compared with own runs."""

import hashlib
import json
import re
from dataclasses import replace
from pathlib import Path
from shutil import copytree

import h5py
import numpy as np
import pytest
from dentscope import fem
from dentscope.campaigns import (
    Design,
    Store,
    design_named,
    executor,
    largest_difference,
    publish,
    published_designs,
    read_curves,
    read_published,
)
from dentscope.campaigns.executor import Ended
from dentscope.campaigns.schema import CURVE, UNLOADING_PROFILES
from dentscope.cli import campaign as command
from dentscope.core import COMPLETED, Ending, InputError, Outcome
from dentscope.fem import Profile, Unloading
from made_cases import case_of, solution_of


def made(n=6):
    return tuple(
        case_of(f"case-{i}", Sy=4e8 + 1e7 * i, n_depths=30, unload_depths=(0.004, 0.01))
        for i in range(n)
    )


DESIGN = Design("trial", "", made)
TABLES = ("curve", "profiles")


def solved(case, seed=0, factor=1.0):
    """A made-up solve with curves, unloadings and profiles of uneven lengths."""
    draw, R = np.random.default_rng(seed), case.pair.R
    delta = np.array(case.depths) * R
    noise = {name: 1.0 + 0.01 * draw.random(len(delta)) for name in CURVE}
    force = factor * delta * noise["force"] * 1e6
    plain = solution_of(case, **{**noise, "delta": delta, "force": force})
    n = 150 + seed
    shapes = {name: draw.random(n) for name in UNLOADING_PROFILES}
    unloadings = tuple(
        Unloading(d, plain.loading, 1e-6 * draw.random(), -1e-9, **shapes, steps=9,
                  outcome=COMPLETED)
        for d in case.problem.unload_from
    )  # fmt: skip
    # the mesh follows the contact: profiles have uneven numbers of nodes
    profiles = tuple(
        Profile(d, *np.sort(draw.random((5, n - k))) * 1e-3)
        for k, d in enumerate(case.problem.profiles)
    )
    return replace(plain, unloadings=unloadings, profiles=profiles)


def stored(path, n=6, factor=1.0):
    for seed, case in enumerate(made()[:n]):
        Store(path).put(case, solved(case, seed, factor))
    return path


def test_parts_hold_every_case_once_below_their_size(folder, tmp_path):
    source = folder / "run"
    parts = publish(DESIGN, source, tmp_path / "data", most_bytes=120_000)
    assert 1 < len(parts) <= 8
    assert all(part.stat().st_size < 120_000 for part in parts)
    published = read_published(tmp_path / "data")
    assert sorted(r.id for r in published) == sorted(r.id for r in read_curves(source))
    assert [r.id for r in read_curves(tmp_path / "data")] == [r.id for r in published]
    first = [r.id for r in read_curves(parts[0])]
    assert first == [r.id for r in published][: len(first)]
    told = published_designs(tmp_path / "data")
    assert [(d.design, d.parts, d.done, d.failed, d.stale) for d in told] == [
        ("trial", len(parts), 6, 0, False)
    ]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("published")
    publish(DESIGN, stored(place / "run"), place / "data")
    return place


@pytest.fixture(scope="module")
def part(folder):
    (one,) = (folder / "data").glob("*.h5")
    return one


def test_a_part_gives_back_what_the_run_stored(folder):
    published = {record.id: record for record in read_published(folder / "data")}
    for own in read_curves(folder / "run"):
        other = published[own.id]
        assert (other.case, other.message, other.counters) == (own.case, "", own.counters)
        assert (other.accuracy, other.environment, other.mesh) == (
            own.accuracy, own.environment, own.mesh
        )  # fmt: skip
        pairs = [(own, other), *zip(own.unloadings, other.unloadings, strict=True)]
        for mine, theirs in ((getattr(a, k), getattr(b, k)) for a, b in pairs for k in TABLES):
            assert mine.keys() == theirs.keys()
            for name, values in mine.items():
                # single precision: half a unit in the last of 24 bits
                np.testing.assert_allclose(theirs[name], values, rtol=2.0**-24)
        for a, b in pairs[1:]:
            assert (a.depth, a.residual_sphere, a.residual_flat) == (
                b.depth, b.residual_sphere, b.residual_flat
            )  # fmt: skip


def test_every_column_of_a_part_tells_its_unit_and_meaning(part):
    def look(name, item):
        if isinstance(item, h5py.Dataset):
            assert item.attrs["meaning"], name
            assert "unit" in item.attrs or item.dtype.kind == "S", name

    with h5py.File(part) as file:
        file.visititems(look)


def test_the_readme_of_the_data_set_names_every_column(part):
    readme = (Path(__file__).parents[3] / "data" / "campaign" / "README.md").read_text()
    named = set(re.findall(r"`([\w-]+)`", readme))
    with h5py.File(part) as file:
        for table, columns in file.items():
            assert table in named
            assert set(columns) - named == set()


def test_failed_cases_are_published_with_their_reason(tmp_path):
    source = stored(tmp_path / "run", n=5)
    case = made()[5]
    stuck = Outcome(Ending.NOT_CONVERGED, "stuck at 0.003.", "Refine.")
    Store(source).put(case, replace(solved(case), outcome=stuck, unloadings=(), profiles=()))
    [part] = publish(DESIGN, source, tmp_path / "data")
    assert len(read_curves(part)) == 5
    assert published_designs(tmp_path / "data")[0].failed == 1
    with h5py.File(part) as file:
        assert b"stuck at 0.003" in file["cases/message"][()][5]
    told = (tmp_path / "data" / "PARTS.md").read_text()
    assert "- `case-5`: not-converged: stuck at 0.003. Refine." in told
    assert hashlib.sha256(part.read_bytes()).hexdigest() in told


def test_an_own_run_is_compared_with_what_is_published(folder, tmp_path):
    published = read_published(folder / "data")
    found = largest_difference(read_curves(stored(tmp_path / "other", factor=1.02)), published)
    assert (found.cases, found.same) == (6, True)
    assert found.force == pytest.approx(0.02, abs=1e-6)
    assert found.radius < 1e-6
    # at another resolution it is the pair that tells what to compare
    finer = replace(made()[0], accuracy=fem.Accuracy.quick())
    Store(tmp_path / "finer").put(finer, solved(finer, 0, 0.9))
    found = largest_difference(read_curves(tmp_path / "finer"), published)
    assert (found.cases, found.same) == (1, False)
    assert found.force == pytest.approx(0.1, abs=1e-6)
    assert largest_difference([], published).cases == 0


def test_an_incomplete_run_is_not_published_and_nothing_is_written_twice(tmp_path):
    source = stored(tmp_path / "run", n=5)
    with pytest.raises(InputError, match="1 of 6 cases are missing"):
        publish(DESIGN, source, tmp_path / "data")
    stored(source)
    [part] = publish(DESIGN, source, tmp_path / "data")
    with pytest.raises(InputError, match="published already"):
        publish(DESIGN, source, tmp_path / "data")
    half = replace(DESIGN, name="half", make=lambda: made()[:3])
    with pytest.raises(InputError, match="3 of its 3 cases are published already"):
        publish(half, source, tmp_path / "data")
    part.write_bytes(part.read_bytes()[:-1] + b"x")
    with pytest.raises(InputError, match="checksum"):
        read_published(tmp_path / "data")
    part.unlink()
    with pytest.raises(InputError, match="no such file"):
        published_designs(tmp_path / "data")


def test_a_bit_flipped_anywhere_is_refused(tmp_path):
    run = stored(tmp_path / "run", n=1)
    whole = replace(DESIGN, make=lambda: made()[:1])
    for path in (*Store(run).files(), *publish(whole, run, tmp_path / "data")):
        image = path.read_bytes()
        for at in range(0, len(image), len(image) // 25):
            changed = bytearray(image)
            changed[at] ^= 1 << at % 8
            path.write_bytes(changed)
            with pytest.raises(InputError):
                read_curves(path)


@pytest.mark.parametrize("name", ["a" * 4000 + ".h5", "../c.h5", ".h5", "a/b.h5"])
def test_a_part_of_an_impossible_name_is_one_line(folder, tmp_path, name):
    data = copytree(folder / "data", tmp_path / "data")
    (data / "SHA256SUMS").write_text(f"{'0' * 64}  {name}\n")
    with pytest.raises(InputError, match="SHA256SUMS: line 1: damaged"):
        read_published(data)


def test_too_many_parts_leave_the_folder_as_it_was(folder, tmp_path):
    others = {f"other-{k}.h5" for k in range(16)}
    for name in others:
        (tmp_path / name).write_text("")
    with pytest.raises(InputError, match="16 in all"):
        publish(DESIGN, folder / "run", tmp_path)
    assert {p.name for p in tmp_path.iterdir()} == others


def test_status_without_a_run_tells_of_the_published_data(folder, tmp_path, prints, monkeypatch):
    monkeypatch.setattr(command, "PUBLISHED", folder / "data")
    asked = ("campaign", "status", "--out", tmp_path / "none")
    told = prints(*asked)
    assert "No run of your own" in told
    assert re.search(r"trial +6 done +0 failed", told)
    assert json.loads(prints(*asked, "--json"))["published"]["trial"]["done"] == 6


class Quick:
    def __init__(self, workers):
        self.workers = workers

    def run(self, cases, *, time_limit_s):
        for key, case in cases.items():
            yield Ended(key, solved(case, factor=1.01))


def test_a_run_says_how_long_it_takes_and_how_far_it_is_from_the_published(
    tmp_path, prints, monkeypatch
):
    monkeypatch.setattr(executor, "LocalExecutor", Quick)
    monkeypatch.setattr(command, "PUBLISHED", tmp_path / "data")
    smoke = design_named("smoke")
    for case in smoke.make():
        Store(tmp_path / "before").put(case, solved(case))
    publish(smoke, tmp_path / "before", tmp_path / "data")
    given = ["--design", "smoke", "--out", str(tmp_path / "run"), "--workers", "2"]
    first, *middle = prints("campaign", "run", *given).splitlines()
    assert re.search(r"12 to compute on 2 workers; about \d+ (s|min) here", first)
    (last,) = (i for i, s in enumerate(middle) if re.match(r"\[12/12, 0 s left\] done", s))
    (ended,) = (i for i, s in enumerate(middle) if s.startswith("12 done, 0 failed, 0 missing"))
    assert ended > last
    assert "every one reaches Delta/R = 0.04" in middle[ended + 1]
    assert "largest difference from 12 published cases: F 1.00%" in middle[ended + 2]
