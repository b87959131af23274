"""A flat end with a sharp rim and large strains: the limit of ever narrower edges.

At the rim strains have no bound, and on any mesh the body folds about it. Rounded off by a parabola of radius R, a
contact ends b beyond the flat end, where the surface, by stresses of K/sqrt(b), rises as the edge does: K sqrt(b) ~
b^2/R. So b ~ R^(2/3), and what the edge adds to the force goes as b (Ciavarella 1999, doi 10.1093/imamat/63.2.145);
with large strains the power is a little less.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.solids.newton import EquilibriumLost
from lumped.errors import Fault, NotReached
from lumped.indentation import Indentation
from lumped.numbers import Clock
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter
from lumped.shapes.base import SIZE
from lumped.shapes.rounded_punch import RoundedPunch

STEP = math.sqrt(8.0)  # from one radius of the edge to the next
EDGES = tuple(0.25 * STEP**-k for k in range(6))  # these radii over the flat end's, or over a thinner body's depth
FEWEST = 3  # edges that tell a limit
# Powers of the edge's radius by which it adds to the force: that of small strains; the least of six energies to a depth
# of 0.3 radii, where 0.58 to 0.64 shows, and a margin.
ORDERS = (2.0 / 3.0, 0.55)
SHOWN = (0.4, 1.0)  # powers that three edges may show, bars aside: beyond, the body has folded under one of them
SHARE = 0.25  # of the tolerance, asked of every edge: the narrowest counts 1.4 times, the widest 0.4
BEGUN = 2  # place of an edge narrow enough to tell a depth within two per cent

Press = Callable[[Indenter, float], Indentation]  # an indenter to all depths, to a tolerance


def edges_of(geometry: Geometry) -> tuple[float, ...]:
    """Radii of the edges, m, the widest first, that are not too small to be a length."""
    flat = geometry.shape.flat_radius
    length = min(flat, geometry.target.body_depth or flat)
    return tuple(share * length for share in EDGES if share * length >= SIZE.low)


def faults(source: str, geometry: Geometry) -> list[Fault]:
    """What is wrong with a punch, or a layer under it, too small for as many edges as tell a limit."""
    if not geometry.sharp_rim or len(edges_of(geometry)) >= FEWEST:
        return []
    reason = f"too small for large strains; accepted from {SIZE.low / EDGES[FEWEST - 1]:.3g} m on, a layer as thick"
    return [Fault(source, "striker.radius", f"{geometry.shape.flat_radius:g}: {reason}")]


def rounded_shapes(geometry: Geometry) -> tuple[RoundedPunch, ...]:
    """The flat end with each of the edges around it, the widest first."""
    return tuple(RoundedPunch(geometry.shape.flat_radius, edge) for edge in edges_of(geometry))


def rounded(indenter: Indenter, place: int = BEGUN) -> Indenter:
    """The same with one of the edges around its flat end."""
    return replace(indenter, shape=rounded_shapes(indenter.geometry)[place])


def narrowed(indenter: Indenter, tolerance: float, press: Press) -> Indentation:
    """Every depth with edges that grow narrower until the tolerance is met, or no equilibrium is found.

    Raises NotReached where three edges have none, or no limit; BadInput as ``press`` does.
    """
    clock, found, best = Clock(), list[Indentation](), None
    for place in range(len(edges_of(indenter.geometry))):
        try:
            found.append(press(rounded(indenter, place), SHARE * tolerance))
            if len(found) < FEWEST:
                continue
            best = _limit(indenter, tolerance, found[-FEWEST:])
        except NotReached:
            if best is None:
                raise
            break
        if best.converged or best.budget["edge"].max() < SHARE * tolerance:
            break
    assert best is not None
    work = {key: sum(one.work[key] for one in found) for key in found[-1].work}
    return replace(best, timing=clock.read(), work=work)


def _limit(indenter: Indenter, tolerance: float, edges: Sequence[Indentation]) -> Indentation:
    """What three edges, the widest first, tell of none: midway between what both powers say, as far off as these are.

    Farther off where the power that the three show says so. Raises EquilibriumLost where they show none.
    """
    wide, narrow = edges[0], edges[-1]
    falls, onwards = wide.force - narrow.force, ONWARDS
    force = narrow.force - onwards * falls
    unsure = unsure_of(_power(edges)) * np.abs(falls)
    budget = {
        cause: ((1.0 + onwards) * error * narrow.force + onwards * wide.budget[cause] * wide.force) / force
        for cause, error in narrow.budget.items()
    }
    shape = narrow.indenter.shape
    assert isinstance(shape, RoundedPunch)
    return replace(
        narrow,
        indenter=indenter,
        tolerance=tolerance,
        force=force,
        contact_radius=np.full_like(force, shape.flat_radius),
        force_error=(1.0 + onwards) * narrow.force_error + onwards * wide.force_error + unsure,
        budget=budget | {"edge": unsure / force},
        numerics=narrow.numerics | {"tolerance": tolerance, "edge_radius": shape.edge_radius},
    )


def _power(edges: Sequence[Indentation]) -> Array:
    """Of the edge's radius, which the forces show from edge to edge, (n,). Raises EquilibriumLost where they do not."""
    return power_of([one.force for one in edges], [one.force_error for one in edges])


def power_of(values: Sequence[Array], errors: Sequence[Array]) -> Array:
    """Of the edge's radius, (n,), by which values of three edges, each (n,), fall from the widest edge on.

    Raises EquilibriumLost where they show none, whatever their errors, (n,), are.
    """
    wider, narrower = (one - other for one, other in pairwise(values))
    unsure = [one + other for one, other in pairwise(errors)]
    least, most = (STEP**power for power in SHOWN)
    steep = wider - unsure[0] > most * (narrower + unsure[1])
    if np.any(steep | (wider + unsure[0] < least * (narrower - unsure[1]))):
        raise EquilibriumLost("the forces of ever narrower edges around the flat end have no limit")
    ratio = wider / np.maximum(narrower, np.finfo(float).tiny)
    return np.asarray(np.log(np.clip(ratio, least, most)) / math.log(STEP))


def _onwards(power: Array, steps: int = 2) -> Array:
    """What a value still falls by from the narrowest edge on, over what it fell by in the ``steps`` to it, (n,)."""
    return np.asarray(1.0 / (STEP ** (steps * power) - 1.0))


# The same midway between what both powers say: from the widest edge, from the middle one.
ONWARDS, ONWARDS_ONCE = (float(np.mean(_onwards(np.array(ORDERS), steps))) for steps in (2, 1))


def unsure_of(power: Array) -> Array:
    """How far off that may be, (n,): as the powers are, and farther where one that shows, (n,), says so."""
    return np.asarray(np.maximum(np.ptp(_onwards(np.array(ORDERS))) / 2.0, np.abs(_onwards(power) - ONWARDS)))
