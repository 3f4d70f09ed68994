"""Every tuned number of the stage, with its unit, its meaning and where it comes from."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class CampaignRules:
    """What a case keeps, how it is judged, what it is expected to cost, how it is handed out.

    Parameters
    ----------
    profile_depths
        Depths at which pressure and surfaces are kept [1]. As many curves as a figure shows apart.
    profile_reach
        Profiles are kept out to this many contact radii [1]: beyond it the surface is at rest.
    group_digits
        Significant digits of the groups that identify a case [1]: more would tell round-off apart.
        Changing it changes every id.
    energy_defect
        Largest |work - stored - dissipated|/work of a case without a remark [1]: above the largest
        of 462 pairs at production, 0.46 % (docs/campaign.md, Robustness).
    step
        Largest step of F, a and the share along a case, over the local value, without a remark
        [1]: 41 of 734 published cases have one of F above it (docs/campaign.md, Robustness).
    smooth_window
        Recorded depths that a local cubic is fitted to, to see steps [1]: the fewest that leave it
        three degrees of freedom.
    step_seen
        Part of a single step's height that such a window shows [1]; the cubic follows the rest.
        The example of `quality.largest_step` plants one.
    cost_prior
        Weight of what was measured before against finished cases [cases], for the level, E'/Sy_min
        and Sy* above and below 1: simulated sweeps (docs/campaign.md, How long it takes).
    still_to_go
        Part of its foreseen time that a case under way still takes, however long it has [1]; by the
        same sweeps.
    part_bytes
        Size that no published part exceeds [bytes]: a repository's files stay below 10 MB.
    parts
        Published parts in all [1]: 120 MB of a repository.
    part_fill
        Of the size of a part, when cases are shared out by their mean size [1]; where a part
        becomes too large all the same there is one more.
    tries
        How often a case is given to a worker [1]; dask's own limit.
    end_s
        How long a process may take to end before it is killed [s].
    ahead
        Cases sent ahead to each dask worker [1]: none waits while one is on its way
        (benchmarks/bench_scale.py).
    look_s
        Between two looks at which dask workers are there [s] (benchmarks/bench_scale.py).
    """

    profile_depths: int = 10
    profile_reach: float = 2.0
    group_digits: int = 12
    energy_defect: float = 0.005
    step: float = 0.01
    smooth_window: int = 7
    step_seen: float = 0.667
    cost_prior: tuple[float, float, float, float] = (0.05, 1.0, 1.0, 1.0)
    still_to_go: float = 0.15
    part_bytes: int = 10_000_000
    parts: int = 12
    part_fill: float = 0.93
    tries: int = 3
    end_s: float = 5.0
    ahead: int = 4
    look_s: float = 1.0


RULES = CampaignRules()
