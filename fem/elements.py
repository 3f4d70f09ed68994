"""The four-node elements, the material state at their points, and what is read from both."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from ..core.arrays import Array, Integers
from .material import FlowLaws
from .material.flow import NO_RATE, law_at


class Elements(NamedTuple):
    """Everything about the elements that does not change during a solve (R = 1, E' = 1).

    - `conn`: node numbers, shape (n_elements, 4).
    - `grad`: reference gradients of the basis functions, shape (n_elements, 4, 4, 2): element,
      point, node, direction.
    - `value`: basis functions at the points, shape (4, 4): point, node.
    - `r`: reference radius of the points, shape (n_elements, 4).
    - `dV`: reference volume of the points (2 pi r dA), shape (n_elements, 4).
    - `volume`: reference volume of the elements, shape (n_elements,).
    - `G`, `K`: shear and bulk modulus, shape (n_elements,).
    - `radius`: sqrt(2/3) Sy / (2 G), shape (n_elements,); `inf` where elastic.
    - `stiffness`: constant stiffness matrices of linear elements, shape (n_linear, 8, 8) [E' R].
    - `linear`: row of `stiffness` of each element, -1 for those of finite strain, shape
      (n_elements,).
    - `law`: row of `laws` of each element, -1 for those perfectly plastic, shape (n_elements,).
    - `laws`: the flow laws.
    """

    conn: Integers
    grad: Array
    value: Array
    r: Array
    dV: Array
    volume: Array
    G: Array
    K: Array
    radius: Array
    stiffness: Array
    linear: Integers
    law: Integers
    laws: FlowLaws

    @property
    def elastic(self) -> Elements:
        """The same without yield."""
        return self._replace(
            radius=np.full_like(self.radius, np.inf), law=np.full_like(self.law, -1)
        )

    @property
    def unhurried(self) -> Elements:
        """The same where those that feel the rate, which no time can pass for, do not yield."""
        slow = (self.law >= 0) & (self.laws.rate[self.law] != NO_RATE) if self.has_rate else []
        radius, law = self.radius.copy(), self.law.copy()
        radius[slow], law[slow] = np.inf, -1
        return self._replace(radius=radius, law=law)

    @property
    def has_rate(self) -> bool:
        """Whether any law feels the rate."""
        return bool((self.laws.rate != NO_RATE).any())


class State(NamedTuple):
    """Material state at the last accepted step.

    - `F`: deformation gradient (rr, rz, zr, zz, tt), shape (n_elements, 4, 5).
    - `b`: elastic left Cauchy-Green tensor (rr, zz, rz, tt), shape (n_elements, 4, 4).
    - `strain`: deviator of the elastic logarithmic strain 1/2 ln b, shape (n_elements, 4, 4).
    - `peeq`, `work`: equivalent plastic strain and plastic work of a volume [E'], shape
      (n_elements, 4).
    - `dissipated`: plastic work so far, summed over the mesh.
    """

    F: Array
    b: Array
    strain: Array
    peeq: Array
    work: Array
    dissipated: float

    @classmethod
    def virgin(cls, n_elements: int) -> State:
        """Undeformed, unstressed state."""
        F = np.zeros((n_elements, 4, 5))
        F[..., [0, 3, 4]] = 1.0
        b = np.zeros((n_elements, 4, 4))
        b[..., [0, 1, 3]] = 1.0
        none = np.zeros((n_elements, 4))
        return cls(F, b, np.zeros_like(b), none, none.copy(), 0.0)

    def room(self) -> State:
        """Arrays for another state of as many points."""
        F, b, strain, peeq, work = (np.empty_like(x) for x in self[:5])
        return State(F, b, strain, peeq, work, 0.0)


@njit(cache=True)
def radius_at_rest(elements, peeq, work):
    """Radius of the yield circle at rest at J = 1; `inf` where rate may hold a point outside."""
    out = np.empty(peeq.shape)
    for e in range(peeq.shape[0]):
        k = elements.law[e]
        for q in range(4):
            out[e, q] = elements.radius[e]
            if k >= 0:
                law, out[e, q] = law_at(elements.laws, k, peeq[e, q], work[e, q], 0.0, np.inf)
                if law.rate != NO_RATE:
                    out[e, q] = np.inf
    return out


@njit(cache=True)
def deformation(elements, u):
    """Deformation gradients at displacement `u`, shape (n_elements, 4, 5)."""
    F = np.zeros((elements.conn.shape[0], 4, 5))
    for e in range(elements.conn.shape[0]):
        for q in range(4):
            f = F[e, q]
            f[0], f[3] = 1.0, 1.0
            for a in range(4):
                i = 2 * elements.conn[e, a]
                gr, gz = elements.grad[e, q, a, 0], elements.grad[e, q, a, 1]
                f[0] += u[i] * gr
                f[1] += u[i] * gz
                f[2] += u[i + 1] * gr
                f[3] += u[i + 1] * gz
                f[4] += u[i] * elements.value[q, a]
            f[4] = 1.0 + f[4] / elements.r[e, q]
    return F


def cauchy_stress(elements: Elements, state: State) -> tuple[Array, Array]:
    """Cauchy stress deviator (rr, zz, rz, tt) at the points and pressure of the elements.

    Returned: deviator, shape (n_elements, 4, 4), and mean stress, shape (n_elements,) [E'].
    """
    J = (state.F[..., 0] * state.F[..., 3] - state.F[..., 1] * state.F[..., 2]) * state.F[..., 4]
    theta = (J * elements.dV).sum(axis=1) / elements.volume
    mean = elements.K * np.log(theta) / theta
    return 2.0 * elements.G[:, None, None] * state.strain / J[..., None], mean
