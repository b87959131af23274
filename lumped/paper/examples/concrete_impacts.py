"""Impacts of the paper's concrete striker, whose head and pole are not printed: radius and section are assumed."""

from __future__ import annotations

from functools import cache

from lumped.laws import correspondence
from lumped.materials import Material
from lumped.materials.networks import sls
from lumped.paper.examples.given import Concrete
from lumped.paper.examples.plateau import PlateauCut, plateau_cut
from lumped.paper.examples.value import read
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.shapes import Sphere

TOLERANCE = 1e-6
# The fit takes the printed moduli as contact moduli, so Poisson's ratio plays no part.
NU = 0.0


@cache
def proposed(concrete: Concrete, radius: float, velocity: float) -> Result:
    """The 3-parameter solid on a round head of this radius, m, at a velocity, m/s. Raises NotReached."""
    material = Material(sls.of(E1=concrete.E1, E2=concrete.E2, C1=concrete.C1), NU)
    parabola = Model(profile="parabola")
    scene = Scene(Sphere(radius), concrete.mass, velocity, material, model=parabola, name="concrete striker")
    return correspondence.of(scene).simulate(scene, TOLERANCE)


@cache
def cut_at_measured_peak(concrete: Concrete) -> PlateauCut:
    """The force at the higher velocity cut at the experiment's peak, which its printed error tells.

    Over the uncut force and its duration no radius enters; the smallest assumed one is taken.
    """
    impact = proposed(concrete, min(concrete.radii), max(concrete.velocities))
    return plateau_cut(impact.history, read(impact, "peak_force").value / (1.0 + concrete.peak_error))
