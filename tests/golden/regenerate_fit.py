"""Freeze what the golden test refits, and what its fit gave; say why in the commit.

.venv/bin/python tests/golden/regenerate_fit.py data/campaign/space-{1,2}-1.h5
"""

import json
import sys
from dataclasses import fields
from pathlib import Path

import numpy as np
from dentscope.core import Material, Pair
from dentscope.fitting import fit_tables, read_sources, tables_of
from dentscope.fitting.table import ResidualTable, Table
from dentscope.models.closed_form import COEFFICIENTS

PLACE = Path(__file__).with_name("fit.json")
EVERY = 3


def columns(table):
    return {
        f.name: [float(f"{x:.6g}") for x in getattr(table, f.name)]
        for f in fields(table)
        if f.name not in ("pairs", "names")
    }


def plain(body):
    return [body.E, body.nu, body.Sy]


def content(paths):
    table, turns = tables_of(read_sources(paths))
    third = table.rows(np.arange(len(table.D)) % EVERY == 0)
    fit = fit_tables(third, turns)
    whole = fit_tables(table, turns)
    return {
        "pairs": [[plain(p.sphere), plain(p.flat), p.R] for p in table.pairs],
        "loading": columns(third),
        "unloading": columns(turns),
        "coefficients": dict(zip(COEFFICIENTS, fit.values.tolist(), strict=True)),
        "standard_errors": dict(zip(COEFFICIENTS, fit.standard_errors.tolist(), strict=True)),
        "coefficients_of_all_rows": dict(zip(COEFFICIENTS, whole.values.tolist(), strict=True)),
    }


def thawed():
    frozen = json.loads(PLACE.read_text())
    pairs = tuple(Pair(Material(*s), Material(*f), R) for s, f, R in frozen["pairs"])
    who = {"pairs": pairs, "names": tuple(f"frozen-{k}" for k in range(len(pairs)))}

    def table(kind, name):
        data = {k: np.array(v) for k, v in frozen[name].items()}
        data["case"] = data["case"].astype(np.int64)
        if "edge_seen" in data:
            data["edge_seen"] = data["edge_seen"].astype(bool)
        return kind(**data, **who)

    return table(Table, "loading"), table(ResidualTable, "unloading"), frozen


if __name__ == "__main__":
    PLACE.write_text(json.dumps(content([Path(p) for p in sys.argv[1:]])) + "\n")
    sys.stdout.write(f"{PLACE}\n")
