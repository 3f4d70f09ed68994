"""Malformed input to every reader: nothing but one line may come of it, soon and in little memory.

`python tests/faults/fuzz.py --inputs 5000` damages sound files by a seed, reads them in a child
that stays, and prints what each reader answered; `--raw` takes raw recordings of every kind. A
number of a TOML file that is replaced by what is none must be refused.
"""

import argparse
import contextlib
import os
import random
import sys
import tempfile
import time
import traceback
from pathlib import Path

import watched
from dentscope.core import InputError
from readers import RAW, READERS, lay_out


def made_input(number, seed, readers, sound={}):  # noqa: B006 - sound files are made once
    """Return the reader, content and whether it must be refused; the same for the same seed."""
    draw = random.Random(f"{seed}-{number}")
    name = list(readers)[number % len(readers)]
    if name not in sound:
        sound[name] = readers[name].make()
    content, refuse = readers[name].change(sound[name], draw)
    return name, content, refuse and readers[name].name.endswith(".toml")


def read_sound_files(readers):
    """Read what is not damaged; what is imported or compiled once is then no input's time."""
    for reader in readers.values():
        with tempfile.TemporaryDirectory() as folder:
            reader.read(lay_out(reader, reader.make(), Path(folder) / "set"))


def child(seed, first, last, readers):
    tell = watched.teller()
    read_sound_files(readers)
    for number in range(first, last):
        name, content, refuse = made_input(number, seed, readers)
        with tempfile.TemporaryDirectory() as folder:
            path = lay_out(readers[name], content, Path(folder) / "set")
            tell({"number": number, "reader": name})
            watched.forget_peak()
            started, where, printed = time.process_time(), "", []
            try:
                with screened(printed):
                    readers[name].read(path)
                told = "NONSENSE READ" if refuse else "read"
            except InputError as error:
                lines = str(error).splitlines()
                each = getattr(error, "errors", (error,))
                told = "refused with a line" if len(lines) == len(each) else "SEVERAL LINES"
                where = str(error)[:500]
            except BaseException as error:
                told = f"EXCEPTION {type(error).__name__}"
                where = "".join(traceback.format_exception(error)[-3:])
            seconds = time.process_time() - started
            if os.listdir(folder) != ["set"]:
                told = "WROTE OUTSIDE"
            if printed:
                told, where = "PRINTED", "".join(printed)[:500]
        shown = content[:300].decode("latin-1") if told[0].isupper() else ""
        tell({"told": told, "where": where, "seconds": seconds, "content": shown,
              "MB": watched.peak_mb()})  # fmt: skip


@contextlib.contextmanager
def screened(printed):
    """Keep words on the terminal, those too that compiled libraries write past `sys.stdout`."""
    sys.stdout.flush()
    kept = [os.dup(stream) for stream in (1, 2)]
    with tempfile.TemporaryFile() as screen:
        for stream in (1, 2):
            os.dup2(screen.fileno(), stream)
        try:
            yield
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            for stream, was in zip((1, 2), kept, strict=True):
                os.dup2(was, stream)
                os.close(was)
            screen.seek(0)
            printed += filter(None, [screen.read().decode("latin-1")])


def run(count, seed, *, first=0, raw=False, say=lambda line: None):
    more = ["--raw"] if raw else []
    return watched.run(count, seed, script=__file__, more=more, first=first, say=say)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--inputs", type=int, default=5000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--raw", action="store_true", help="raw recordings instead")
    parser.add_argument("--child", type=int)
    chosen = parser.parse_args()
    if chosen.child is not None:
        child(chosen.seed, chosen.child, chosen.inputs, RAW if chosen.raw else READERS)
        return

    def say(line):
        sys.stdout.write(f"{line}\n")
        sys.stdout.flush()

    counts, faults, most, _longest = run(
        chosen.inputs, chosen.seed, first=chosen.first, raw=chosen.raw, say=say
    )
    for name, found in counts.items():
        say(f"{name}: {dict(found)}")
    say(f"{len(faults)} faults; most memory {most:.0f} MB")


if __name__ == "__main__":
    main()
