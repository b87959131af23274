"""Elastic indentation of the half-space in closed form, per unit contact modulus E*."""

from lumped.load_curves.base import LoadCurve as LoadCurve
from lumped.load_curves.hertz import Hertz as Hertz
from lumped.load_curves.hertz import HertzImpact as HertzImpact
from lumped.load_curves.sneddon_sphere import SneddonSphere as SneddonSphere
