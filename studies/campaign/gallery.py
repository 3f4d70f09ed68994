"""The campaign's gallery: stress fields, the five cases over Sy*, the force of all cases."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...campaigns import RULES, CaseRecord, read_curves
from ...core.arrays import Array
from ...core.material import Pair
from ...core.output import write_file
from ..plot import Picture, finish, sheet
from .sweep import DEPTH, Sweep, sweeps

_HEAD = """# Gallery of the campaign

Made by `dentscope campaign gallery` from {rests}. Points are finite-element cases, lines join them.
"""
_PICTURE_CASES = (("2.2", 0.1), ("2.3", 1.0), ("2.4", 10.0))


def build(source: Path, folder: Path, *, fields: Path) -> list[Picture]:
    """Draw the gallery of a campaign into `folder`, with a README.md.

    Parameters
    ----------
    source
        Campaign file, part, or folder of parts.
    folder
        Where the pictures go.
    fields
        Folder of the field files that a run wrote; figures 2.2 to 2.4 need them.

    Raises
    ------
    InputError
        The file is missing or damaged.
    """
    records = [r for r in read_curves(source) if r.case.pair.perfectly_plastic]
    drawn = [*_fields(records, fields), *pictures(records)]
    for picture in drawn:
        picture.save(folder)
    lines = [_HEAD.format(rests=f"{len(records)} completed cases")]
    for one in drawn:
        name = f"Figure {one.number}" if one.number[0].isdigit() else one.number.capitalize()
        lines.append(f"## {name}: {one.title}\n\n![{one.title}]({one.file})\n\n{one.note}\n")
    if not any(picture.number == "2.2" for picture in drawn):
        lines.append(
            "Figures 2.2 to 2.4 are drawn where the design `thesis` was run: its first three cases "
            "write their fields beside its cases.\n"
        )
    write_file(folder / "README.md", "\n".join(lines))
    return drawn


def pictures(records: Sequence[CaseRecord]) -> list[Picture]:
    """Draw what the curves of a campaign show."""
    found = sweeps(records)
    return [
        _over_ratio(found, "2.5", "share", "delta_s*", "Share of the sphere"),
        _over_ratio(found, "2.6", "radius", "a/R", "Contact radius"),
        _over_ratio(found, "2.7", "pressure", "p/Sy_min", "Mean pressure"),
        _over_ratio(found, "2.8", "force", "F/(E' R^2)", "Contact force"),
        _all_forces(records),
        _quality(records),
    ]


def _over_ratio(found: dict[int, Sweep], number: str, name: str, label: str, title: str) -> Picture:
    made, (axis,) = sheet()
    for case, sweep in found.items():
        axis.semilogx(
            sweep.ratio, getattr(sweep, name), "o-", ms=3, lw=1.0, color=f"C{case}",
            label=f"case {case}",
        )  # fmt: skip
    axis.axvline(1.0, color="0.5", ls=":", lw=1.0)
    finish(axis, x="Sy* = Sy_sphere/Sy_flat", y=label)
    count = sum(len(sweep.ratio) for sweep in found.values())
    note = f"{count} cases of Table 2.1 at Delta/R = {DEPTH:g}."
    if not found:
        note = "No case of Table 2.1 is computed yet."
    return Picture(number, f"{title} of the five cases, Delta/R = {DEPTH:g}", made, note)


def _all_forces(records: Sequence[CaseRecord]) -> Picture:
    import matplotlib as mpl

    made, (axis,) = sheet()
    colours = mpl.colormaps["coolwarm"]
    norm = mpl.colors.Normalize(-1.0, 1.0)
    reach = 1.0
    for record in records:
        w, f = _reduced(record)
        ratio = float(np.clip(np.log10(record.case.pair.Sy_ratio), -1.0, 1.0))
        axis.loglog(w, f, lw=0.6, color=colours(norm(ratio)))
        reach = max(reach, float(w[-1]))
    elastic = np.geomspace(0.3, reach, 50)
    axis.loglog(elastic, elastic**1.5, "k:", lw=1.0, label="Hertz")
    made.colorbar(mpl.cm.ScalarMappable(norm, colours), ax=axis, label="log10 Sy*")
    finish(axis, x="delta/delta_c", y="F/F_c")
    note = (
        f"{len(records)} cases, to delta/delta_c = {reach:.3g}; blue: weak sphere, red: weak flat."
    )
    return Picture("all", "Force of all cases over the depth", made, note)


def _reduced(record: CaseRecord) -> tuple[Array, Array]:
    """delta/delta_c and F/F_c; a body that never yields is scaled with Delta/R = 1e-4."""
    pair, curve = record.case.pair, record.curve
    onset = pair.first_yield
    depth = (onset if np.isfinite(onset) else 1e-4) * pair.R
    unit = 4.0 / 3.0 * pair.E_reduced * np.sqrt(pair.R) * depth**1.5
    return curve["delta"] / depth, curve["force"] / unit


def _quality(records: Sequence[CaseRecord]) -> Picture:
    made, axes = sheet(2)
    quality = [record.quality for record in records]
    soft = [_softness(record.case.pair) for record in records]
    for axis, name, mark, words in (
        (axes[0], "energy_defect", RULES.energy_defect, "largest energy defect"),
        (axes[1], "largest_step", RULES.step, "largest step of F, a or delta_s*"),
    ):
        values = [getattr(one, name) for one in quality]
        axis.loglog(soft, values, "k.", ms=4)
        axis.axhline(mark, color="C3", lw=1.0, label=f"mark, {mark:.1%}")
        finish(axis, x="E'/Sy_min", y=words)
    over = [
        sum(one.energy_defect > RULES.energy_defect for one in quality),
        sum(one.largest_step > RULES.step for one in quality),
    ]
    note = f"Above the marks: {over[0]} and {over[1]} of {len(records)} cases."
    return Picture("quality", "Energy balance and smoothness of every case", made, note)


def _softness(pair: Pair) -> float:
    return pair.E_reduced / pair.Sy_min if np.isfinite(pair.Sy_min) else np.nan


def _fields(records: Sequence[CaseRecord], folder: Path) -> list[Picture]:
    """Figures 2.2 to 2.4, from the field files that a run wrote."""
    drawn = []
    for number, ratio in _PICTURE_CASES:
        for record in records:
            files = sorted(folder.glob(f"{record.id[:16]}-*.vtu"))
            if files and abs(np.log(record.case.pair.Sy_ratio / ratio)) < 1e-6:
                drawn.append(_section(number, record, files[0]))
                break
    return drawn


def _section(number: str, record: CaseRecord, file: Path) -> Picture:
    import meshio
    from matplotlib.collections import PolyCollection

    pair = record.case.pair
    mesh = meshio.read(file)
    points, quads = mesh.points[:, :2] / pair.R, mesh.cells[0].data
    stress = mesh.cell_data["von_mises_Pa"][0] / pair.Sy_min
    depth = float(file.stem.rsplit("-", 1)[1])
    edge = float(np.interp(depth, record.curve["delta"] / pair.R, record.curve["radius"] / pair.R))
    extent = 2.5 * edge
    near = np.hypot(*points[quads].mean(axis=1).T) < 2.0 * extent
    made, (axis,) = sheet(size=(7.0, 5.6))
    for side in (1.0, -1.0):
        drawn = PolyCollection(
            list(points[quads[near]] * np.array([side, 1.0])), array=stress[near], cmap="turbo",
            clim=(0.0, 1.0), edgecolors="face", linewidths=0.2,
        )  # fmt: skip
        axis.add_collection(drawn)
    made.colorbar(drawn, ax=axis, label="von Mises stress / Sy_min", extend="max")
    axis.set_xlim(-extent, extent)
    axis.set_ylim(-extent, extent)
    axis.set_aspect("equal")
    finish(axis, x="r/R", y="z/R")
    axis.grid(visible=False)
    body = np.asarray(mesh.cell_data["body"][0])
    strain = np.asarray(mesh.cell_data["plastic_strain"][0])
    most = [float(strain[body == k].max(initial=0.0)) for k in (0, 1)]
    note = (
        f"Delta/R = {depth:g}, a/R = {edge:.3f}; largest plastic strain {most[0]:.3f} in the "
        f"sphere, {most[1]:.3f} in the flat."
    )
    title = f"Von Mises stress, Sy* = {pair.Sy_ratio:g}, Sy_min = {pair.Sy_min / 1e6:g} MPa"
    return Picture(number, title, made, note)
