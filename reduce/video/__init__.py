"""High-speed video of a ball or a rod."""
