"""The stress update at many material points at a time, and its consistent tangent.

Every quantity is a row of `L` lanes in one array, a lane is a point, and the loops over lanes are
without branches, so that the compiler runs them in vector units: a third of the time of one point
after the other. Only the yield circle of a point that flows is found lane by lane in between.

Two updates are offered by number (`RADIAL`, `EXACT`). The radial return is first order in the step
when the strain path bends, and under a growing contact it bends everywhere. The exact update is the
solution of the flow rule for a constant direction of the strain increment in the rotated frame
(Krieg and Krieg, J. Press. Vessel Technol. 99 (1977) 510): the point slides along the yield circle,
and tan(psi/2), psi the angle between point and increment, decays exponentially.

Column by column of the tangent: the change of F turns into that of the trial strain (through the
principal axes of the trial b), of the mean strain and of the rotation, these into that of the
updated point, and that into the change of P = tau F^-T.
"""

from __future__ import annotations

import math

from numba import njit

from .flow import circle_of, law_at

RADIAL = 0
"""Radial return (backward Euler)."""

EXACT = 1
"""Exact integration along a constant strain-rate direction."""

L = 32
"""Points that are taken together."""

# rows, in units of a lane
(
    # given: F (rr, rz, zr, zz, tt), F, elastic b and the deviator e (rr, zz, rz, tt) of its
    # logarithmic strain at the last accepted step; 2 G, the radius of the yield circle at rest at
    # J = 1; 1 + the number of the flow law (0: none), plastic strain and work.  e is updated
    F0, F1, F2, F3, F4, O0, O1, O2, O3, O4, B0, B1, B2, B3, E0, E1, E2, E3, G2, R0,
    LAW, STRAIN, WORK,
    # trial: f = F F_old^-1, principal values and axes of b, deviator a and mean of its strain
    I0, I1, I2, I3, L1, L2, COS, SIN, MIXED, A0, A1, A2, A3, M, SIZE, RADIUS, J,
    # slide: turned old point, increment, where it begins, elastic part, length, cosine
    Q0, Q1, Q2, Q3, D0, D1, D2, D3, X0, X1, X2, X3, T, SLOPE, N, LENGTH, C, XD, DD,
    # 1 or 0: flows, has a direction, slides
    FLOWS, DIRECTED, SLIDES,
    # circle: mean and last radius, exp(-length/mean), gain, drift; length of the
    # plastic increment, and the mean radius while it flows
    MEAN, END, DECAY, GAIN, DRIFT, SLIP, WORKED,
    # updated: stress P (rr, rz, zr, zz, tt), and dP/dF from here on, column by column of five rows
    P0, P1, P2, P3, P4, TANGENT,
) = (k * L for k in range(75))  # fmt: skip

OTHERS = TANGENT + 25 * L
"""First row that is free for what its user keeps beside."""

FAST = {"contract", "reassoc", "nsz", "arcp"}
"""What the compiler may take for granted in loops over lanes."""

_FASTER = FAST | {"nnan"}  # what is no number stands in lanes alone that are passed over

# limit: stress over strength at which a point becomes plastic [-]: round-off would call converged
# points plastic again on unloading
_MARGIN = 1.0 + 1e-10

# limit: squared strain increment over the squared radius that has no direction [-]: round-off of
# the increment
_STILL = 1e-24

# limit: x from 1/most to most of which the logarithm is a series [-]: eleven terms leave 1e-17
_MOST = 1.5

# limit: slope over the radius and the increment at which a circle is only touched [-]: its
# derivative would be round-off
_TOUCHED = 1e-3


@njit(forceinline=True, error_model="numpy", fastmath=FAST)
def _dot(a0, a1, a2, a3, b0, b1, b2, b3):
    return a0 * b0 + a1 * b1 + a3 * b3 + 2.0 * a2 * b2


@njit(forceinline=True, error_model="numpy", fastmath=FAST)
def _series(x):
    """Half of ln x, x near 1: the series of artanh((x - 1)/(x + 1))."""
    z = (x - 1.0) / (x + 1.0)
    s = z * z
    p = 1.0 / 21.0
    p = p * s + 1.0 / 19.0
    p = p * s + 1.0 / 17.0
    p = p * s + 1.0 / 15.0
    p = p * s + 1.0 / 13.0
    p = p * s + 1.0 / 11.0
    p = p * s + 1.0 / 9.0
    p = p * s + 1.0 / 7.0
    p = p * s + 1.0 / 5.0
    p = p * s + 1.0 / 3.0
    return z + z * s * p


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _principal(w):
    """Trial b of the step, f b_old f^T: its principal values and axes; A3 takes the third one."""
    for at in range(L):
        o0, o1, o2, o3 = w[O0 + at], w[O1 + at], w[O2 + at], w[O3 + at]
        f0, f1, f2, f3 = w[F0 + at], w[F1 + at], w[F2 + at], w[F3 + at]
        i = 1.0 / (o0 * o3 - o1 * o2)
        f00 = (f0 * o3 - f1 * o2) * i
        f01 = (f1 * o0 - f0 * o1) * i
        f10 = (f2 * o3 - f3 * o2) * i
        f11 = (f3 * o0 - f2 * o1) * i
        ftt = w[F4 + at] / w[O4 + at]
        b0, b1, b2 = w[B0 + at], w[B1 + at], w[B2 + at]
        t00, t01 = f00 * b0 + f01 * b2, f00 * b2 + f01 * b1
        t10, t11 = f10 * b0 + f11 * b2, f10 * b2 + f11 * b1
        q0 = t00 * f00 + t01 * f01
        q1 = t10 * f10 + t11 * f11
        q2 = t00 * f10 + t01 * f11
        mean = 0.5 * (q0 + q1)
        half = 0.5 * (q0 - q1)
        radius = math.sqrt(half * half + q2 * q2)
        round_ = radius == 0.0
        safe = 1.0 if round_ else radius
        # half-angle formulas, each in the form that subtracts nothing
        large = math.sqrt(0.5 * (1.0 + abs(half) / safe))
        small = 0.5 * q2 / (safe * large)
        sign = -1.0 if q2 < 0.0 else 1.0
        c = large if half >= 0.0 else abs(small)
        s = small if half >= 0.0 else sign * large
        w[COS + at] = 1.0 if round_ else c
        w[SIN + at] = 0.0 if round_ else s
        w[L1 + at] = mean + radius
        w[L2 + at] = mean - radius
        w[A3 + at] = ftt * ftt * w[B3 + at]
        w[I0 + at], w[I1 + at], w[I2 + at], w[I3 + at] = f00, f01, f10, f11


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _logarithms(w):
    """Half of ln of the principal values, to A0, A1 and A2; whether all were near 1."""
    near = 0.0
    for at in range(L):
        l1, l2, l3 = w[L1 + at], w[L2 + at], w[A3 + at]
        w[A0 + at] = _series(l1)
        w[A1 + at] = _series(l2)
        w[A2 + at] = _series(l3)
        inside = (l1 < _MOST) & (l2 > 1.0 / _MOST) & (l3 < _MOST) & (l3 > 1.0 / _MOST)
        near += 1.0 if inside else 0.0
    return near == L


@njit(cache=True, error_model="numpy")
def _far_logarithms(w):
    for at in range(L):
        w[A0 + at] = 0.5 * math.log(w[L1 + at])
        w[A1 + at] = 0.5 * math.log(w[L2 + at])
        w[A2 + at] = 0.5 * math.log(w[A3 + at])


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _trial(w):
    """Trial point, the present radius, and which lanes flow; how many."""
    n_flow = 0.0
    for at in range(L):
        h1, h2, h3 = w[A0 + at], w[A1 + at], w[A2 + at]
        l1, l2, l3 = w[L1 + at], w[L2 + at], w[A3 + at]
        c, s = w[COS + at], w[SIN + at]
        m = (h1 + h2 + h3) / 3.0
        apart = abs(l1 - l2) > 1e-7 * l1
        gap = l1 - l2 if apart else 1.0
        w[MIXED + at] = (h1 - h2) / gap if apart else 1.0 / (l1 + l2)
        a0 = (h1 - m) * c * c + (h2 - m) * s * s
        a1 = (h1 - m) * s * s + (h2 - m) * c * c
        a2 = (h1 - h2) * c * s
        a3 = h3 - m
        volume = math.sqrt(l1 * l2 * l3)
        size = math.sqrt(_dot(a0, a1, a2, a3, a0, a1, a2, a3))
        radius = w[R0 + at] * volume
        flows = size > radius * _MARGIN
        w[A0 + at], w[A1 + at], w[A2 + at], w[A3 + at] = a0, a1, a2, a3
        w[M + at], w[J + at] = m, volume
        w[SIZE + at] = size if flows else 1.0
        w[RADIUS + at] = radius if flows else 1.0
        w[FLOWS + at] = 1.0 if flows else 0.0
        n_flow += 1.0 if flows else 0.0
    return n_flow


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _slide(w, exact):
    """The slide from the turned old point towards the trial point.

    The turn is the in-plane rotation of the step; the slide begins where the way from the old point
    meets the circle. `exact`: 1, or 0 for the radial return.
    """
    for at in range(L):
        R, flows = w[RADIUS + at], w[FLOWS + at] > 0.5
        x, y = w[I0 + at] + w[I3 + at], w[I2 + at] - w[I1 + at]
        turn = 1.0 / math.sqrt(x * x + y * y)
        cos, sin = x * turn, y * turn
        e0, e1, e2 = w[E0 + at], w[E1 + at], w[E2 + at]
        cc, ss, cs = cos * cos, sin * sin, cos * sin
        r0 = cc * e0 - 2.0 * cs * e2 + ss * e1
        r1 = ss * e0 + 2.0 * cs * e2 + cc * e1
        r2 = cs * (e0 - e1) + (cc - ss) * e2
        r3 = w[E3 + at]
        d0, d1, d2, d3 = w[A0 + at] - r0, w[A1 + at] - r1, w[A2 + at] - r2, w[A3 + at] - r3
        dd = _dot(d0, d1, d2, d3, d0, d1, d2, d3)
        directed = flows & (dd > _STILL * R * R) & (exact > 0.5)
        dd = dd if directed else 1.0
        along = _dot(r0, r1, r2, r3, d0, d1, d2, d3)
        outside = _dot(r0, r1, r2, r3, r0, r1, r2, r3) - R * R
        square = along * along - dd * outside
        # |r + t d|^2/2 by t where it meets the circle: not along + t dd, in which they cancel
        reach = math.sqrt(square if square > 0.0 else 0.0)
        t = (reach - along) / dd
        # rate held the point outside: it flows at once
        t = 0.0 if (w[LAW + at] > 0.5) & (outside >= 0.0) else t
        crossed = (t > 0.0) & (t < 1.0) & (reach > _TOUCHED * R * math.sqrt(dd))
        t = t if t > 0.0 else 0.0
        t = t if t < 1.0 else 1.0
        x0, x1, x2, x3 = r0 + t * d0, r1 + t * d1, r2 + t * d2, r3 + t * d3
        square = _dot(x0, x1, x2, x3, x0, x1, x2, x3)
        n = math.sqrt(square if directed else 1.0)
        xd = _dot(x0, x1, x2, x3, d0, d1, d2, d3)
        length = (1.0 - t) * math.sqrt(dd)
        w[Q0 + at], w[Q1 + at], w[Q2 + at], w[Q3 + at] = r0, r1, r2, r3
        w[D0 + at], w[D1 + at], w[D2 + at], w[D3 + at] = d0, d1, d2, d3
        w[X0 + at], w[X1 + at], w[X2 + at], w[X3 + at] = x0, x1, x2, x3
        w[T + at] = t
        w[SLOPE + at] = reach if crossed else 0.0
        w[N + at] = n if directed else w[SIZE + at]
        w[LENGTH + at] = length if directed else 0.0
        w[C + at] = xd / (n * math.sqrt(dd)) if directed else 1.0
        w[XD + at] = xd
        w[DD + at] = dd
        w[DIRECTED + at] = 1.0 if directed else 0.0
        w[SLIDES + at] = 1.0 if directed & (length > 0.0) else 0.0


@njit(cache=True, error_model="numpy")
def _circles(w, laws, seconds):
    """Yield circle of every lane that flows."""
    for at in range(L):
        R, length = w[RADIUS + at], w[LENGTH + at]
        w[MEAN + at], w[END + at], w[DECAY + at], w[GAIN + at], w[DRIFT + at] = R, R, 1.0, 0.0, 0.0
        w[SLIP + at], w[WORKED + at] = 0.0, 0.0
        if w[FLOWS + at] < 0.5 or (w[DIRECTED + at] > 0.5 and length == 0.0):
            continue
        if w[LAW + at] < 0.5:
            w[DECAY + at] = math.exp(-length / R)
            continue
        k = int(w[LAW + at]) - 1
        law, _ = law_at(laws, k, w[STRAIN + at], w[WORK + at], w[G2 + at], seconds)
        found = circle_of(law, laws.curve[k], w[J + at], R, (w[N + at], length, w[C + at]))
        w[MEAN + at], w[END + at], w[DECAY + at] = found.mean, found.end, found.decay
        w[GAIN + at], w[DRIFT + at] = found.gain, found.drift
        w[SLIP + at], w[WORKED + at] = found.flow, found.worked


@njit(cache=True, error_model="numpy", fastmath=FAST)
def _stresses(w):
    """Updated e, P = 2 G dev e F^-T, and how a perfectly plastic point came there."""
    for at in range(L):
        a, c, n, t = w[DECAY + at], w[C + at], w[N + at], w[T + at]
        flows, directed, slides = w[FLOWS + at] > 0.5, w[DIRECTED + at] > 0.5, w[SLIDES + at] > 0.5
        end = w[END + at]
        scale = end / (1.0 + a * a + (1.0 - a * a) * c)
        length = w[LENGTH + at] if slides else 1.0
        kx = 2.0 * a * scale / n if slides else 1.0
        kd = scale * (1.0 - a * a + (1.0 - a) ** 2 * c) * (1.0 - t) / length if slides else 0.0
        back = end / w[SIZE + at] if flows else 1.0
        e0 = kx * w[X0 + at] + kd * w[D0 + at] if directed else back * w[A0 + at]
        e1 = kx * w[X1 + at] + kd * w[D1 + at] if directed else back * w[A1 + at]
        e2 = kx * w[X2 + at] + kd * w[D2 + at] if directed else back * w[A2 + at]
        e3 = kx * w[X3 + at] + kd * w[D3 + at] if directed else back * w[A3 + at]
        w[E0 + at], w[E1 + at], w[E2 + at], w[E3 + at] = e0, e1, e2, e3
        grows = w[LAW + at] > 0.5
        d0, d1, d2, d3 = w[A0 + at] - e0, w[A1 + at] - e1, w[A2 + at] - e2, w[A3 + at] - e3
        slip = math.sqrt(_dot(d0, d1, d2, d3, d0, d1, d2, d3))
        w[SLIP + at] = w[SLIP + at] if grows else slip
        size = math.sqrt(_dot(e0, e1, e2, e3, e0, e1, e2, e3))
        w[WORKED + at] = w[WORKED + at] if grows else size
        f0, f1, f2, f3 = w[F0 + at], w[F1 + at], w[F2 + at], w[F3 + at]
        g = w[G2 + at] / (f0 * f3 - f1 * f2)
        w[P0 + at] = g * (e0 * f3 - e2 * f1)
        w[P1 + at] = g * (e2 * f0 - e0 * f2)
        w[P2 + at] = g * (e2 * f3 - e1 * f1)
        w[P3 + at] = g * (e1 * f0 - e2 * f2)
        w[P4 + at] = w[G2 + at] * e3 / w[F4 + at]


@njit(forceinline=True, error_model="numpy", fastmath=_FASTER)
def _change_of_trial(w, at, l00, l01, l10, l11, ltt):
    """Changes of mean strain, trial point and rotation under a displacement gradient dF F^-1."""
    dm = (l00 + l11 + ltt) / 3.0
    c, s = w[COS + at], w[SIN + at]
    cc, ss, cs = c * c, s * s, c * s
    u0, u1 = l00 * c + l01 * s, l10 * c + l11 * s
    v0, v1 = l01 * c - l00 * s, l11 * c - l10 * s
    e11 = c * u0 + s * u1 - dm
    e22 = c * v1 - s * v0 - dm
    e12 = w[MIXED + at] * (w[L2 + at] * (c * v0 + s * v1) + w[L1 + at] * (c * u1 - s * u0))
    trial = (
        e11 * cc + e22 * ss - 2.0 * e12 * cs,
        e11 * ss + e22 * cc + 2.0 * e12 * cs,
        (e11 - e22) * cs + e12 * (cc - ss),
        ltt - dm,
    )
    i0, i1, i2, i3 = w[I0 + at], w[I1 + at], w[I2 + at], w[I3 + at]
    x, y = i0 + i3, i2 - i1
    turn = x * (l10 * i0 + l11 * i2 - l00 * i1 - l01 * i3)
    turn -= y * (l00 * i0 + l01 * i2 + l10 * i1 + l11 * i3)
    return dm, trial, turn / (x * x + y * y)


@njit(forceinline=True, error_model="numpy", fastmath=_FASTER)
def _change_of_circle(w, at, dm, trial, dn, dl, dc):
    """Changes of the circle's mean and last radius, and of the trial point's length over itself.

    `dn`, `dl` and `dc` are those of the slide's beginning, length and cosine.
    """
    slides, a, cosine = w[SLIDES + at] > 0.5, w[DECAY + at], w[C + at]
    t0, t1, t2, t3 = trial
    along = _dot(w[A0 + at], w[A1 + at], w[A2 + at], w[A3 + at], t0, t1, t2, t3) / w[SIZE + at]
    grown = dn if slides else along
    even = 3.0 * w[END + at] * dm
    den = 1.0 + a * a + (1.0 - a * a) * cosine
    drive = grown - even + 0.5 * w[DRIFT + at] * (grown + even)
    drive += dl * (1.0 + cosine - a * a * (1.0 - cosine)) / den if slides else 0.0
    drive += w[MEAN + at] * (1.0 - a * a) / den * dc if slides else 0.0
    dend = w[GAIN + at] * drive + even
    return 0.5 * (dn + dend) if w[LAW + at] > 0.5 else even, dend, along / w[SIZE + at]


@njit(forceinline=True, error_model="numpy", fastmath=_FASTER)
def _change_of_point(w, at, dm, trial, angle):
    """Change of the updated point from those of mean strain, trial point and rotation."""
    a0, a1, a2, a3 = trial
    t, rest, a, cosine, n = w[T + at], 1.0 - w[T + at], w[DECAY + at], w[C + at], w[N + at]
    mean, end, xd, dd, radius = w[MEAN + at], w[END + at], w[XD + at], w[DD + at], w[RADIUS + at]
    slides = w[SLIDES + at] > 0.5
    length = w[LENGTH + at] if slides else 1.0
    # of the old point, angle q, and of the increment, trial - angle q
    q0, q1, q2 = -2.0 * w[Q2 + at], 2.0 * w[Q2 + at], w[Q0 + at] - w[Q1 + at]
    x0, x1, x2, x3 = w[X0 + at], w[X1 + at], w[X2 + at], w[X3 + at]
    d0, d1, d2, d3 = w[D0 + at], w[D1 + at], w[D2 + at], w[D3 + at]
    x_turn = angle * _dot(x0, x1, x2, x3, q0, q1, q2, 0.0)
    d_turn = angle * _dot(d0, d1, d2, d3, q0, q1, q2, 0.0)
    x_inc = _dot(x0, x1, x2, x3, a0, a1, a2, a3) - x_turn
    d_inc = _dot(d0, d1, d2, d3, a0, a1, a2, a3) - d_turn
    crossed = w[SLOPE + at] != 0.0
    dt = 3.0 * radius * radius * dm - x_turn - t * x_inc
    dt = dt / (w[SLOPE + at] if crossed else 1.0) if crossed else 0.0
    dn = (x_turn + t * x_inc + dt * xd) / n
    dl = rest * (rest * d_inc - dt * dd) / length
    dc = (rest * (d_turn + t * d_inc + dt * dd + x_inc) - dt * xd) / (n * length)
    dc -= cosine * (dn / n + dl / length)
    dmean, dend, along = _change_of_circle(w, at, dm, trial, dn, dl, dc)
    den = 1.0 + a * a + (1.0 - a * a) * cosine
    da = -a * (dl - length * dmean / mean) / mean
    dden = (2.0 * a * da * (1.0 - cosine) + (1.0 - a * a) * dc) / den
    top = 1.0 - a * a + (1.0 - a) ** 2 * cosine
    dtop = (1.0 - a) ** 2 * dc - 2.0 * da * (a + (1.0 - a) * cosine)
    scale = end / den
    kx, kd = 2.0 * a * scale / n, top * scale / length
    grow = dend / end - dden
    dkx = kx * (grow - dn / n) + 2.0 * da * scale / n
    dkd = kd * (grow - dl / length) + dtop * scale / length
    inc = kx * t + kd * rest
    old = (kx - inc) * angle
    far = dt * (kx - kd) + rest * dkd
    back, more = end / w[SIZE + at], dend / end - along
    returns = (w[FLOWS + at] > 0.5) & (w[DIRECTED + at] < 0.5)
    b0 = back * (a0 + more * w[A0 + at]) if returns else a0
    b1 = back * (a1 + more * w[A1 + at]) if returns else a1
    b2 = back * (a2 + more * w[A2 + at]) if returns else a2
    b3 = back * (a3 + more * w[A3 + at]) if returns else a3
    return (
        old * q0 + inc * a0 + dkx * x0 + far * d0 if slides else b0,
        old * q1 + inc * a1 + dkx * x1 + far * d1 if slides else b1,
        old * q2 + inc * a2 + dkx * x2 + far * d2 if slides else b2,
        inc * a3 + dkx * x3 + far * d3 if slides else b3,
    )


@njit(forceinline=True, error_model="numpy", fastmath=_FASTER)
def _column(w, at, column, s0, s1, s2, s3, s4):
    """Column of dP/dF: that of the component whose s is 1, the others being 0."""
    f0, f1, f2, f3, f4 = w[F0 + at], w[F1 + at], w[F2 + at], w[F3 + at], w[F4 + at]
    inverse = 1.0 / (f0 * f3 - f1 * f2)
    g00, g01, g10, g11 = f3 * inverse, -f1 * inverse, -f2 * inverse, f0 * inverse
    dm, trial, angle = _change_of_trial(
        w, at, s0 * g00 + s1 * g10, s0 * g01 + s1 * g11, s2 * g00 + s3 * g10, s2 * g01 + s3 * g11,
        s4 / f4,
    )  # fmt: skip
    e0, e1, e2, e3 = _change_of_point(w, at, dm, trial, angle)
    # d(tau F^-T) = dtau F^-T - P (F^-1 dF)^T
    g = w[G2 + at]
    t0, t1, t2 = g * e0, g * e1, g * e2
    w00, w01 = s0 * g00 + s2 * g01, s1 * g00 + s3 * g01
    w10, w11 = s0 * g10 + s2 * g11, s1 * g10 + s3 * g11
    p0, p1, p2, p3 = w[P0 + at], w[P1 + at], w[P2 + at], w[P3 + at]
    to = TANGENT + 5 * column * L + at
    w[to] = t0 * g00 + t2 * g01 - (p0 * w00 + p1 * w01)
    w[to + L] = t0 * g10 + t2 * g11 - (p0 * w10 + p1 * w11)
    w[to + 2 * L] = t2 * g00 + t1 * g01 - (p2 * w00 + p3 * w01)
    w[to + 3 * L] = t2 * g10 + t1 * g11 - (p2 * w10 + p3 * w11)
    w[to + 4 * L] = (g * e3 - s4 * w[P4 + at]) / f4


@njit(cache=True, error_model="numpy", fastmath=_FASTER)
def tangents(w):
    """Fill the rows of dP/dF, after `stresses`."""
    for at in range(L):
        _column(w, at, 0, 1.0, 0.0, 0.0, 0.0, 0.0)
        _column(w, at, 1, 0.0, 1.0, 0.0, 0.0, 0.0)
        _column(w, at, 2, 0.0, 0.0, 1.0, 0.0, 0.0)
        _column(w, at, 3, 0.0, 0.0, 0.0, 1.0, 0.0)
        _column(w, at, 4, 0.0, 0.0, 0.0, 0.0, 1.0)


@njit(cache=True, error_model="numpy")
def stresses(w, exact, laws, seconds):
    """Fill the rows from the trial to the stress; number of lanes that flow.

    `exact`: 1, or 0 for the radial return; `laws` and `seconds` as in `flow.law_at`.
    """
    _principal(w)
    if not _logarithms(w):
        _far_logarithms(w)
    n = _trial(w)
    _slide(w, exact)
    _circles(w, laws, seconds)
    _stresses(w)
    return n
