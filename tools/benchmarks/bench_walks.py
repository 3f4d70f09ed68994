"""How often a strength is handed from function to function on its way from a file to an answer.

    python tools/benchmarks/bench_walks.py

The strength of the flat, in a shipped recording set and in a set-up of `impact`, is a number that
nothing else has. Counted are returns of the package's functions that hand on exactly this number,
alone or as a quantity of a file, until the verdict stands and until the blow is told; those of the
file's tables after the problem was made, below which no file is read again, are told as AGAIN.
"""

import re
import shutil
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import dentscope as ds
from dentscope.core.rig import Quantity
from dentscope.discrepancy import verdict

ROOT = Path(__file__).resolve().parents[2]
SET = ROOT / "data" / "recordings" / "leeb-steel-300hv"
STRENGTH = 981761300.0
"""[Pa]; the set states 9.81e8."""
SETUP = f"""
[target]
E_Pa = 2.0e11
nu = 0.3
Sy_Pa = {STRENGTH}
density_kg_m3 = 7800
[strikers.ball]
shape = "sphere"
tip_radius_m = 0.005
density_kg_m3 = 7800
E_Pa = 2.1e11
nu = 0.3
Sy_Pa = 2.0e9
[impact]
impact_speed_m_s = 1.0
"""
FILES = re.compile(r"core/(rig\.py|inputs/)")


def walked(work: Callable[[], Any]) -> Counter[str]:
    """Functions that return the strength while some work is done, and how often."""
    found: Counter[str] = Counter()
    made = False

    def watch(frame: FrameType, event: str, given: Any) -> None:
        nonlocal made
        if event != "return":
            return
        code = frame.f_code
        if code is verdict.problem_of.__code__:
            made = True
        # the value first: a verdict is some ten million calls
        value = given.value if type(given) is Quantity else given
        if not isinstance(value, float) or value != STRENGTH:
            return
        path = code.co_filename
        if path.startswith(str(ROOT)) and "/.venv/" not in path:
            name = f"{path.removeprefix(str(ROOT))[1:]} {code.co_qualname}"
            found[f"AGAIN {name}" if made and FILES.search(name) else name] += 1

    sys.setprofile(watch)
    try:
        work()
    finally:
        sys.setprofile(None)
    return found


def told(name: str, found: Counter[str]) -> None:
    """Print a walk."""
    again = sum(n for where, n in found.items() if where.startswith("AGAIN"))
    print(f"{name}: {found.total()} returns, {again} of the file's tables after the problem")
    for where, n in found.most_common():
        print(f"  {n:5} {where}")


def main() -> None:
    """Count both walks."""
    with tempfile.TemporaryDirectory() as folder:
        own = shutil.copytree(SET, Path(folder) / "set")
        text = (own / "set.toml").read_text(encoding="utf-8")
        changed = re.sub(r"Sy_Pa = \{ value = 9\.81e\+08", f"Sy_Pa = {{ value = {STRENGTH}", text)
        assert changed != text
        (own / "set.toml").write_text(changed, encoding="utf-8")
        told("set.toml to the verdict", walked(lambda: ds.diagnose(own)))
        setup = Path(folder) / "ball.toml"
        setup.write_text(SETUP, encoding="utf-8")
        told("impact", walked(lambda: str(ds.impact(setup))))


if __name__ == "__main__":
    main()
