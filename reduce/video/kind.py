"""A video or a folder of pictures, read, tracked and drawn."""

from __future__ import annotations

from pathlib import Path

from ...core.errors import InputError
from ..images.clip import read_clip
from ..images.picture_file import crop_window
from ..measured import labelled
from ..reduced import Reduced
from .options import VideoOptions
from .picture import draw_video
from .reduction import Optics, reduce_video


def reduce(path: Path, options: VideoOptions) -> Reduced:
    """Track the striker and read its speeds before and after each contact."""
    last = options.last_frame
    if last is not None and last < options.first_frame:
        raise InputError(f"{last}", key="last_frame", allowed=f"{options.first_frame} or more")
    clip = read_clip(
        path, channel=options.channel, down=options.down, first=options.first_frame, last=last,
        crop=crop_window(options.crop),
    )  # fmt: skip
    optics = Optics(
        rate=options.frame_rate_hz, scale=options.pixel, size=options.diameter,
        ball=options.ball_of(options.diameter_m), line_time=options.line_time_s,
    )  # fmt: skip
    found = reduce_video(
        clip, optics, shape=options.shape, striker_is=options.striker_is,
        background=options.background,
    )  # fmt: skip
    trials, values = found.trials(), {"half_width_pixel": found.half_width, "pixel_m": found.scale}
    values |= labelled((t.label, t.observables) for t in trials)
    return Reduced(
        source=path, values=values, trials=trials, notes=found.notes,
        draw=lambda picture: draw_video(found, clip, picture),
        noise={"frame_rate_hz": found.optics.rate},
    )  # fmt: skip
