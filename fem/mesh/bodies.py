"""Axisymmetric meshes of the hemisphere and the half-space, made by gmsh.

Both bodies are meshed by the same log-polar scheme about the first contact point: an inner block of
three transfinite patches, then rings of one element each, whose nodes divide their arcs as the
block's do. The hemisphere ends in one block up to its flat top face, the half-space in rings that
grow out to its far boundary.
"""

from __future__ import annotations

import ctypes
import hashlib
import math
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...core.arrays import Array, Integers
from ...core.errors import InputError
from ..rules import RULES

# limit: coordinates below this lie on the axis [R]: round-off
_ON_AXIS = 1e-13


@dataclass(frozen=True)
class Mesh:
    """Quadrilaterals of the two bodies in one numbering; the sphere's nodes come first.

    - `points`: coordinates (r, z), shape (n_nodes, 2) [R]. The flat is z <= 0, the pole is the
      origin.
    - `quads`: node numbers, counter-clockwise, shape (n_elements, 4).
    - `n_sphere_points`, `n_sphere_quads`: how many nodes and elements belong to the sphere.
    - `sphere_surface`, `flat_surface`: surface nodes of the bodies, from the axis outwards.
    - `top`, `far`: nodes of the hemisphere's flat top face and of the half-space's far boundary.
    - `rings`, `far_rings`: radii of the rings of both bodies, and of the half-space beyond them
      [R].
    """

    points: Array
    quads: Integers
    n_sphere_points: int
    n_sphere_quads: int
    sphere_surface: Integers
    flat_surface: Integers
    top: Integers
    far: Integers
    rings: Array
    far_rings: Array

    @property
    def digest(self) -> str:
        """SHA-256 of the mesh, its coordinates rounded to 12 digits."""
        text = hashlib.sha256(np.round(self.points, 12).tobytes())
        text.update(self.quads.tobytes())
        return text.hexdigest()


def contact_mesh(*, rings: Array, far_rings: Array, divisions: int, crowding: float = 1.0) -> Mesh:
    """Mesh both bodies.

    - `rings`: ring radii of both bodies (chord distance from the first contact point) [R]; up to
      the last one the two surfaces can touch.
    - `far_rings`: further rings of the half-space.
    - `divisions`: elements over the quarter arc, even.
    - `crowding`: angle of the elements at the axis over that at the surface.
    """
    layers = _Layers(divisions, crowding ** (1.0 / (divisions - 1)))
    p_s, q_s = _body(rings, layers, sphere=True)
    p_f, q_f = _body(np.concatenate([rings, far_rings]), layers, sphere=False)
    n = len(p_s)
    r, z = np.vstack([p_s, p_f]).T
    chord = np.hypot(r, z)
    node = np.arange(len(r))
    ball = (node < n) & (np.abs(np.hypot(r, z - 1.0) - 1.0) < 1e-9) & (z < 0.999)
    plane = (node >= n) & (np.abs(z) < 1e-12)
    outer = np.flatnonzero(ball & (chord < rings[-1] * (1.0 + 1e-9)))
    upper = np.flatnonzero(plane & (r < 2.0 * rings[-1]))
    return Mesh(
        points=np.column_stack([r, z]),
        quads=np.vstack([q_s, q_f + n]),
        n_sphere_points=n,
        n_sphere_quads=len(q_s),
        sphere_surface=outer[np.argsort(r[outer])],
        flat_surface=upper[np.argsort(r[upper])],
        top=np.flatnonzero((node < n) & (z > 1.0 - 1e-9)),
        far=np.flatnonzero((node >= n) & (chord > far_rings[-1] * (1.0 - 1e-9))),
        rings=rings,
        far_rings=far_rings,
    )


@contextmanager
def _session() -> Iterator[Any]:
    try:
        import gmsh
    except OSError as missing:
        raise InputError(
            f"gmsh cannot start: {missing}",
            source="system libraries",
            allowed="run `make install`, which names the missing packages",
        ) from None
    started = not gmsh.isInitialized()
    if started:
        # interruptible=False: gmsh would otherwise take over the signal handler, which only the
        # main thread may do
        with _signals_as_before():
            gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add("body")
    try:
        yield gmsh
    finally:
        gmsh.model.remove()
        if started:
            gmsh.finalize()


@contextmanager
def _signals_as_before() -> Iterator[None]:
    """Undo what gmsh does to SIGPIPE and SIGTERM: it lets both end the process without a word.

    A coordinator whose worker was killed died of the first, and so does whoever serves or asks over
    a socket; with the second a command leaves its workers behind. `signal.signal` may be called by
    the main thread alone, and does not see gmsh's change.
    """
    libc = ctypes.CDLL(None)
    libc.signal.restype, libc.signal.argtypes = ctypes.c_void_p, [ctypes.c_int, ctypes.c_void_p]
    before = {n: libc.signal(n, int(signal.SIG_IGN)) for n in (signal.SIGPIPE, signal.SIGTERM)}
    for number, handler in before.items():
        libc.signal(number, handler)  # none is lost meanwhile
    try:
        yield
    finally:
        for number, handler in before.items():
            libc.signal(number, handler)
            signal.siginterrupt(number, True)  # a wait ends, as with Python's own handlers


class _Sketch:
    """Points, curves and transfinite patches of one body, each made once."""

    def __init__(self, gmsh: Any, sphere: bool) -> None:
        self.geo = gmsh.model.geo
        self.sphere = sphere
        self.sign = 1.0 if sphere else -1.0
        self.points: dict[tuple[float, float], int] = {}
        self.centre = self.point(0.0, 1.0) if sphere else 0
        self.origin = self.point(0.0, 0.0)

    def point(self, r: float, z: float) -> int:
        key = (round(r, 14), round(z, 14))
        if key not in self.points:
            self.points[key] = self.geo.addPoint(r, z, 0.0)
        return self.points[key]

    def on_surface(self, rho: float) -> int:
        if not self.sphere:
            return self.point(rho, 0.0)
        angle = 2.0 * math.asin(rho / 2.0)
        return self.point(math.sin(angle), 1.0 - math.cos(angle))

    def on_axis(self, rho: float) -> int:
        return self.point(0.0, self.sign * rho)

    def line(self, a: int, b: int, n: int, ratio: float = 1.0) -> int:
        tag = int(self.geo.addLine(a, b))
        self.geo.mesh.setTransfiniteCurve(tag, n + 1, "Progression", ratio)
        return tag

    def arc(self, a: int, centre: int, b: int, n: int, ratio: float = 1.0) -> int:
        tag = int(self.geo.addCircleArc(a, centre, b))
        self.geo.mesh.setTransfiniteCurve(tag, n + 1, "Progression", ratio)
        return tag

    def surface(self, a: int, b: int, n: int, ratio: float = 1.0) -> int:
        if self.sphere:
            return self.arc(a, self.centre, b, n, ratio)
        return self.line(a, b, n, ratio)

    def patch(self, curves: list[int], corners: list[int]) -> None:
        tag = self.geo.addPlaneSurface([self.geo.addCurveLoop(curves)])
        self.geo.mesh.setTransfiniteSurface(tag, "Left", corners)
        self.geo.mesh.setRecombine(2, tag)


@dataclass(frozen=True)
class _Layers:
    """How the quarter arc is divided: so many elements, each `ratio` times as wide as the last."""

    divisions: int
    ratio: float

    @property
    def half(self) -> int:
        return self.divisions // 2

    @cached_property
    def fractions(self) -> Array:
        """Of the arc, from the surface to each node."""
        widths = self.ratio ** np.arange(self.divisions)
        return np.append(0.0, np.cumsum(widths) / widths.sum())


def _body(radii: Array, layers: _Layers, *, sphere: bool) -> tuple[Array, Integers]:
    """Blocks by gmsh at the first contact point and above the sphere's last ring; rings between."""
    with _session() as gmsh:
        sketch = _Sketch(gmsh, sphere)
        _inner_block(sketch, radii[0], layers)
        if sphere:
            _top_block(sketch, radii[-1], layers)
        sketch.geo.synchronize()
        gmsh.model.mesh.generate(2)
        points, quads = _points_and_quads(gmsh)
    # a ring of elements has nodes on its two arcs alone: meshes share those of common rings
    free = radii[1:-1] if sphere else radii[1:]
    numbers = len(points) + np.arange(len(free) * (layers.divisions + 1))
    rows = [_row(points, radii[0]), *numbers.reshape(len(free), -1)]
    if sphere:
        rows.append(_row(points, radii[-1]))
    points = np.vstack([points, *(_arc(r, layers, sphere=sphere) for r in free)])
    points[np.abs(points) < _ON_AXIS] = 0.0
    inner, outer = np.array(rows[:-1]), np.array(rows[1:])
    around = [inner[:, :-1], outer[:, :-1], outer[:, 1:], inner[:, 1:]]
    quads = np.vstack([quads, np.stack(around, axis=-1).reshape(-1, 4)])
    x = points[quads]
    a, b = x[:, 2] - x[:, 0], x[:, 3] - x[:, 1]
    clockwise = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] < 0.0
    quads[clockwise] = quads[clockwise][:, ::-1]
    return points, quads


def _row(points: Array, radius: float) -> Integers:
    """Nodes of a block on an arc, from the surface to the axis."""
    found = np.flatnonzero(np.abs(np.hypot(*points.T) / radius - 1.0) < 1e-9)
    return np.asarray(found[np.argsort(np.abs(points[found, 1]))])


def _arc(radius: float, layers: _Layers, *, sphere: bool) -> Array:
    """Nodes of a ring's arc from the surface to the axis, as gmsh's progression divides it."""
    start = math.asin(radius / 2.0) if sphere else 0.0
    angle = start + layers.fractions * (math.pi / 2.0 - start)
    sign = 1.0 if sphere else -1.0
    return np.asarray(radius * np.column_stack([np.cos(angle), sign * np.sin(angle)]))


def _inner_block(k: _Sketch, r0: float, layers: _Layers) -> None:
    half, q = layers.half, layers.ratio
    start = math.asin(r0 / 2.0) if k.sphere else 0.0
    middle = k.sign * (start + layers.fractions[half] * (math.pi / 2.0 - start))
    b, c = k.on_surface(0.5 * r0), k.on_axis(0.5 * r0)
    m = k.point(0.62 * r0 * math.cos(middle), 0.62 * r0 * math.sin(middle))
    b2, c2 = k.on_surface(r0), k.on_axis(r0)
    m2 = k.point(r0 * math.cos(middle), r0 * math.sin(middle))
    ob, bm = k.surface(k.origin, b, half, 1.0 / q), k.line(b, m, half, q)
    mc, co = k.line(m, c, half, q), k.line(c, k.origin, half, 1.0 / q)
    k.patch([ob, bm, mc, co], [k.origin, b, m, c])
    bb, outer1 = k.surface(b, b2, RULES.inner_rings), k.arc(b2, k.origin, m2, half, q)
    mm = k.line(m, m2, RULES.inner_rings)
    k.patch([bb, outer1, -mm, -bm], [b, b2, m2, m])
    outer2, cc = k.arc(m2, k.origin, c2, half, q), k.line(c, c2, RULES.inner_rings)
    k.patch([mm, outer2, -cc, -mc], [m, m2, c2, c])


def _top_block(k: _Sketch, radius: float, layers: _Layers) -> None:
    length = 1.0 - radius
    # as many layers as keep the growth from a tenth of the radius below a quarter a layer
    width = 0.1 * radius
    n = max(4, math.ceil(math.log1p(0.25 * length / width) / math.log(1.25)))
    ratio = _growth(length / width, n)
    b, c = k.on_surface(radius), k.on_axis(radius)
    corner, top = k.point(1.0, 1.0), k.point(0.0, 1.0)
    inner = k.arc(b, k.origin, c, layers.divisions, layers.ratio)
    side = k.surface(b, corner, n, ratio)
    face = k.line(corner, top, layers.divisions, layers.ratio)
    axis = k.line(c, top, n, ratio)
    k.patch([side, face, -axis, -inner], [b, corner, top, c])


def _growth(total: float, n: int) -> float:
    """Ratio q >= 1 with 1 + q + ... + q^(n-1) = total (1 when n exceeds total)."""
    low, high = 1.0, 2.0
    if total <= n:
        return 1.0
    for _ in range(60):
        q = 0.5 * (low + high)
        low, high = (q, high) if (q**n - 1.0) / (q - 1.0) < total else (low, q)
    return 0.5 * (low + high)


def _points_and_quads(gmsh: Any) -> tuple[Array, Integers]:
    tags, xyz, _ = gmsh.model.mesh.getNodes()
    kinds, _, nodes = gmsh.model.mesh.getElements(2)
    if list(kinds) != [3]:
        raise InputError(f"gmsh made elements of kinds {list(kinds)}", key="mesh", allowed="quads")
    used = np.unique(nodes[0].astype(np.int64))
    place = np.full(int(tags.max()) + 1, -1)
    place[tags.astype(np.int64)] = np.arange(len(tags))
    points = xyz.reshape(-1, 3)[place[used], :2].copy()
    number = np.full(int(tags.max()) + 1, -1)
    number[used] = np.arange(len(used))
    return points, number[nodes[0].astype(np.int64)].reshape(-1, 4)
