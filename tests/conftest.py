"""What every test has in common: neither its terminal nor other packages beside ours have a say."""

from importlib.metadata import EntryPoints

import pytest
from dentscope.core.inputs import added


@pytest.fixture(autouse=True, scope="session")
def alone():
    """Eighty columns without colour, and no laws, mechanisms or readers of other packages."""
    with pytest.MonkeyPatch.context() as here:
        here.setenv("COLUMNS", "80")
        here.delenv("FORCE_COLOR", raising=False)
        here.setattr(added, "entry_points", EntryPoints(()).select)
        yield
