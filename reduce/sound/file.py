"""Sound as one channel of samples: audio files, and the sound track of a video."""

from __future__ import annotations

import struct
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.arrays import Array
from ...core.errors import InputError
from ..shared.media import container_of

# limit: sound that is taken in [s]: memory of a small machine
_SOUND_S = 600.0


@dataclass(frozen=True)
class Sound:
    """One channel of sound: samples (n,) of full scale 1, rate [1/s], part at full scale."""

    samples: Array
    rate: float
    clipped: float
    source: str

    @property
    def time(self) -> Array:
        """Time of each sample from the beginning of the file, (n,) [s]."""
        return np.arange(self.samples.size) / self.rate


def read_sound(path: Path) -> Sound:
    """Read an audio file or a video's sound: WAV by itself, else whatever FFmpeg decodes.

    Refuses what cannot be decoded, silence, and more than ten minutes.
    """
    with path.open("rb") as stream:
        plain = stream.read(4) in (b"RIFF", b"RIFX") and path.suffix.lower() == ".wav"
    samples, rate = _wave(path) if plain else _decoded(path)
    if samples.size == 0 or not np.isfinite(samples).all() or np.ptp(samples) == 0.0:
        raise InputError("silence", source=str(path), allowed="the sound of bounces")
    clipped = float(np.mean(np.abs(samples) >= 0.999 * max(1.0, float(np.abs(samples).max()))))
    return Sound(samples, rate, clipped, str(path))


def _wave(path: Path) -> tuple[Array, float]:
    """Return samples and rate of a WAV file, its channels mixed, full scale 1."""
    from scipy.io import wavfile

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # chunks that are not samples
            rate, found = wavfile.read(path, mmap=False)
    except UnboundLocalError:  # scipy's answer to a file without a header of its format
        raise InputError(
            "no header of its format", source=str(path), allowed="a whole WAV file"
        ) from None
    except (ValueError, OSError, EOFError, struct.error, ZeroDivisionError, MemoryError) as error:
        raise InputError(
            f"cannot be decoded ({error})", source=str(path), allowed="a whole WAV file"
        ) from None
    if not 0 < rate < 10_000_000:
        raise InputError(f"{rate} samples a second", source=str(path), allowed="a WAV file")
    _check_length(found.shape[0], rate, path)
    samples = found.astype(np.float64)
    if found.dtype == np.uint8:
        samples = (samples - 128.0) / 128.0
    elif found.dtype.kind == "i":
        samples /= float(np.iinfo(found.dtype).max) + 1.0
    return _mixed(samples), float(rate)


def _mixed(samples: Array) -> Array:
    """Mean of channels (n, channels), each as it swings with the loudest: some are turned."""
    if samples.ndim == 1 or samples.shape[1] == 1:
        return samples.ravel()
    loudest = samples[:, int(np.argmax(samples.var(axis=0)))]
    turned = (samples - samples.mean(axis=0)).T @ (loudest - loudest.mean()) < 0.0
    return np.asarray((samples * np.where(turned, -1.0, 1.0)).mean(axis=1))


def _check_length(count: int, rate: float, path: Path) -> None:
    if count > _SOUND_S * rate:
        said = f"more than {_SOUND_S / 60.0:g} minutes"
        raise InputError(said, source=str(path), allowed="a shorter recording")


def _decoded(path: Path) -> tuple[Array, float]:
    """Return samples and rate of what FFmpeg decodes."""
    parts: list[Array] = []
    total = 0
    with container_of(path, "sound other than WAV", "WAV, FLAC, OGG, MP3, M4A") as container:
        if not container.streams.audio:
            raise InputError("no sound in it", source=str(path), allowed="an audio file")
        import av

        stream = container.streams.audio[0]
        rate = int(stream.rate)
        planes = av.AudioResampler(format="fltp", rate=rate)
        for frame in container.decode(stream):
            for piece in planes.resample(frame):
                parts.append(piece.to_ndarray().T.astype(np.float64))
                total += len(parts[-1])
            _check_length(total, rate, path)
    return _mixed(np.concatenate(parts)) if parts else np.empty(0), float(rate)
