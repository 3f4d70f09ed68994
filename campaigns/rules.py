"""Tuned numbers of campaigns: what each means [unit], and from where it is."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.rules import rule


@dataclass(frozen=True)
class CampaignRules:
    """What a case keeps, how it is judged, what it costs, how it is handed out."""

    energy_defect: float = rule(
        0.005,
        "largest |work - stored - dissipated|/work of a case without a remark [-]",
        "above the largest of 462 pairs at production, 0.46 % (docs/campaign.md, Robustness)",
    )
    step: float = rule(
        0.01,
        "largest step of F, a and the share along a case, over the local value, without a "
        "remark [-]",
        "41 of 734 published cases have one of F above it (docs/campaign.md, Robustness)",
    )
    smooth_window: int = rule(
        7,
        "recorded depths that a local cubic is fitted to, to see steps [-]",
        "the fewest that leave it three degrees of freedom",
    )
    step_seen: float = rule(
        0.667,
        "part of a single step's height that such a window shows [-]",
        "the cubic follows the rest. The example of `quality.largest_step` plants one",
    )


RULES = CampaignRules()
"""Every tuned number of the stage."""
