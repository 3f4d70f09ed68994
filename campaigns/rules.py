"""Tuned numbers of campaigns: what each means [unit], and from where it is."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.rules import limit, rule


@dataclass(frozen=True)
class CampaignRules:
    """What a case keeps, how it is judged, what it costs, how it is handed out."""

    profile_depths: int = limit(
        10,
        "depths at which pressure and surfaces are kept [-]",
        "as many curves as a figure shows apart",
    )  # fmt: skip
    profile_reach: float = rule(
        2.0,
        "profiles are kept out to this many contact radii [-]",
        "beyond it the surface is at rest",
    )  # fmt: skip
    group_digits: int = rule(
        12,
        "significant digits of the groups that identify a case [-]",
        "more would tell round-off apart. Changing it changes every id",
    )  # fmt: skip
    energy_defect: float = rule(
        0.005,
        "largest |work - stored - dissipated|/work of a case without a remark [-]",
        "above the largest of 462 pairs at production, 0.46 % (docs/campaign.md, Robustness)",
    )  # fmt: skip
    step: float = rule(
        0.01,
        "largest step of F, a and the share along a case, over the local value, without a "
        "remark [-]",
        "41 of 734 published cases have one of F above it (docs/campaign.md, Robustness)",
    )  # fmt: skip
    smooth_window: int = rule(
        7,
        "recorded depths that a local cubic is fitted to, to see steps [-]",
        "the fewest that leave it three degrees of freedom",
    )  # fmt: skip
    step_seen: float = rule(
        0.667,
        "part of a single step's height that such a window shows [-]",
        "the cubic follows the rest. The example of `quality.largest_step` plants one",
    )  # fmt: skip
    cost_prior: tuple[float, float, float, float] = rule(
        (0.05, 1.0, 1.0, 1.0),
        "weight of what was measured before against finished cases [cases], for the level, "
        "E'/Sy_min and Sy* above and below 1",
        "simulated sweeps (docs/campaign.md, How long it takes)",
    )  # fmt: skip
    still_to_go: float = rule(
        0.15,
        "part of its foreseen time that a case under way still takes, however long it has [-]",
        "by the same sweeps",
    )  # fmt: skip
    part_bytes: int = limit(
        10_000_000,
        "size that no published part exceeds [bytes]",
        "a repository's files stay below 10 MB",
    )  # fmt: skip
    parts: int = limit(
        12,
        "published parts in all [-]",
        "120 MB of a repository",
    )  # fmt: skip
    part_fill: float = limit(
        0.93,
        "of the size of a part, when cases are shared out by their mean size [-]",
        "where a part becomes too large all the same there is one more",
    )  # fmt: skip
    tries: int = limit(
        3,
        "how often a case is given to a worker [-]",
        "dask's own limit",
    )  # fmt: skip
    end_s: float = limit(
        5.0,
        "how long a process may take to end before it is killed [s]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    ahead: int = limit(
        4,
        "cases sent ahead to each dask worker [-]",
        "none waits while one is on its way (tools/benchmarks/bench_scale.py)",
    )  # fmt: skip
    look_s: float = limit(
        1.0,
        "between two looks at which dask workers are there [s]",
        "tools/benchmarks/bench_scale.py",
    )  # fmt: skip
    compressed_from: int = limit(
        512, "values of an array that is compressed [-]",
        "below it compression saves nothing",
    )  # fmt: skip
    groups_deep: int = limit(
        4, "groups of a file within each other [-]",
        "ours have three",
    )  # fmt: skip
    dataset_bytes: int = limit(
        256_000_000, "largest dataset of a file that is read [bytes]",
        "memory of a small machine",
    )  # fmt: skip
    text_bytes: int = limit(
        1_000_000, "largest text in one [bytes]",
        "a specification takes some thousand",
    )  # fmt: skip
    cost_depth: float = limit(
        0.1, "depth from which a forecast of time grows [R]",
        "chosen; no measurement is kept",
    )  # fmt: skip
    cost_slopes: tuple[float, ...] = limit(
        (0.5, 0.35, -0.5), "powers of E'/Sy_min, and of Sy* above and below 1, in a forecast [-]",
        "published cases",
    )  # fmt: skip
    cost_reference_s: float = limit(
        0.042, "the machine's own speed where those took their times [s]",
        "published cases",
    )  # fmt: skip
    patience_s: float = limit(
        60.0, "how long a run on a cluster goes on without any worker [s]",
        "a worker's restart takes less",
    )  # fmt: skip
    read_part_bytes: int = limit(
        100_000_000, "largest published part that is read [bytes]",
        "ten times what is published",
    )  # fmt: skip
    pairs_named: int = limit(
        6, "pairs that a picture names one by one [-]",
        "colours that an eye parts",
    )  # fmt: skip
    case_bytes: int = limit(
        500_000_000, "largest file of one case that is read [bytes]",
        "one with its fields takes some megabytes",
    )  # fmt: skip
    cost_base_s: tuple[tuple[str, float], ...] = limit(
        (("smoke", 16.0), ("quick", 26.0), ("production", 90.0)),
        "processor time of a case of each accuracy, for a forecast [s]",
        "published cases",
    )  # fmt: skip


RULES = CampaignRules()
"""Every tuned number of the stage."""
