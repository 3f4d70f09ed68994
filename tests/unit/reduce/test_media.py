"""A film or a sound is read from the file that is named, and from no other."""

import wave

import pytest
from dentscope.core import InputError
from dentscope.reduce.shared.media import container_of
from dentscope.reduce.sound.file import _decoded, read_sound

pytest.importorskip("av")


def test_a_playlist_opens_no_other_file(tmp_path):
    (tmp_path / "private").mkdir()
    with wave.open(str(tmp_path / "private" / "x.wav"), "wb") as sound:
        sound.setnchannels(1)
        sound.setsampwidth(2)
        sound.setframerate(8000)
        sound.writeframes(b"\0\0" * 800)
    assert len(_decoded(tmp_path / "private" / "x.wav")[0]) == 800
    with wave.open(str(tmp_path / "empty.wav"), "wb") as sound:
        sound.setparams((1, 2, 8000, 0, "NONE", ""))
    with pytest.raises(InputError, match="silence"):
        read_sound(tmp_path / "empty.wav")
    listed = tmp_path / "list.mp3"
    listed.write_text("ffconcat version 1.0\nfile private/x.wav\n")
    with (
        pytest.raises(InputError, match=r"list\.mp3: cannot be decoded"),
        container_of(listed, "sounds", "WAV") as container,
    ):
        list(container.decode(audio=0))
