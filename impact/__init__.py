"""Stage impact: a sphere or a round-ended rod striking a flat."""
