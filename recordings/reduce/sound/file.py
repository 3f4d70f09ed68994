"""Sound as one channel of samples: audio files, and the sound track of a video."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ....core.errors import InputError, missing_extra
from ..measured import Array

_LONGEST = 600.0
"""Seconds of sound that are taken in."""


@dataclass(frozen=True)
class Sound:
    """One channel of sound.

    Parameters
    ----------
    samples
        (n,), full scale is 1.
    rate
        Samples per second [1/s].
    clipped
        Part of the samples at full scale.
    source
        The file.
    """

    samples: Array
    rate: float
    clipped: float
    source: str

    @property
    def time(self) -> Array:
        """Time of each sample from the beginning of the file, (n,) [s]."""
        return np.arange(self.samples.size) / self.rate


def read_sound(path: Path) -> Sound:
    """Read an audio file (anything FFmpeg decodes: WAV, FLAC, MP3, M4A) or a video's sound.

    Raises
    ------
    InputError
        No sound that can be decoded, silence, or more than ten minutes.
    """
    try:
        import av
    except ImportError:
        raise missing_extra("reading sound", "video") from None
    if not path.is_file():
        raise InputError("no such file", source=str(path), allowed="an audio file or a video")
    parts: list[Array] = []
    total = 0
    try:
        with av.open(str(path)) as container:
            if not container.streams.audio:
                raise InputError("no sound in it", source=str(path), allowed="an audio file")
            stream = container.streams.audio[0]
            rate = int(stream.rate)
            mono = av.AudioResampler(format="flt", layout="mono", rate=rate)
            for frame in container.decode(stream):
                for piece in mono.resample(frame):
                    parts.append(piece.to_ndarray().ravel().astype(np.float64))
                    total += parts[-1].size
                if total > _LONGEST * rate:
                    raise InputError(
                        f"more than {_LONGEST / 60.0:g} minutes", source=str(path),
                        allowed="a shorter recording",
                    )  # fmt: skip
    except av.FFmpegError as error:
        text = getattr(error, "strerror", None) or type(error).__name__
        raise InputError(
            f"cannot be decoded ({text})", source=str(path), allowed="WAV, FLAC, OGG, MP3, M4A"
        ) from None
    samples = np.concatenate(parts) if parts else np.empty(0)
    if samples.size == 0 or not np.isfinite(samples).all() or np.ptp(samples) == 0.0:
        raise InputError("silence", source=str(path), allowed="the sound of bounces")
    clipped = float(np.mean(np.abs(samples) >= 0.999 * max(1.0, float(np.abs(samples).max()))))
    return Sound(samples, float(rate), clipped, str(path))
