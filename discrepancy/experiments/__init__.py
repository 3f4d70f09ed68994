"""What to measure next, within what the rig can do."""
