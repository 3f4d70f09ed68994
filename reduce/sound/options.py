"""Options of the reduction of a sound."""

from __future__ import annotations

from pydantic import Field

from ..bounces.options import BounceOptions
from ..shared.time_window import TimeWindow


class SoundOptions(BounceOptions, TimeWindow):
    """Options of the reduction of a sound."""

    least_rise_db: float = Field(
        12.0, gt=0.0, description="rise of the energy within a millisecond that counts as a contact"
    )
    least_interval_s: float = Field(
        0.02, gt=0.0, description="shortest time between two contacts; echoes come sooner"
    )
    lowest_hz: float = Field(300.0, gt=0.0, description="lower frequencies are taken out")


Options = SoundOptions
"""By this name a kind is found."""
