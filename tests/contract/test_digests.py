"""What is published belongs together: the page of digests is what the files say."""

import runpy
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DIGESTS = runpy.run_path(str(ROOT / "tools" / "digests.py"))


def test_the_page_of_digests_is_what_the_files_say():
    told, found = DIGESTS["PAGE"].read_text(), DIGESTS["page"]()
    assert told == found, "run `python tools/digests.py`, after making anew what it names"


def test_the_coefficients_come_from_published_parts():
    assert all("-" in name and name.endswith(".h5") for name in DIGESTS["parts_read"]())


def test_the_challenge_was_drawn_from_these_coefficients():
    from dentscope.campaigns import read_curves
    from dentscope.models.coefficients import drawn_from

    fitted = drawn_from()
    names = [
        r.case.name
        for part in sorted((ROOT / "data" / "challenge").glob("*.h5"))
        for r in read_curves(part)
    ]
    assert len(names) == 24
    assert all(any(fitted.startswith(bit) for bit in name.split("-") if len(bit) > 5)
               for name in names), names[:2]  # fmt: skip
