"""What every test has in common: neither its terminal nor other packages beside ours have a say."""

from importlib.metadata import EntryPoints

import pytest
from dentscope.cli import run
from dentscope.core.inputs import added


@pytest.fixture(autouse=True, scope="session")
def alone():
    """Eighty columns without colour, and no laws, mechanisms or readers of other packages."""
    with pytest.MonkeyPatch.context() as here:
        here.setenv("COLUMNS", "80")
        here.delenv("FORCE_COLOR", raising=False)
        here.setattr(added, "entry_points", EntryPoints(()).select)
        yield


def ends(capsys, code):
    """Return what runs a command that must end with `code`, and gives what it prints."""

    def told(*words):
        capsys.readouterr()
        ended, told = run([*map(str, words)]), capsys.readouterr()
        assert ended == code, told.out + told.err
        return told

    return told


@pytest.fixture
def prints(capsys):
    """Runs a command that must succeed; returns what it prints."""
    told = ends(capsys, 0)
    return lambda *words: told(*words).out


@pytest.fixture
def errs(capsys):
    """Runs a command that must be refused; returns what it says on standard error."""
    told = ends(capsys, 2)
    return lambda *words: told(*words).err
