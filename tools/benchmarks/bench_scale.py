"""What grows with the number of cases, of recording sets and of workers, and what each costs.

    .venv/bin/python tools/benchmarks/bench_scale.py    about six minutes; 2 GB of disk, 4 of memory
    .venv/bin/python tools/benchmarks/bench_scale.py --quick   about one, at a tenth of the sizes
    .venv/bin/python tools/benchmarks/bench_scale.py --only reads       or another of `ONLY`

Published cases, copied with a Poisson ratio smaller by a millionth each, go one by one through
`Store.put` into runs that hold so many files already (links to the first few). Everything that is
timed goes through the functions that the commands use, each in a process of its own for its peak of
memory (what the process held before is taken off). The last column is the share of one case in the
largest over that in the smallest, or of one call where the row says `one`: 1 where nothing grows.
The cluster, workers and scheduler too, lies in this one process, over tcp, and solves nothing.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import multiprocessing
import resource
import shutil
import tempfile
import time
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from dentscope import fem
from dentscope.campaigns import (
    Case,
    CaseRecord,
    Store,
    read_curves,
    read_published,
)
from dentscope.campaigns.store import file_of
from dentscope.core.errors import Ending, Outcome
from dentscope.fem.solution import Counters, Curve, Profile, Unloading
from dentscope.recordings import read
from dentscope.recordings.checks import audit
from dentscope.recordings.shipped import FOLDER, shipped_sets

PUBLISHED = Path("data/campaign")
BASE = 20  # cases that a run's are copies of
ONLY = ("recordings", "stores", "reads", "cluster")


def solution_of(record: CaseRecord) -> fem.Solution:
    """What a worker would hand over for a published case."""
    done, shapes = Outcome(Ending.COMPLETED), record.profiles
    return fem.Solution(
        problem=record.case.problem,
        accuracy=fem.Accuracy(**record.accuracy),
        outcome=done,
        loading=Curve(**record.curve),
        unloadings=tuple(
            Unloading(
                u.depth, Curve(**u.curve), u.residual_sphere, u.residual_flat, **u.profiles,
                steps=40, outcome=done,
            )
            for u in record.unloadings
        ),
        snapshots=(),
        counters=Counters(**{k: record.counters.get(k, 0) for k in Counters.__annotations__}),
        mesh_digest=record.mesh,
        profiles=tuple(
            Profile(float(depth), *(_there(shapes[n][k]) for n in shapes if n != "depth"))
            for k, depth in enumerate(shapes["depth"])
        ),
    )  # fmt: skip


def _there(row: Any) -> Any:
    return row[np.isfinite(row)]


def neighbour(specification: dict[str, Any], number: int) -> Case:
    """The same case with a Poisson ratio smaller by a millionth or more: another id."""
    spec = json.loads(json.dumps(specification))
    body = spec["flat"] if "nu" in spec["flat"] else spec["sphere"]
    body["nu"] -= 1e-6 * number
    spec["name"] += f"-copy-{number}"
    return Case.from_specification(spec)


def apart(call: Callable[..., Any], *args: Any) -> tuple[float, float, Any]:
    """Wall seconds, MB above what was held before, and the answer of a call in a process."""
    context = multiprocessing.get_context("fork")
    mine, theirs = context.Pipe(duplex=False)

    def serve() -> None:
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        started = time.perf_counter()
        answer = call(*args)
        gone = time.perf_counter() - started
        theirs.send((gone, (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1e3,
                     answer))  # fmt: skip

    process = context.Process(target=serve)
    process.start()
    theirs.close()
    found: tuple[float, float, Any] = mine.recv()
    process.join()
    return found


def show(title: str, sizes: Iterable[int], rows: list[tuple[str, str, list[float]]]) -> None:
    """Print a table: totals at each size, and how the share of one grows."""
    sizes = list(sizes)
    print(f"\n{title}\n{'':44}" + "".join(f"{n:>11,}" for n in sizes) + "   per one")
    for name, unit, values in rows:
        ones = [v if name.startswith("one ") else v / n for v, n in zip(values, sizes, strict=True)]
        each = ones[-1] / ones[0] if ones[0] else float("nan")
        shown = "".join(f"{v:11.4g}" for v in values)
        print(f"{f'{name} [{unit}]':44}{shown}   x {each:.2f}", flush=True)


def put_all(folder: Path, records: list[CaseRecord], number: int = 0) -> tuple[float, float]:
    """Put copies of some cases; return processor seconds and bytes of one put.

    The solutions are made before: what a put costs is the store's.
    """
    solutions = [solution_of(record) for record in records]
    cases = [neighbour(record.case.specification(), 1 + number) for record in records]
    store = Store(folder)
    started = time.process_time()
    for record, case, solution in zip(records, cases, solutions, strict=True):
        store.put(case, solution, computed_by=record.environment)
    gone = time.process_time() - started
    sizes = [file_of(folder, case.id, "done").stat().st_size for case in cases]
    return gone / len(records), float(np.mean(sizes))


def filled(folder: Path, size: int) -> None:
    """Let a run hold so many files of cases, links to those that are there."""
    there = Store(folder).files()
    for k in range(len(there), size):
        name = hashlib.sha256(str(k).encode()).hexdigest()
        place = file_of(folder, name, "done")
        place.parent.mkdir(parents=True, exist_ok=True)
        place.hardlink_to(there[k % len(there)])


def stores(folder: Path, records: list[CaseRecord], sizes: list[int]) -> None:
    """What each call on a run costs."""
    some = records[:: len(records) // BASE][:BASE]  # the same cases again and again
    place = folder / "run"
    put_all(place, some)
    puts = []
    for number, size in enumerate(sizes, start=1):
        filled(place, size)
        puts.append(apart(put_all, place, some, number)[2])
    show("A put where so many cases are stored", sizes, [
        ("one put", "processor s", [put[0] for put in puts]),
        ("one put", "kB", [put[1] / 1e3 for put in puts]),
    ])  # fmt: skip
    gone, peak, _ = apart(Store(place).statuses)
    print(f"statuses of {sizes[-1]:,} cases: {gone:.2f} s, {peak:.0f} MB held")
    few = folder / "few"
    put_all(few, some)
    gone, peak, _ = apart(_sized, Store(few).summaries)
    print(f"summaries of {len(some)} cases: {gone / len(some) * 1e3:.1f} ms each")
    gone, peak, _ = apart(_sized, Store(few).read_all)
    print(f"read_all of {len(some)} cases: {gone / len(some) * 1e3:.1f} ms and "
          f"{peak / len(some):.2f} MB each")  # fmt: skip


def reads(folder: Path, records: list[CaseRecord], size: int) -> None:
    """Put so many cases one by one, each a file of its own, and read them all."""
    place = folder / "whole"
    started, gone = time.process_time(), 0.0
    for first in range(0, size, BASE):
        some = [records[(first + k) % len(records)] for k in range(BASE)]
        gone += put_all(place, some, 1 + first)[0] * BASE
    print(f"\n{size:,} cases put one by one: {gone / size * 1e3:.1f} ms of processor each, "
          f"{time.process_time() - started:.0f} s with their making")  # fmt: skip
    held = sum(path.stat().st_size for path in Store(place).files()) / 1e6
    for name, call, args in (
        ("statuses", Store(place).statuses, ()),
        ("summaries", Store(place).summaries, ()),
        ("read_curves", read_curves, (place,)),
    ):
        gone, peak, count = apart(_sized, call, *args)
        print(f"{name} of {count:,} cases ({held:.0f} MB): {gone:.1f} s, {peak:.0f} MB held",
              flush=True)  # fmt: skip


def _sized(call: Callable[..., Any], *args: Any) -> int:
    return len(call(*args))


def cluster(records: list[CaseRecord], crews: list[int], count: int) -> None:
    """The campaign's own hand-out to a dask cluster whose workers answer at once."""
    from dentscope.campaigns.executor import DaskExecutor
    from distributed import LocalCluster

    answer = solution_of(records[0])
    specs = [record.case.specification() for record in records]
    made = (neighbour(specs[k % len(specs)], 1 + k // len(specs)) for k in range(count))
    cases = {case.id: case for case in made}
    rows: dict[str, list[float]] = {}
    for crew in crews:
        with LocalCluster(
            n_workers=crew, threads_per_worker=1, processes=False, protocol="tcp://",
            dashboard_address=None, memory_limit=None, silence_logs=50,
        ) as there:  # fmt: skip
            executor = replace(
                DaskExecutor.connect(there.scheduler_address, timeout_s=60.0),
                work=lambda _spec, _limit: answer,
            )
            asked = []
            for _ in range(20):
                started = time.perf_counter()
                executor._worker_count()
                asked.append(time.perf_counter() - started)
            started, most = time.perf_counter(), 0
            for number, _ in enumerate(executor.run(cases, time_limit_s=60.0)):
                if number % 10 == 0:
                    most = max(most, len(there.scheduler.tasks))
            gone = time.perf_counter() - started
            executor.client.close()
        rows.setdefault("who is there, asked once, the fastest of 20 [ms]", []).append(
            1e3 * min(asked)
        )
        rows.setdefault("one case handed out and back [ms]", []).append(1e3 * gone / count)
        rows.setdefault("most tasks in the scheduler", []).append(float(most))
    print(f"\nA dask cluster of so many workers, {count} cases that take no time\n{'':50}"
          + "".join(f"{n:>11,}" for n in crews))  # fmt: skip
    for name, values in rows.items():
        print(f"{name:50}" + "".join(f"{v:11.4g}" for v in values), flush=True)


def recordings(folder: Path, count: int, rows: list[int]) -> None:
    """Reading and audit of many sets, and of one long one."""
    names = shipped_sets()
    for k in range(count):
        shutil.copytree(FOLDER / names[k % len(names)], folder / "sets" / f"{k}")
    few = count // 10
    found = [apart(_audited, folder / "sets", n) for n in (few, count)]
    show("So many recording sets read and audited", (few, count), [
        ("all", "s", [row[0] for row in found]), ("all kept", "MB held", [row[1] for row in found]),
    ])  # fmt: skip
    long = []
    for n in rows:
        place = folder / "sets" / f"long-{n}"
        shutil.copytree(FOLDER / "kharaz-2001-oblique", place)
        head, *lines = (place / "trials.csv").read_text().strip().splitlines()
        body = (f"{k}-{lines[k % len(lines)]}" for k in range(n))
        (place / "trials.csv").write_text("\n".join((head, *body)) + "\n")
        long.append(apart(_audited_one, place))
    show("One set of so many trials", rows, [
        ("read", "s", [row[2][0] for row in long]), ("audit", "s", [row[2][1] for row in long]),
        ("both", "MB held", [row[1] for row in long]),
    ])  # fmt: skip


def _audited(folder: Path, count: int) -> int:
    kept = []
    for k in range(count):
        found = read(folder / f"{k}")
        kept.append((found, audit(found)))
    return len(kept)


def _audited_one(folder: Path) -> tuple[float, float]:
    started = time.perf_counter()
    found = read(folder)
    middle = time.perf_counter()
    audit(found)
    return middle - started, time.perf_counter() - middle


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", choices=ONLY, default="")
    given = parser.parse_args()
    quick = given.quick
    started = time.perf_counter()
    records = read_published(PUBLISHED)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        calls: dict[str, Callable[[], None]] = {
            "recordings": lambda: recordings(
                folder, *((100, [2_000, 20_000]) if quick else (1000, [20_000, 200_000]))
            ),
            "stores": lambda: stores(
                folder, records, [20, 100, 1000, *([] if quick else [10_000, 100_000])]
            ),
            "reads": lambda: reads(folder, records, 1_000 if quick else 10_000),
            "cluster": lambda: cluster(
                records, [2, 20] if quick else [2, 20, 100], 200 if quick else 400
            ),
        }
        for what in (given.only,) if given.only else ONLY:
            calls[what]()
    print(f"\n{time.perf_counter() - started:.0f} s")


if __name__ == "__main__":
    main()
