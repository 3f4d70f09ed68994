"""Files of the tests: written in a line, read as rows."""

import csv


def put(path, text):
    """Write a file and the folder it lies in; return its path."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def rows_of(path):
    """Rows of a table by the names of its columns."""
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))
