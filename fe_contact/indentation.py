"""Slow indentation by finite elements: every depth, every setting varied once, bars from what changes.

Elastic with one modulus, so that a force is modulus times what the unit material answers.

How large slow contacts will be, about: what meshes are made for. It enters no value.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fe_contact.assembly.forms import Array, Indices, check_compressible
from fe_contact.bodies.pressing import Pressed, PressedDepths, Still
from fe_contact.budget.certify import LEAST_ORDER, other_mesh, other_setting
from fe_contact.budget.plan import DEFAULTS, ELEMENTS, RIM_PENALTY
from fe_contact.budget.refine import Finer, dominant, refine
from fe_contact.budget.variation import factor
from fe_contact.errors import faults_of
from fe_contact.plastic import indent as plastic
from fe_contact.progress import Count, Counted, Progress, silent, uncounted
from fe_contact.settings import DEFAULT_TOLERANCE, Given, Numerics, check_kind, tolerance_of
from fe_contact.solids import pressing as solids
from fe_contact.solids import sharp_rim
from fe_contact.targets.base import TARGETS
from fe_contact.threads import one_thread
from lumped.errors import BadInput, Fault
from lumped.indentation import Indentation
from lumped.numbers import Clock
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene
from lumped.shapes import Shape

KEPT = ("tolerance", "elements_per_contact", "order", "penalty", "enforcement", "far_radius")  # settings, of all
CAUSES = ("mesh", "penalty", "far_field")  # that a setting lessens
LAST_NU = 0.5 - 1e-9  # solves lose their digits as 1/(1 - 2 nu): no answer from 1e-12 on, right ones still at 1e-10
ROUNDING = 1e-9  # relative, of a solve of nearly incompressible bodies: where nothing else errs
ROUNDS = 5  # refinements before giving up
FEWEST = 12  # depths that tell an error bar
FEWEST_SOFT = 4  # those of them that tell what the penalty changes
FEWEST_LARGE = 8  # the same of large strains, where each takes a Newton iteration or five on the whole mesh
COARSEST = 2.0  # elements of large strains along a contact: half of fewer tells nothing
SPREAD = 0.6  # of them at least, smallest over largest: contact edges over an element of the coarser mesh
BISECTIONS = 40  # work: halvings of the place where undeformed surfaces cease to overlap
SMALL = 1e-3  # radius, in depths, from which the search for the overlap's end begins
SCOUTING, SCOUTING_ORDER = 2.0, 2  # elements along the contact radius that tell how large contacts will be
LEAST_SHARE, LARGEST_SHARE = 0.4, 2.0  # contact radius over the one at which the undeformed surfaces overlap


def indenter_of(scene: Scene) -> Indenter:
    """The bodies of a scene, without their motion."""
    geometry = scene.geometry
    return Indenter(geometry.shape, geometry.material, geometry.target, geometry.striker_material, scene.model,
                    scene.name, scene.source)  # fmt: skip


@one_thread
def indent(
    indenter: Indenter,
    depths: tuple[float, ...],
    given: Given,
    instant: bool = False,
    progress: Progress = silent,
) -> Indentation:
    """Press to every depth, m, refine what stands in the way of the tolerance, and say what was reached.

    ``given``: checked settings to keep; ``instant``: the material against a sudden indentation.
    Raises BadInput for depths and materials that cannot be, and for contacts too wide for the target; NotReached where
    contact does not settle.
    """
    clock = Clock()
    with faults_of(indenter):
        check_kind(given, False, indenter.source)
        if indenter.model.plasticity:
            return plastic.indent(indenter, depths, given, progress)
        modulus, asked = indenter.modulus(instant), len(indenter.checked(depths))
        depth = _accompanied(np.array(depths), FEWEST_LARGE if indenter.model.finite else FEWEST)
        elastic, numerics = indenter.elastic(instant), settings(given, indenter.shape, indenter.model.finite)
        check_compressible(indenter)
        _check_digits(elastic)
        if indenter.model.finite:
            solids.check_large(indenter.source, indenter.geometry, indenter.model, numerics.enforcement)
            if indenter.geometry.sharp_rim:
                return sharp_rim.narrowed(indenter, numerics.tolerance, _with_edge(depths, given, instant, progress))
        way = Indenting(elastic, depth, expected(elastic, depth, numerics), frozenset(given) - {"tolerance"}, progress)
        found, _ = refine(way, numerics)
        base, budget, numerics = found.base, found.budget, found.numerics
        indenter.check_contacts(depth[:asked], base.contact_radius[:asked])
    error = ROUNDING + np.sum(list(budget.values()), axis=0)[:asked]
    force = (modulus * indenter.shape.total * base.force)[:asked]
    return Indentation(
        indenter=indenter,
        method="fe",
        modulus=modulus,
        tolerance=numerics.tolerance,
        depth=depth[:asked],
        force=force,
        contact_radius=base.contact_radius[:asked],
        force_error=error * force,
        budget={cause: error[:asked] for cause, error in budget.items()},
        numerics={key: value for key, value in numerics.as_dict().items() if key in KEPT},
        timing=clock.read(),
        work=base.work,
    )


def _with_edge(depths: tuple[float, ...], given: Given, instant: bool, progress: Progress) -> sharp_rim.Press:
    """How an indenter whose rim is rounded off is pressed."""
    return lambda one, tolerance: indent(one, depths, {**given, "tolerance": tolerance}, instant, progress)


@dataclass(frozen=True, eq=False)
class PressedBudget:
    """Every depth with one setting of everything, and by cause the relative error of the force there, (n,)."""

    base: PressedDepths
    budget: Mapping[str, Array]
    numerics: Numerics


@dataclass(frozen=True, eq=False)
class Indenting:
    """The way of an indentation: to every ``depth``, m, from the contact ``radii`` expected there, m, (n,)."""

    elastic: Indenter
    depth: Array
    radii: Array
    pinned: frozenset[str]
    progress: Progress
    rounds: ClassVar[int] = ROUNDS

    def certified(self, numerics: Numerics) -> PressedBudget:
        """The forces and what each setting changes of them. Raises NotReached where contact does not settle."""
        message = f"{numerics.elements_per_contact:g} elements along the contact radius"
        counted = Count.of(self.progress, message, 2.0 * self.depth.size)
        base = press(self.elastic, self.depth, self.radii, numerics, self._softer(numerics), counted)
        budget = self._budget(base, numerics, counted)
        errors = {cause: np.full(self.depth.size, error) for cause, error in budget.items()}
        return PressedBudget(base, errors, numerics)

    def finer(self, found: PressedBudget) -> Finer:
        """Less of what dominates, until the tolerance is met."""
        errors = {cause: float(found.budget[cause].max()) for cause in CAUSES}
        if sum(errors.values()) <= found.numerics.tolerance:
            return Finer(None)
        kept = self.pinned | solids.exhausted(found.base.mesh_order, found.numerics)
        return Finer(dominant(errors, found.numerics, kept))

    def _budget(self, base: PressedDepths, numerics: Numerics, counted: Counted) -> dict[str, float]:
        """Relative error of the force by cause; ``counted`` is told of every depth.

        The far field is varied on the other mesh, which as a rule is the cheaper one, unless the body ends before; the
        penalty costs no mesh, and in large strains a few depths tell of it as they are reached.
        """
        other, by_mesh = other_mesh(numerics, base.mesh_order)
        far, farther = other_setting(other, "far_radius")
        penalty, stiffer = other_setting(numerics, "penalty")
        many, few = self._telling(FEWEST_LARGE), self._telling(FEWEST_SOFT)
        on_soft = self._press(few, penalty, counted) if base.softer is None else base.softer
        on_other = self._press(many, other, counted)
        on_far = on_other if on_other.ends else self._press(many, far, counted)
        by_penalty = factor(LEAST_ORDER["penalty"], stiffer)
        return {
            "mesh": _error(by_mesh, base.at(many), on_other),
            "penalty": _error(by_penalty, base.at(few), on_soft),
            "far_field": _error(factor(LEAST_ORDER["far_field"], farther), on_other, on_far),
            "newton": base.newton,
        }

    def _softer(self, numerics: Numerics) -> solids.Softer | None:
        """Of large strains, which depths tell of the penalty, and of what other one."""
        other = other_setting(numerics, "penalty")[0].penalty
        return solids.Softer(self._telling(FEWEST_SOFT), other) if self.elastic.model.finite else None

    def _press(self, told: Indices, numerics: Numerics, counted: Counted) -> PressedDepths:
        return press(self.elastic, self.depth[told], self.radii[told], numerics, counted=counted)

    def _telling(self, few: int) -> Indices:
        """Depths that tell of a setting: all, but where each is dear a few from the smallest to the largest."""
        order = np.argsort(self.depth)
        if self.elastic.model.finite and order.size > few:
            order = order[np.linspace(0, order.size - 1, few).astype(int)]
        return np.asarray(np.sort(order))


def _check_digits(elastic: Indenter) -> None:
    """Raise BadInput for a fluid whose volume, pressed at once, leaves a solve no digits of its shape."""
    faults = [
        Fault(elastic.source, f"{part}.material.bulk_modulus", f"as stiff beside the shear as nu = {material.nu:.12g}; "
              f"accepted by finite elements: up to nu = {LAST_NU:.10g}; cure: a lower one")
        for part, material in elastic.geometry.yielding
        if material.nu > LAST_NU
    ]  # fmt: skip
    if faults:
        raise BadInput(faults)


def _accompanied(depth: Array, fewest: int) -> Array:
    """The depths, m, and some between them: how far a mesh errs depends on where in an element a contact ends.

    A lone depth could end where two meshes agree by chance.
    """
    if depth.size >= fewest:
        return depth
    return np.concatenate([depth, np.geomspace(min(depth.min(), SPREAD * depth.max()), depth.max(), fewest)])


def settings(given: Given, shape: Shape, large: bool = False) -> Numerics:
    """Settings of an indentation: those of an impact without its time; stiffer where no edge has to be found.

    Of ``large`` strains, where every element is dear, no more elements than a loose tolerance asks for.
    """
    tolerance = tolerance_of(given)
    elements = ELEMENTS * max(1.0, (1e-4 / tolerance) ** 0.25)
    if large:
        elements = max(COARSEST, elements * min(1.0, (DEFAULT_TOLERANCE / tolerance) ** 0.5))
    penalty = DEFAULTS["penalty"] * (1.0 if shape.fixed_radius is None else RIM_PENALTY)
    chosen = {**DEFAULTS, "tolerance": tolerance, "elements_per_contact": elements, "penalty": penalty, "steps": 8}
    return Numerics(**{**chosen, **given}, contact_radius=1.0, contact_time=1.0, peak_share=0.5)


def press(
    indenter: Indenter,
    depth: Array,
    radii: Array,
    numerics: Numerics,
    softer: solids.Softer | None = None,
    counted: Counted = uncounted,
) -> PressedDepths:
    """Every depth, m, with one setting of everything, from the largest to the smallest; ``radii`` to begin with, m.

    ``softer``: of large strains, depths that another penalty is tried at; ``counted`` is told of each that is pressed.
    """
    if indenter.model.finite:
        return solids.press(indenter, depth, radii, numerics, softer, counted)
    body: Still = TARGETS.get(indenter.target.name).still(indenter, radii, numerics)
    growth, found = 1.0, dict[int, Pressed]()
    for i in np.argsort(-depth).tolist():
        found[i] = body.press(float(depth[i]), growth * float(radii[i]))
        growth = found[i].contact_radius / float(radii[i])
        counted(1.0)
    pressed = [found[i] for i in sorted(found)]
    work = {
        "degrees_of_freedom": body.degrees_of_freedom,
        "contact_problems": sum(one.problems for one in pressed),
        "iterations": sum(one.iterations for one in pressed),
    }
    force, radius = np.array([(one.force, one.contact_radius) for one in pressed]).T
    return PressedDepths(force, radius, work, body.mesh_order, body.ends)


def _error(trusted: float, first: PressedDepths, second: PressedDepths) -> float:
    """Error by a cause: what its other setting changes, ``trusted`` so many times.

    A body without a length of its own answers alike at every depth, so the largest change speaks for all.
    """
    return float(trusted * np.abs(second.force / first.force - 1.0).max())


def expected(indenter: Indenter, depth: Array, numerics: Numerics) -> Array:
    """Contact radii which the meshes are made for, m, shape (n,); they enter no value.

    Of a body without a length of its own by its exact curve; else where the undeformed surfaces overlap, times what a
    coarse mesh finds of it at the extreme depths, both counted from the end of what is flat.
    """
    if not indenter.target.has_length:
        return np.asarray(indenter.target.load_curve(indenter.profile, indenter.material.nu).contact_radius(depth))
    overlapping = _overlapping(indenter, depth)
    if indenter.target.fixed_radius(indenter.shape) is not None:
        return overlapping
    ends, flat = [int(depth.argmin()), int(depth.argmax())], indenter.profile.flat_radius
    flat = flat if indenter.target.endless else 0.0  # what is round bends away from a flat end as from a wide one
    coarse, beyond = numerics.varied(elements_per_contact=SCOUTING, order=SCOUTING_ORDER), overlapping - flat
    reach = flat + beyond[ends] * np.array([LEAST_SHARE, LARGEST_SHARE])
    body: Still = TARGETS.get(indenter.target.name).still(indenter, reach, coarse)
    found = np.array([body.press(float(depth[i]), float(overlapping[i])).contact_radius for i in ends])
    shares = np.where(found > flat, (found - flat) / beyond[ends], LEAST_SHARE)
    share = np.interp(np.log(depth), np.log(depth[ends]), np.log(shares))
    return np.asarray(flat + beyond * np.exp(share))


def _overlapping(indenter: Indenter, depth: Array) -> Array:
    """Length on the target up to which the undeformed surfaces overlap at each depth, m, by bisection; shape (n,)."""
    target, profile = indenter.target, indenter.profile
    fixed = target.fixed_radius(indenter.shape)
    if fixed is not None:
        return np.full_like(depth, fixed)
    low, high = np.zeros_like(depth), SMALL * depth / target.length_of_place
    while np.any(touched := target.overlap(profile, high, depth) > 0.0):
        high = np.where(touched, 2.0 * high, high)
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        touched = target.overlap(profile, middle, depth) > 0.0
        low, high = np.where(touched, middle, low), np.where(touched, high, middle)
    return target.length_of_place * high
