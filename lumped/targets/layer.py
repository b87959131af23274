"""A layer on a rigid foundation.

Moving slowly beside its waves, it adds to a striker the mass m_a = density int |u|^2 dV, u the displacement per
unit depth under a flat end as wide as the contact. Energy (m + m_a) v^2/2 + W(depth) is kept, and m_a is nothing at
first touch, so that the striker comes to rest as deep as without; but there the force which it feels,
m W'/(m + m_a) by Lagrange, is less by m_a/m.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, ClassVar

from lumped.errors import BadInput, Fault
from lumped.load_curves.base import LoadCurve
from lumped.load_curves.layer import BASES, LayerCurve, LayerPunch, LineLayer, PointLayer
from lumped.load_curves.tabulated import REACH
from lumped.materials import Material
from lumped.materials.radiation import Pulse, held_wave_speed
from lumped.schema.keys import Choice, Key, Number, Part
from lumped.shapes.base import Shape
from lumped.targets._strains import Pressed
from lumped.targets.base import MOVES, FreeEnd, LeftOut, Target

# m_a/(density area thickness) of a thick layer: what nu = 0 has, and what a bonded and a sliding base add times s^2;
# static fields by finite elements, within a tenth down to contacts a tenth as wide as the layer is thick.
THICK, BONDED, SLIDING = 0.43, 0.2, 0.9
WIDE = f"{REACH:g} thicknesses of the layer"
TORSION = 0.63  # physics: by how much of its width a narrow rectangle's torsional stiffness counts as shorter
BASE = Key(Choice(BASES), "what holds it on its foundation")
FAR = 300.0  # beyond it nothing of 1/cosh is left
NARROW = 1e-3  # below it x^2 is lost beside one, and digits with it


@dataclass(frozen=True)
class Layer(Target):
    """A layer of this thickness, m, bonded to a rigid foundation or sliding on it without leaving it."""

    thickness: Annotated[float, Key(Number(1e-9, 1e6, "m"), "thickness of the layer")]
    base: Annotated[str, BASE]
    name: ClassVar[str] = "layer"
    has_inertia: ClassVar[bool] = True
    large_strains: ClassVar[bool] = True
    endless: ClassVar[bool] = True
    through: ClassVar[str] = "the layer's thickness"

    @property
    def body_depth(self) -> float:
        """Its thickness, m."""
        return self.thickness

    def load_curve(self, shape: Shape, nu: float) -> LoadCurve:
        """By the layer's integral equation."""
        elastic = PointLayer(self.thickness, nu, self.base)
        if shape.plane:
            return LineLayer(shape.line_profile, elastic)
        if shape.fixed_radius is not None:
            return LayerPunch(shape.fixed_radius, elastic)
        return LayerCurve(shape.load_curve, elastic)

    def met_flat(self, shape: Shape) -> tuple[float, bool]:
        """A column's where it is wider than deep."""
        return math.pi * shape.flat_radius**2, shape.flat_radius > self.thickness

    def pressed(self, shape: Shape, nu: float, depth: float, contact_radius: float) -> Pressed:
        """On its own base."""
        return replace(super().pressed(shape, nu, depth, contact_radius), base=self.base)

    def ends(self, shape: Shape, nu: float, contact_radius: float) -> FreeEnd:
        """In plane stress, where the force for its depth is less by nu^2 if the base slides, or the contact is narrow.

        Bonded under a wide one, from the confined modulus to E/(1 - nu^2): by (nu/(1 - nu))^2. There the end lets out
        what the pressure squeezes, as far in as a film's pressure reaches (see :func:`_squeezed`), or, of a strip of
        half-width a that no volume leaves, 0.63 a: its pressure is Saint-Venant's function of a bar under torsion.
        Narrow contacts add what lies below them: half of a film's reach, half of two thicknesses at most. A layer that
        slides is shifted by the stress along it over a strip of its edge, as a plane is in plane stress: 4 a/pi, and
        more by the logarithm of the length, as under a line force.
        """
        a, half = contact_radius, 0.5 * self.thickness
        if self.base == "sliding":
            far = math.log1p(0.5 * shape.total / a) if a > 0.0 else 0.0
            return FreeEnd(nu**2, half + 4.0 / math.pi * a * (1.0 + far))
        narrow, wide = nu**2, (nu / (1.0 - nu)) ** 2
        film = self.thickness * math.sqrt((1.0 - nu) / (1.5 * (1.0 - 2.0 * nu))) if nu < 0.5 else math.inf
        return FreeEnd(narrow + (wide - narrow) * a / (a + half), min(film, min(0.5 * film, 2.0 * half) + TORSION * a))

    @property
    def widest(self) -> float:
        """Radius, m, below which a flat end has to be for a curve of contacts that end beyond it."""
        return REACH * self.thickness

    def strained_instead(self, shape: Shape) -> str:
        """A punch that is not too wide to be followed with an edge."""
        return "" if shape.flat_radius < self.widest else f"a radius below {self.widest:g} m, {WIDE}"

    def check_striker(self, source: str, shape: Shape) -> None:
        """Raise BadInput also for a face whose flat part alone is wider than the layer's curve reaches."""
        super().check_striker(source, shape)
        if shape.fixed_radius is None and shape.flat_radius >= self.widest:
            reason = f"{shape.name}: its flat end is {shape.flat_radius:g} m wide; accepted below {self.widest:g} m"
            raise BadInput(Fault(source, "striker.shape", f"{reason}, {WIDE}"))

    def inertia_left_out(self, shape: Shape, material: Material, pulse: Pulse) -> LeftOut:
        """What of the layer moves with the striker adds m_a to its mass m: the peak force falls by m_a/m.

        A thick one is a half-space: the smaller of the two, or where no echo is back before the peak.
        """
        radiated = super().inertia_left_out(shape, material, pulse)
        if material.density is None:
            return radiated
        if not _echoed(material, pulse.duration, self.thickness):
            return radiated
        plate, a = math.sqrt(material.contact_modulus().spring / material.density), pulse.radius
        way = 0.25 * plate * pulse.duration / self.thickness  # half as far as its waves go until the peak
        share = moving_share(material.nu, self.base, a / self.thickness, way, shape.plane)
        area = 2.0 * a * shape.total if shape.plane else math.pi * a**2
        added = share * material.density * area * self.thickness / pulse.mass
        if radiated.size is not None and radiated.size <= added:
            return radiated
        return LeftOut(added, MOVES.format(added))


MEMBER = Part(Layer)


def _echoed(material: Material, duration: float, thickness: float) -> bool:
    """Whether the fastest waves have gone through a layer, m, and back by half of a pulse, s."""
    speed = held_wave_speed(material, 0.5 * duration)
    return speed is None or 0.5 * duration * speed > 2.0 * thickness


def moving_share(nu: float, base: str, breadth: float, way: float, plane: bool) -> float:
    """m_a over density x contact area x thickness h, under a round contact or in `plane` strain.

    To a factor of two for `breadth`, contact radius a over h, up to 10; of four under a line much narrower than a layer
    that slides. `way`: so many h beyond the contact a sliding layer moves already.
    """
    sideways = (nu / (1.0 - nu)) ** 2  # s^2: s = 1 where the volume stays
    if base == "sliding":
        return THICK + sideways * (SLIDING + _spreading(breadth, way, plane))
    return THICK + sideways * (BONDED + _squeezed(nu, breadth, plane))


def _spreading(breadth: float, way: float, plane: bool) -> float:
    """A disc between sliding faces that moves out by u_r = r/(2 h), and a plate around it, u_r = a^2/(2 h r).

    In plane strain by x/h, and on either side by all of a/h.
    """
    if plane:
        return breadth**2 / 3.0 + breadth * way
    return breadth**2 * (0.125 + 0.5 * math.log1p(way / breadth)) if breadth > 0.0 else 0.0


def _squeezed(nu: float, breadth: float, plane: bool) -> float:
    """A film held below, squeezed out by its pressure: h^2/(3 G) lap p = p/M - 1/h, p(a) = 0, M confined modulus.

    So l^2 = h^2 M/(3 G) and the mean of u_r is (l/h) I_1(r/l)/I_0(a/l); the profile, a parabola, has 6/5 of its square.
    In plane strain (l/h) sinh(x/l)/cosh(a/l). Much narrower than l, as all are once incompressible: r/(2 h), x/h.
    """
    x = breadth * math.sqrt(1.5 * (1.0 - 2.0 * nu) / (1.0 - nu))
    if x < NARROW:
        return (0.4 if plane else 0.15) * breadth**2
    length2 = (breadth / x) ** 2
    if plane:
        return 0.6 * length2 * (math.tanh(x) / x - 1.0 / math.cosh(min(x, FAR)) ** 2)
    from scipy.special import ive  # late: few layers are bonded, wide and compressible

    zero, one, two = (float(ive(order, x)) for order in range(3))
    return 1.2 * length2 * (one**2 - zero * two) / zero**2
