"""Slow indentation of a half-space that yields, its bars from what every setting changes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.refine import Finer, refine
from fe_contact.budget.variation import SAFETY
from fe_contact.plastic.course import (
    BEYOND,
    MOST_STEPS,
    Contrast,
    Course,
    Forces,
    PlasticLoading,
    Varied,
    check_given,
    finer,
    settings,
    within_core,
)
from fe_contact.plastic.path import PlasticFlowLost
from fe_contact.progress import Progress
from fe_contact.settings import Given, Numerics
from lumped.indentation import Indentation
from lumped.numbers import Clock
from lumped.scene.indenter import Indenter

AROUND = 0.7  # in ln depth: a change counts as the error of its neighbours, for it may vanish where it changes sign
DENSE = 80  # depths at which changes are read
ROUNDS = 1  # of refinement: a finer mesh is four times as dear
KEPT = ("tolerance", "elements_per_contact", "order", "penalty", "steps", "far_radius")


@dataclass(frozen=True, eq=False)
class ForcesFound:
    """ln of the force at depths (n,), m, extrapolated in the steps; ``pressed`` the finest run; errors by cause."""

    depth: Array
    logarithm: Array
    pressed: Forces
    budget: Mapping[str, Array]
    numerics: Numerics
    work: Mapping[str, int]


def indent(indenter: Indenter, depths: tuple[float, ...], given: Given, progress: Progress) -> Indentation:
    """Press to every depth, m; refine once where bars exceed the tolerance.

    Raises BadInput for depths that cannot be, NotReached where nothing settles.
    """
    clock = Clock()
    check_given(given, indenter.source, indenter.profile)
    asked = np.array(indenter.checked(depths))
    course = Course.of(indenter, float(asked.min()), float(asked.max()))
    way = YieldingWay(course, asked, frozenset(given) - {"tolerance"}, progress)
    found = _found(way, settings(given, course))
    radius = found.pressed.contact_radius(asked)
    indenter.check_contacts(asked, radius)
    force = np.exp(np.interp(asked, found.depth, found.logarithm))
    budget = {cause: np.interp(asked, found.depth, error) for cause, error in found.budget.items()}
    return Indentation(
        indenter=indenter,
        method="fe",
        modulus=course.modulus,
        tolerance=found.numerics.tolerance,
        depth=asked,
        force=force,
        contact_radius=radius,
        force_error=np.sum(list(budget.values()), axis=0) * force,
        budget=budget,
        numerics={key: value for key, value in found.numerics.as_dict().items() if key in KEPT},
        timing=clock.read(),
        work=found.work,
    )


@dataclass(frozen=True, eq=False)
class YieldingWay:
    """The way of an indentation of what yields."""

    course: Course
    asked: Array
    pinned: frozenset[str]
    progress: Progress
    rounds: ClassVar[int] = ROUNDS

    def certified(self, numerics: Numerics) -> ForcesFound:
        """Forces and what each setting changes of them. Raises NotReached where nothing settles."""
        course = self.course.outgrown(numerics.contact_radius)
        return within_core(course, partial(self._forces, numerics))

    def _forces(self, numerics: Numerics, course: Course) -> ForcesFound:
        depth = np.unique(np.concatenate([np.geomspace(self.asked.min(), self.asked.max(), DENSE), self.asked]))
        loadings = Varied.of(partial(self._run, course), numerics, self.course.coarsest(numerics))
        pressed = [loading.pressed for loading in loadings]
        told = Varied(*(one.logarithm(depth) for one in pressed))
        missed = np.median([one.misfit(depth) for one in Varied(*pressed).meshes], axis=0)
        pairs = told.pairs(_onwards, self.course.settling(numerics))
        pairs["time_step"] += (Contrast(missed, np.zeros_like(missed), SAFETY),)
        return ForcesFound(
            depth=depth,
            logarithm=told.mended(_onwards),
            pressed=pressed[0],
            budget={
                cause: around(depth, np.sum([one.factor * np.abs(one.first - one.second) for one in own], axis=0))
                for cause, own in pairs.items()
            },
            numerics=numerics,
            work={
                "degrees_of_freedom": loadings.base.presser.ground.unknowns,
                "contact_problems": sum(loading.presser.counts.problems for loading in loadings),
                "iterations": sum(loading.presser.counts.iterations for loading in loadings),
            },
        )

    def finer(self, found: ForcesFound) -> Finer:
        """Less of what dominates, until the tolerance is met."""
        shares = {cause: error / found.numerics.tolerance for cause, error in found.budget.items()}
        if np.sum(list(shares.values()), axis=0).max() <= 1.0:
            return Finer(None)
        return Finer(finer(shares, found.numerics, self.pinned))

    def _run(self, course: Course, numerics: Numerics, cut: bool) -> PlasticLoading:
        loading = PlasticLoading.with_progress(course, numerics, cut, self.progress)
        loading.to(BEYOND * self.course.deepest)
        return loading


def _found(way: YieldingWay, numerics: Numerics) -> ForcesFound:
    """What refinement finds; where flow is lost, from twice the steps on: a perfectly plastic body gives way at once.

    Raises NotReached.
    """
    try:
        return refine(way, numerics)[0]
    except PlasticFlowLost:
        if "steps" in way.pinned or 2 * numerics.steps > MOST_STEPS:
            raise
        return _found(way, numerics.varied(steps=2 * numerics.steps))


def _onwards(one: Array, fine: Array, coarse: Array, weight: float) -> Array:
    return one + weight * (fine - coarse)


def around(depth: Array, error: Array) -> Array:
    """The largest error near every depth."""
    near = np.abs(np.log(depth[:, None] / depth[None])) <= AROUND
    return np.asarray(np.where(near, error[None], 0.0).max(axis=1))
