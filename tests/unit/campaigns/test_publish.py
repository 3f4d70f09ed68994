"""Published parts: complete, small, never rewritten, checked when read."""

import numpy as np
import pytest
from dentscope import fem
from dentscope.campaigns import (
    Design,
    Store,
    largest_difference,
    publish,
    read_curves,
    read_published,
    standard_case,
)
from dentscope.cli import run
from dentscope.core import COMPLETED, InputError, Material, Pair
from dentscope.fem import Counters, Curve, Solution


def made(n=6):
    flat = Material(E=100e9, nu=0.3, Sy=3e8)
    return tuple(
        standard_case(
            f"case-{i}",
            Pair(Material(E=200e9, nu=0.3, Sy=4e8 + 1e7 * i), flat, 1e-3),
            deepest=0.01,
            n_depths=4,
            accuracy=fem.Accuracy.smoke(),
        )
        for i in range(n)
    )


DESIGN = Design("trial", "", made)


def stored(path, n=6, factor=1.0):
    counters = Counters(**dict.fromkeys(Counters.__dataclass_fields__, 1))
    line = factor * np.random.default_rng(1).random(3000)
    curve = Curve(**dict.fromkeys(Curve.__dataclass_fields__, line))
    for case in made()[:n]:
        solution = Solution(case.problem(), case.accuracy, COMPLETED, curve, (), (), counters, "m")
        Store(path).put(case, solution)
    return path


def test_parts_hold_every_case_once_below_their_size(tmp_path):
    source = stored(tmp_path / "c.h5")
    parts = publish(DESIGN, source, tmp_path / "data", most_bytes=600_000)
    assert 1 < len(parts) <= 8
    assert all(part.stat().st_size < 600_000 for part in parts)
    published = read_published(tmp_path / "data")
    assert sorted(r.id for r in published) == sorted(r.id for r in read_curves(source))
    assert largest_difference(read_curves(source), published) == (6, 0.0)
    other = stored(tmp_path / "other.h5", factor=1.02)
    assert largest_difference(read_curves(other), published) == (6, pytest.approx(0.02))


def test_an_incomplete_run_is_not_published_and_nothing_is_written_twice(tmp_path):
    source = stored(tmp_path / "c.h5", n=5)
    with pytest.raises(InputError, match="1 of 6 cases are missing"):
        publish(DESIGN, source, tmp_path / "data")
    stored(source)
    [part] = publish(DESIGN, source, tmp_path / "data")
    with pytest.raises(InputError, match="published already"):
        publish(DESIGN, source, tmp_path / "data")
    part.write_bytes(part.read_bytes()[:-1] + b"x")
    with pytest.raises(InputError, match="checksum"):
        read_published(tmp_path / "data")


def test_too_many_parts_leave_the_folder_as_it_was(tmp_path):
    source = stored(tmp_path / "c.h5")
    folder = tmp_path / "data"
    folder.mkdir()
    for k in range(8):
        (folder / f"other-{k}.h5").write_text("")
    with pytest.raises(InputError, match="8 in all"):
        publish(DESIGN, source, folder)
    assert sorted(p.name for p in folder.iterdir()) == [f"other-{k}.h5" for k in range(8)]


def test_publishing_a_missing_run_is_one_line(tmp_path, capsys):
    answer = run(
        ["campaign", "publish", "--design", "smoke", "--out", str(tmp_path), "--to", str(tmp_path)]
    )
    assert answer == 2
    assert "12 of 12 cases are missing" in capsys.readouterr().err
