"""Run checks one after the other; what has been measured once is not measured again."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from ... import fem
from .bench import Bench, Effort
from .checks import Check
from .result import Result, read_result, write_result


def run_checks(checks: Iterable[Check], *, bench: Bench, afresh: bool = False) -> list[Result]:
    """Measure every check that is not yet measured at this effort with these numerics.

    `bench`: where, and how finely; `afresh`: measure again what has been measured (shared solves
    are still reused).
    """
    results = []
    for check in checks:
        known = kept_result(check, folder=bench.folder)
        if known is not None and not afresh and known.complete and _covers(known, bench.effort):
            bench.say(f"{check.name}: measured before")
            results.append(known)
            continue
        bench.say(f"{check.name}: {check.title}")
        results.append(_measured(check, bench))
    return results


def kept_result(check: Check, *, folder: Path) -> Result | None:
    """Return what was measured with the present numerics: complete before partial, then finer."""
    found = [r for r in _results(check, folder) if r.numerics_version == fem.NUMERICS_VERSION]
    return max(found, key=_worth, default=None)


def best_result(check: Check, *, folders: Iterable[Path]) -> Result | None:
    """Return the newest, then most complete, then finest result of several folders."""
    found = [result for folder in folders for result in _results(check, folder)]
    return max(found, key=lambda r: (r.numerics_version, *_worth(r)), default=None)


def publish(result: Result, *, folder: Path) -> None:
    """Keep a result in another folder, from which a report can be written again."""
    path = _file(result.name, folder, Effort(result.effort))
    if not path.exists() or read_result(path) != result:
        write_result(result, path)


def _results(check: Check, folder: Path) -> list[Result]:
    paths = [_file(check.name, folder, effort) for effort in Effort]
    return [read_result(path) for path in paths if path.exists()]


def _worth(result: Result) -> tuple[bool, bool]:
    return result.complete, result.effort == Effort.PRODUCTION.value


def _measured(check: Check, bench: Bench) -> Result:
    started, bench.reused_cpu_s = time.process_time(), 0.0
    path = _file(check.name, bench.folder, bench.effort)

    def stamped(found: Result) -> Result:
        return replace(
            found,
            name=check.name,
            effort=bench.effort.value,
            numerics_version=fem.NUMERICS_VERSION,
            cpu_s=time.process_time() - started + bench.reused_cpu_s,
        )

    bench.publish = lambda found: write_result(stamped(found), path)
    result = stamped(check.run(bench))
    write_result(result, path)
    for m in result.measurements:
        state = {True: "met", False: "MISSED", None: ""}[m.met]
        bench.say(f"  {m.what}: {m.value:.4g} {m.unit} {m.mark} {state}".rstrip())
    return result


def _covers(result: Result, effort: Effort) -> bool:
    return result.effort == Effort.PRODUCTION.value or effort is Effort.QUICK


def _file(name: str, folder: Path, effort: Effort) -> Path:
    return folder / "results" / f"{name}-{effort.value}.json"
