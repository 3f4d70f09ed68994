"""What is known of a body that bounces, as options of a reduction."""

from __future__ import annotations

from pydantic import Field

from ....core.drag import Fluid, air
from ....core.toml_input import InputTable
from .fall import Ball

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
    gravity_m_s2: float = Field(GRAVITY, gt=0.0, description="acceleration of the fall")

    def ball_of(self, diameter: float | None) -> Ball:
        """Return the ball of a diameter [m], if that is known."""
        fluid = air()
        if self.air_density_kg_m3 is not None:
            fluid = Fluid(self.air_density_kg_m3, fluid.viscosity)
        return Ball(self.gravity_m_s2, self.mass_kg, diameter, fluid, self.drag_coefficient)
