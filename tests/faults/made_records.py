"""Made-up records for the tests: a pulse of 4 ms on noise, written as a table."""

import numpy as np
import pytest
from dentscope.reduce.gates import Refused
from dentscope.reduce.kinds import load_kind

RATE = 10_000.0
T = np.arange(0.0, 0.05, 1.0 / RATE)


def half_sine(peak=800.0, long=4e-3, at=0.02, noise=1.0, seed=3):
    s = np.clip((T - at) / long, 0.0, 1.0)
    return peak * np.sin(np.pi * s) + np.random.default_rng(seed).normal(0.0, noise, T.size)


def run(path, **given):
    return load_kind("table").run(path, {"holds": "force", **given}, source="test")


def refused(call, look="", by=Refused):
    try:
        call()
    except by as error:
        return look in error.message
    return False


def table(path, cells, head="time_s,force_N", times=None):
    times = [f"{t:.4f}" for t in T] if times is None else times
    path.write_text(
        "\n".join([head, *(f"{t},{c}" for t, c in zip(times, cells, strict=True))]), "utf-8"
    )
    return path


def recorded(path, value):
    return table(path, [f"{v:.3f}" for v in value])


def workbook(path, rows, merged=(), title="Sheet", **others):
    """Rows of the first sheet, whose cells may be merged, and of others by their names."""
    book = pytest.importorskip("openpyxl").Workbook()
    book.active.title = title
    for name, cells in {title: rows, **others}.items():
        sheet = book.active if name == title else book.create_sheet(name)
        for row in cells:
            sheet.append(row)
    for area in merged:
        book.active.merge_cells(area)
    book.save(path)
    return path


def tracker_project(points, *, delta_t="5.0", angle=0.0):
    cls = "org.opensourcephysics.cabrillo.tracker.PointMass"
    frames = "".join(
        f'<property name="[{k}]" type="object"><object class="{cls}$FrameData">'
        f'<property name="n" type="int">{k}</property>'
        f'<property name="x" type="double">{x}</property>'
        f'<property name="y" type="double">{y}</property></object></property>'
        for k, (x, y) in points.items()
    )
    axes = "org.opensourcephysics.media.core.ImageCoordSystem$FrameData"
    return (
        '<?xml version="1.0" encoding="UTF-8"?>'
        '<object class="org.opensourcephysics.cabrillo.tracker.TrackerPanel">'
        f'<property name="delta_t" type="double">{delta_t}</property>'
        f'<property name="coords"><object class="{axes}">'
        '<property name="xorigin" type="double">100.0</property>'
        '<property name="yorigin" type="double">200.0</property>'
        f'<property name="angle" type="double">{angle}</property>'
        '<property name="xscale" type="double">500.0</property>'
        '<property name="yscale" type="double">500.0</property></object></property>'
        f'<property name="tracks"><object class="{cls}"><property name="name">ball</property>'
        f'<property name="framedata">{frames}</property></object></property></object>'
    )
