"""Every dataset of a case's file: its unit, axes and meaning.

A file holds one case: the attributes `id`, `status` (`done` or `failed`), `specification` and
`environment` (JSON) and the datasets below; the loading curve under `loading`, unloadings under
`unload-1`, `unload-2`, ... in the order of their depth; contact pressure and surfaces at ten depths
under `profiles`, in single precision and out to twice the contact radius; rows end with NaN where a
profile has fewer nodes than the longest. The first 512 bytes hold the SHA-256 of the rest (see
`campaigns.contents`).
"""

from __future__ import annotations

from dataclasses import dataclass

FORMAT = "dentscope-case/3"


@dataclass(frozen=True)
class Dataset:
    """Unit, axes and meaning of one dataset."""

    unit: str
    axes: tuple[str, ...]
    meaning: str


CURVE: dict[str, Dataset] = {
    "delta": Dataset("m", ("depth",), "approach of the driven face, Delta"),
    "force": Dataset("N", ("depth",), "normal force F, reaction at the driven face"),
    "radius": Dataset("m", ("depth",), "contact radius a, from the opening gap"),
    "radius_last_node": Dataset("m", ("depth",), "radius of the last node in contact"),
    "sphere": Dataset("m", ("depth",), "displacement of the pole in the sphere, delta_s"),
    "flat": Dataset("m", ("depth",), "displacement of the flat below the pole, delta_f"),
    "hardness": Dataset("Pa", ("depth",), "mean pressure F/(pi a^2)"),
    "force_defect": Dataset("1", ("depth",), "(contact force - reaction)/reaction"),
    "energy_defect": Dataset("1", ("depth",), "(work - stored - dissipated)/work"),
    "dissipated": Dataset("J", ("depth",), "plastic work so far"),
}

UNLOADING_PROFILES: dict[str, Dataset] = {
    "crater_r": Dataset("m", ("node",), "radius of the flat's surface nodes, force-free"),
    "crater_z": Dataset("m", ("node",), "height of the flat's surface, force-free"),
    "tip_r": Dataset("m", ("node",), "radius of the sphere's surface nodes, force-free"),
    "tip_z": Dataset("m", ("node",), "height of the sphere's surface, its top at rest"),
}

PROFILES: dict[str, Dataset] = {
    "depth": Dataset("1", ("profile",), "Delta/R"),
    "sphere_r": Dataset("m", ("profile", "node"), "radius of the sphere's surface nodes"),
    "sphere_z": Dataset("m", ("profile", "node"), "height of the sphere's surface"),
    "pressure": Dataset("Pa", ("profile", "node"), "contact pressure on the current area"),
    "flat_r": Dataset("m", ("profile", "node"), "radius of the flat's surface nodes"),
    "flat_z": Dataset("m", ("profile", "node"), "height of the flat's surface"),
}
