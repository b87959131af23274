"""Elastic indentation per unit contact modulus E*: the half-space in closed form, and what lies beyond it."""

from lumped.load_curves.base import LoadCurve as LoadCurve
from lumped.load_curves.cone import ConeCurve as ConeCurve
from lumped.load_curves.fixed_area import FixedArea as FixedArea
from lumped.load_curves.fixed_area import PunchCurve as PunchCurve
from lumped.load_curves.half_plane import HalfPlane as HalfPlane
from lumped.load_curves.half_space import HalfSpaceCurve as HalfSpaceCurve
from lumped.load_curves.hertz import Hertz as Hertz
from lumped.load_curves.hertz import HertzImpact as HertzImpact
from lumped.load_curves.layer import LayerCurve as LayerCurve
from lumped.load_curves.layer import LayerPunch as LayerPunch
from lumped.load_curves.layer import LineLayer as LineLayer
from lumped.load_curves.layer import PointLayer as PointLayer
from lumped.load_curves.plane_contact import CylinderProfile as CylinderProfile
from lumped.load_curves.plane_contact import ParabolaProfile as ParabolaProfile
from lumped.load_curves.power import Power as Power
from lumped.load_curves.ring import RodInRing as RodInRing
from lumped.load_curves.sneddon_sphere import SneddonSphere as SneddonSphere
