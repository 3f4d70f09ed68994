"""The short form of `tools/benchmarks/fuzz_raw.py`: files of a drawn grammar, reduced or refused.

What damages sound files is `fuzz.py --raw`.
"""

import importlib.util
import warnings
from collections import Counter
from pathlib import Path

import fuzz
import pytest
from dentscope.core import InputError

_FILE = Path(__file__).parents[2] / "tools" / "benchmarks" / "fuzz_raw.py"
_SPEC = importlib.util.spec_from_file_location("fuzz_raw", _FILE)
raw = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(raw)


def test_the_same_seed_makes_the_same_file():
    first, second = (fuzz.made_input(5, 3, raw.READERS, {}) for _ in range(2))
    assert first == second


@pytest.mark.parametrize("name", raw.FILES)
def test_a_drawn_file_is_reduced_or_refused_in_a_line(name, tmp_path):
    told, lines = Counter(), []
    place = list(raw.FILES).index(name)
    for number in range(place, 8 * len(raw.FILES), len(raw.FILES)):
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Duplicate name")  # of the archive that is written
            _name, content, _ = fuzz.made_input(number, 7, raw.READERS, {name: b""})
        path = fuzz.lay_out(raw.READERS[name], content, tmp_path / str(number))
        try:
            raw.READERS[name].read(path)
            told["read"] += 1
        except InputError as error:
            each = getattr(error, "errors", (error,))
            lines.append(len(str(error).splitlines()) / len(each))
            told["refused"] += 1
    assert told.total() == 8
    assert set(lines) <= {1.0}
