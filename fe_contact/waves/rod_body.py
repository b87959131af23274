"""The rod as a body that moves: line elements which a wave crosses in one step, a striker on its end."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sparse

import meshes
from fe_contact.assembly.forms import scatter
from fe_contact.dynamics.body import BodyWithMass, Part, Pressing
from fe_contact.dynamics.mass.base import MASSES
from fe_contact.settings import WaveNumerics
from fe_contact.waves.moving import Moving, with_striker
from lumped.scene.scene import Scene
from lumped.targets.rod import Rod


def elements(scene: Scene, numerics: WaveNumerics) -> int:
    """How many a wave crosses one a step."""
    return max(round(transit(scene) * numerics.steps / numerics.contact_time), 1)


def rod_mass(scene: Scene) -> float:
    """Of the whole rod, kg."""
    rod = scene.target
    assert isinstance(rod, Rod)
    return (scene.geometry.material.density or 0.0) * rod.area * rod.length


def speed(scene: Scene) -> float:
    """Of the fastest waves along the rod, m/s."""
    material = scene.geometry.material
    return float(np.sqrt(material.uniaxial_modulus().glassy / (material.density or 1.0)))


def transit(scene: Scene) -> float:
    """How long they take from one end to the other, s."""
    rod = scene.target
    assert isinstance(rod, Rod)
    return rod.length / speed(scene)


def moving(scene: Scene, numerics: WaveNumerics) -> Moving:
    """The rod of a scene at first touch, in SI units; displacements count along the motion."""
    rod, material = scene.target, scene.geometry.material
    assert isinstance(rod, Rod)
    mesh = meshes.rod(elements(scene, numerics))
    dofs, size = mesh.t.T, mesh.p.shape[1]
    length = rod.length / len(dofs)
    density, modulus = material.density or 0.0, material.uniaxial_modulus()
    of_element = density * rod.area * length / 6 * np.array([[2.0, 1.0], [1.0, 2.0]])
    springs = rod.area / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
    end = mesh.boundaries["end"]
    free = np.setdiff1d(np.arange(size), end if rod.end == "fixed" else [])
    mass = MASSES.get(numerics.mass).of(np.tile(of_element, (len(dofs), 1, 1)), dofs, size, np.array([0]))
    rigid, gravity = np.zeros(len(free) + 1), np.zeros(len(free) + 1)
    rigid[-1], gravity[-1] = scene.reduced_mass, scene.gravity
    body = BodyWithMass(
        mass=with_striker(mass, free),
        rigid=rigid,
        parts=(Part(with_striker(scatter(np.tile(springs, (len(dofs), 1, 1)), dofs, size), free), modulus),),
        dashpots=_dashpot(rod.impedance(modulus.glassy, density), len(free)) if rod.end == "absorbing" else None,
        gravity=gravity,
        pressing=Pressing(
            push=sparse.csc_matrix(([1.0, -1.0], ([0, len(free)], [0, 0])), shape=(len(free) + 1, 1)),
            trace=np.ones((1, 1)),
            weights=np.ones(1),
            clearance=np.zeros(1),
        ),
    )
    return Moving(body, scene.velocity, np.zeros(1), endless=False)


def _dashpot(impedance: float, last: int) -> sparse.csc_matrix:
    """On the far end, all the rod that goes on behind it."""
    return sparse.csc_matrix(([impedance], ([last - 1], [last - 1])), shape=(last + 1, last + 1))
