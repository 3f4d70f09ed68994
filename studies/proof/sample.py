"""Write sample sets with their truths beside them, to look at or to try a diagnosis on.

`dentscope proof sample OUT` writes OUT/sets/NAME/ (recording sets) and OUT/truths/NAME.json. The
proof itself never uses these seeds.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from .generators.effects import EFFECTS, OUTSIDE
from .generators.folder import write_set
from .generators.truth import draw
from .names import KINDS


def sample(
    out: Path, *, count: int, kind: str = "", name: str = "", seed: int = 1
) -> Iterator[tuple[str, dict[str, object]]]:
    """Write `count` sets below `out`; yield the name and the truth of each.

    - `out`: folder; sets go to `out/sets`, truths to `out/truths`.
    - `count`: number of sets.
    - `kind`: `null`, `single`, `pair` or `outside`; in turn if empty.
    - `name`: effect of a single or of one outside the library; every one in turn if empty.
    - `seed`: of the draw.
    """
    (out / "truths").mkdir(parents=True, exist_ok=True)
    names = list(EFFECTS if kind == "single" else OUTSIDE)
    for number in range(count):
        rng = np.random.default_rng([seed, number])
        given = kind or ("single" if name in EFFECTS else "outside" if name in OUTSIDE else "")
        this = given or KINDS[number % len(KINDS)]
        effect = name or (names[number % len(names)] if kind in ("single", "outside") else "")
        truth = draw(rng, this, name=effect)
        label = f"sample-{seed}-{number:03d}"
        write_set(truth, out / "sets" / label, name=label)
        record = truth.record()
        (out / "truths" / f"{label}.json").write_text(json.dumps(record, indent=1) + "\n")
        yield label, record
