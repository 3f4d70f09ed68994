"""Tables of force, acceleration, height, bounce times or trials."""
