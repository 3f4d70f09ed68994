"""Pictures and clips: frames, the body in them, its edge to a part of a pixel."""
