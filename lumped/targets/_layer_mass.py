"""How much of a layer moves with what presses it.

Moving slowly beside its waves, a layer adds to a striker the mass m_a = density int |u|^2 dV, u the displacement per
unit depth under a flat end as wide as the contact. Energy (m + m_a) v^2/2 + W(depth) is kept, and m_a is nothing at
first touch, so that the striker comes to rest as deep as without; but there the force which it feels,
m W'/(m + m_a) by Lagrange, is less by m_a/m.
"""

from __future__ import annotations

import math

from scipy.special import ive

# m_a/(density area thickness) of a thick layer: what nu = 0 has, and what a bonded and a sliding base add times s^2;
# static fields by finite elements, within a tenth down to contacts a tenth as wide as the layer is thick.
THICK, BONDED, SLIDING = 0.43, 0.2, 0.9
FAR = 300.0  # beyond it nothing of 1/cosh is left
NARROW = 1e-3  # below it x^2 is lost beside one, and digits with it


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
    zero, one, two = (float(ive(order, x)) for order in range(3))
    return 1.2 * length2 * (one**2 - zero * two) / zero**2
