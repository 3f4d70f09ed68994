"""What is known of a body that bounces, as options of a reduction."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pydantic import Field

from ...core.inputs.toml_input import InputTable
from ..rules import RULES

if TYPE_CHECKING:
    from .fall import Ball, Fall

GRAVITY = 9.81


class BallOptions(InputTable):
    """Options that tell gravity and the drag of the air."""

    mass_kg: float | None = Field(
        None, gt=0.0, description="of the striker; with diameter_m the drag of the air is known"
    )
    drag_coefficient: float | None = Field(
        None, ge=0.0, description="of the ball in the air; default: that of a smooth sphere"
    )
    air_density_kg_m3: float | None = Field(
        None, ge=0.0, description="of the air; default: that at 20 °C"
    )
    gravity_m_s2: float = Field(GRAVITY, ge=0.01, le=1e4, description="acceleration of the fall")

    def ball_of(self, diameter: float | None) -> Ball:
        """Return the ball of a diameter [m], if that is known."""
        from ...core.drag import Fluid, air
        from .fall import Ball

        fluid = air()
        if self.air_density_kg_m3 is not None:
            fluid = Fluid(self.air_density_kg_m3, fluid.viscosity)
        return Ball(self.gravity_m_s2, self.mass_kg, diameter, fluid, self.drag_coefficient)


class BounceOptions(BallOptions):
    """What is known of a ball whose bounces are timed."""

    release_height_m: float | None = Field(
        None, gt=0.0, description="fall before the first contact, from rest, of the ball's bottom"
    )
    release_height_m_std: float = Field(0.0, ge=0.0, description="its standard deviation")
    contact_time_s: float = Field(
        0.0, ge=0.0, description="duration of a contact, which is not flight"
    )
    diameter_m: float | None = Field(
        None, gt=0.0, le=1.0, description="of the ball; with mass_kg drag of the air is taken off"
    )

    @property
    def ball(self) -> Ball:
        """What flies."""
        return self.ball_of(self.diameter_m)

    @property
    def left_out(self) -> tuple[str, ...]:
        """What is told of a ball whose drag is not known."""
        told = "drag of the air left out: give mass_kg and diameter_m to take it off"
        return (told,) if self.mass_kg is None or self.diameter_m is None else ()

    def fall_of(self, launch: float) -> Fall:
        """Return a flight launched at about a speed [m/s]; most of the drag acts near its ends."""
        return self.ball.fall(RULES.drag_speed * launch)
