"""Run checks one after the other; what has been measured once is not measured again."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from .. import fem
from .bench import Bench, Effort
from .checks import Check
from .result import Result, read_result, write_result


def run_checks(checks: Iterable[Check], *, bench: Bench, afresh: bool = False) -> list[Result]:
    """Measure every check that is not yet measured at this effort with these numerics.

    Parameters
    ----------
    checks
        Which.
    bench
        Where, and how finely.
    afresh
        Measure again what has been measured (shared solves are still reused).
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
    found = []
    for effort in (Effort.PRODUCTION, Effort.QUICK):
        path = _file(check, folder, effort)
        if path.exists():
            result = read_result(path)
            if result.numerics_version == fem.NUMERICS_VERSION:
                found.append(result)
    best = [result for result in found if result.complete] or found
    return best[0] if best else None


def _measured(check: Check, bench: Bench) -> Result:
    started, bench.reused_cpu_s = time.process_time(), 0.0
    path = _file(check, bench.folder, bench.effort)

    def stamped(found: Result) -> Result:
        return replace(
            found,
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


def _file(check: Check, folder: Path, effort: Effort) -> Path:
    return folder / "results" / f"{check.name}-{effort.value}.json"
