"""What moves: a linear body by its matrices, the places where it may be pressed, and its state at an instant.

The bulk remembers one field of nodal displacements for every branch of the relaxation modulus. The displacement is
linear in time within a step, so that every branch is integrated exactly:

    stress = E_inf u + sum_k E_k z_k ,    dz_k/dt = du/dt - z_k/tau_k ,

with the stiffness matrix of unit modulus behind it. A parallel viscosity counts among the dampings.

Under a velocity that grows, a branch so integrated lags behind the exact one by a share of the step that goes from none
to one half as the step outgrows tau. An implicit balance asks for branches so much later, which keeps it of order two.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Matrix
from fe_contact.assembly.interior import factorized
from fe_contact.dynamics.flow import Flowed, Yields
from fe_contact.schemes import galerkin
from lumped.materials import Relaxation

SLOW = 1e-3  # step over relaxation time below which the lag is a twelfth of that, to rounding


class PartLaw(NamedTuple):
    """Numbers of one part in a step of one length: ``now`` modulus of an increment; z' = decay z + gain (u' - u);
    ``late`` what z' - z counts for to make up for the lag, Pa; ``mean`` modulus of an increment, and of z, over it.
    """

    now: float
    decay: Array
    gain: Array
    late: Array
    mean: tuple[float, Array]

    def moved(self, branches: Array, change: Array) -> Array:
        """The branches (k, N) after an increment (N,)."""
        return np.asarray(self.decay[:, None] * branches + self.gain[:, None] * change)

    def pulled(self, pulls: Array, pull: Array) -> Array:
        """Stiffness times displacement and branches (1 + k, N) after an increment of which it makes ``pull``, (N,)."""
        return np.vstack([pulls[0] + pull, self.moved(pulls[1:], pull)])


@dataclass(frozen=True, eq=False)
class Part:
    """Stiffness (N, N) per unit modulus, symmetric, and the modulus as a function of time.

    A constant Poisson's ratio needs one part; a constant bulk modulus two, volume and shape.
    """

    stiffness: Matrix
    relaxation: Relaxation

    def law(self, step: float) -> PartLaw:
        """Numbers of a step, s."""
        ratios = step / np.asarray(self.relaxation.times)
        lost = np.expm1(-ratios)
        gain = -lost / ratios
        now = self.relaxation.equilibrium + float(np.dot(self.relaxation.moduli, gain))
        lag = np.where(ratios < SLOW, ratios / 12.0, -1.0 / lost - 0.5 - 1.0 / ratios)
        moduli = np.asarray(self.relaxation.moduli)
        of_change, of_past = galerkin.weights(moduli, ratios)
        mean = 0.5 * self.relaxation.equilibrium + float(of_change.sum())
        return PartLaw(now, 1.0 + lost, gain, moduli * lag, (mean, of_past))

    def past(self, law: PartLaw, displacement: Array, branches: Array) -> Array:
        """Displacement times modulus, (N,), at the end of a step in which nothing moves; ``branches`` (k, N)."""
        relaxation = self.relaxation
        return np.asarray(relaxation.equilibrium * displacement + (law.decay * relaxation.moduli) @ branches)

    def stressed(self, displacement: Array, branches: Array) -> Array:
        """Displacement times modulus at an instant, (N,)."""
        return np.asarray(self.relaxation.equilibrium * displacement + np.asarray(self.relaxation.moduli) @ branches)

    def averaged(self, law: PartLaw, displacement: Array, change: Array, branches: Array) -> Array:
        """Displacement times modulus, average over a step in which the displacement (N,) grows by ``change``, (N,)."""
        of_change, of_past = law.mean
        return np.asarray(self.relaxation.equilibrium * displacement + of_change * change + of_past @ branches)

    def stored(self, displacement: Array, branches: Array, pulls: Array) -> float:
        """Elastic energy of springs and branches, J; ``pulls`` (1 + k, N) are the stiffness times either."""
        springs = (self.relaxation.equilibrium, *self.relaxation.moduli)
        held = [float(along @ pull) for along, pull in zip((displacement, *branches), pulls, strict=True)]
        return 0.5 * float(np.dot(springs, held))

    def heat(self, step: float, change: Array, pulled: Array, branches: Array, pulls: Array) -> float:
        """Heat of the dashpots over a step in which the displacement changes linearly, J.

        ``pulled`` (N,) and ``pulls`` (k, N): the stiffness times the change, and times the branches at the start.
        """
        if self.relaxation.is_elastic:
            return 0.0
        relaxation, pull = self.relaxation, float(change @ pulled)
        lost = relaxation.viscosity * pull / step
        for modulus, tau, branch, own in zip(relaxation.moduli, relaxation.times, branches, pulls, strict=True):
            x, share = step / tau, tau / step  # the branch tends to share x change; the rest fades away
            across = float(branch @ pulled)
            fading = float(branch @ own) - 2 * share * across + share**2 * pull
            mixed = share * across - share**2 * pull
            lost += modulus * (fading * -np.expm1(-2 * x) / 2 + 2 * mixed * -np.expm1(-x) + share**2 * pull * x)
        return lost


@dataclass(frozen=True, eq=False)
class Pressing:
    """Places of contact: overlap = ``clearance`` - trace push^T u at the points, where u = 0 is the undeformed body.

    ``push`` (N, m) nodal forces of unit surface forces, sparse; ``trace`` (q, m) surface displacement at the points;
    ``weights`` (q,) area of the points; ``clearance`` (q,) overlap there without displacement, m, negative if open;
    ``carriers`` (q, k) shape functions of a pressure that two bodies can follow, None of one.
    A rigid striker is one more degree of freedom, its depth: ``push`` -1, ``trace`` 1 for all points.
    """

    push: Matrix
    trace: Array
    weights: Array
    clearance: Array
    carriers: Array | None = None

    def overlap(self, displacement: Array) -> Array:
        """Interpenetration at the points, (q,), m, positive inside."""
        return np.asarray(self.clearance - self._seen @ displacement)

    def closing(self, velocity: Array) -> Array:
        """Rate of the overlap, (q,), m/s."""
        return np.asarray(-(self._seen @ velocity))

    def forces(self, pressure: Array) -> Array:
        """Surface forces (m,), N, of a pressure (q,), Pa."""
        return np.asarray(self.trace.T @ (self.weights * pressure))

    def load(self, pressure: Array) -> Array:
        """Nodal forces (N,), N, of a pressure (q,), Pa."""
        return np.asarray(self.push @ self.forces(pressure))

    @cached_property
    def _seen(self) -> Matrix:
        """Displacement at the points of that of the body, sparse (q, N)."""
        return sparse.csr_matrix(self.trace) @ self.push.T.tocsr()


@dataclass(frozen=True, eq=False)
class BodyWithMass:
    """Everything that moves in one scene, N degrees of freedom, SI units.

    ``mass`` (N, N) of the deformable bodies, sparse, may have zero rows; ``rigid`` (N,) that of rigid bodies;
    ``parts`` their stiffness; ``dashpots`` (N, N) that carry waves away, sparse, or None; ``gravity`` (N,) acceleration
    of free fall, m/s2; ``pressing`` where contact may be; ``yields`` what of it may flow, None: nothing.
    """

    mass: Matrix
    rigid: Array
    parts: tuple[Part, ...]
    dashpots: Matrix
    gravity: Array
    pressing: Pressing
    yields: Yields | None = None

    @property
    def size(self) -> int:
        """Number of degrees of freedom."""
        return int(self.rigid.size)

    @cached_property
    def inertia(self) -> Matrix:
        """All of the mass, sparse (N, N)."""
        return (self.mass + sparse.diags(self.rigid)).tocsc()

    @cached_property
    def weight(self) -> Array:
        """Nodal forces of gravity, (N,): where no mass is, none acts, so that a free fall does not strain."""
        return np.asarray(self.inertia @ self.gravity)

    @cached_property
    def damping(self) -> Matrix:
        """Force per velocity, (N, N): dashpots and the parallel viscosities of the material; None without any."""
        found = [p.relaxation.viscosity * p.stiffness for p in self.parts if p.relaxation.viscosity > 0.0]
        if self.dashpots is not None:
            found.append(self.dashpots)
        return sum(found[1:], found[0]).tocsc() if found else None

    @cached_property
    def massive(self) -> npt.NDArray[np.intp]:
        """Degrees of freedom that have mass."""
        return np.flatnonzero(self.inertia.diagonal() > 0.0)

    @cached_property
    def massless(self) -> npt.NDArray[np.intp]:
        """Degrees of freedom that obey statics."""
        return np.flatnonzero(self.inertia.diagonal() == 0.0)


class BodyState(NamedTuple):
    """A body at an instant, s, with N degrees of freedom and q points of contact, SI units.

    ``motions`` (3, 3, N): displacement, velocity and acceleration, the inertia times these, the damping times these;
    ``branches`` of every part, (k, N), and its ``pulls`` (1 + k, N): its unit stiffness times the displacement and each
    branch; ``signed_pressure`` (q,), negative where open. All are linear in the increment of a step, which is all that
    the matrices are multiplied with. ``flowed``: what has flowed of a body that yields, which is not.
    """

    time: float
    motions: Array
    branches: tuple[Array, ...]
    pulls: tuple[Array, ...]
    signed_pressure: Array
    flowed: Flowed | None = None

    @property
    def displacement(self) -> Array:
        """(N,), m."""
        return np.asarray(self.motions[0, 0])

    @property
    def velocity(self) -> Array:
        """(N,), m/s."""
        return np.asarray(self.motions[0, 1])

    @property
    def acceleration(self) -> Array:
        """(N,), m/s2."""
        return np.asarray(self.motions[0, 2])

    @property
    def pushed(self) -> Array:
        """Inertia times displacement, velocity, acceleration, (3, N)."""
        return np.asarray(self.motions[1])

    @property
    def damped(self) -> Array:
        """Damping times displacement, velocity, acceleration, (3, N)."""
        return np.asarray(self.motions[2])

    @property
    def pressure(self) -> Array:
        """Contact pressure at the points, (q,), >= 0."""
        return np.maximum(self.signed_pressure, 0.0)


def state_of(
    body: BodyWithMass, time: float, motion: Array, branches: tuple[Array, ...], signed_pressure: Array
) -> BodyState:
    """The state of displacement, velocity and acceleration (3, N), with all that the matrices make of it."""
    pulls = tuple(
        np.array([part.stiffness @ along for along in (motion[0], *own)])
        for part, own in zip(body.parts, branches, strict=True)
    )
    return BodyState(time, motions_of(body, motion), branches, pulls, signed_pressure)


def motions_of(body: BodyWithMass, motion: Array) -> Array:
    """Displacement, velocity and acceleration (3, N), inertia times and damping times these, (3, 3, N)."""
    damped = np.zeros_like(motion) if body.damping is None else (body.damping @ motion.T).T
    return np.array([motion, (body.inertia @ motion.T).T, damped])


def undeformed(body: BodyWithMass, velocity: Array) -> BodyState:
    """A relaxed body about to touch, moving with ``velocity`` (N,); its acceleration balances gravity and damping."""
    branches = tuple(np.zeros((len(part.relaxation.moduli), body.size)) for part in body.parts)
    forces = body.weight if body.damping is None else body.weight - body.damping @ velocity
    motion, free = np.array([np.zeros(body.size), velocity, np.zeros(body.size)]), body.massive
    if forces.any():
        motion[2, free] = factorized(body.inertia[free][:, free])(forces[free])
    state = state_of(body, 0.0, motion, branches, -np.ones(body.pressing.weights.size))
    return state if body.yields is None else state._replace(flowed=body.yields.at_rest)


def internal(body: BodyWithMass, pulls: tuple[Array, ...]) -> Array:
    """Nodal forces of the stress, (N,), N."""
    forces = [part.stressed(own[0], own[1:]) for part, own in zip(body.parts, pulls, strict=True)]
    return np.asarray(sum(forces[1:], forces[0]))
