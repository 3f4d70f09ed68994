"""Sound of a bouncing ball."""
