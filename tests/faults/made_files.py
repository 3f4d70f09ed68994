"""Files of the tests: written in a line, read as rows."""

import csv
import tomllib


def put(path, text):
    """Write a file and the folder it lies in; return its path."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def rows_of(path):
    """Rows of a table by the names of its columns."""
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def changed(content, changes):
    """A copy of tables with keys set, or left out where None; a dot leads into a table."""
    content = dict(content)
    for key, value in changes.items():
        first, _, rest = key.partition(".")
        value = {rest: value} if rest else value
        if isinstance(value, dict) and isinstance(content.get(first, {}), dict):
            content[first] = changed(content.get(first, {}), value)
        elif value is None:
            content.pop(first, None)
        else:
            content[first] = value
    return content


def with_key(text, table, name, value):
    """Tables of a file with one key set; the striker of a table's NAME is the ball."""
    added = tomllib.loads(f"{table.replace('NAME', 'ball')}\n{name} = {value}")
    return changed(tomllib.loads(text), added)
