"""Slow indentation of a half-space that yields, its bars from what every setting changes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.refine import Finer, dominant, refine
from fe_contact.plastic.course import BEYOND, Course, Loading, Pressed, coarser, settings
from fe_contact.progress import Progress
from fe_contact.settings import Given, Numerics
from lumped.indentation import Indentation
from lumped.numbers import Clock
from lumped.scene.indenter import Indenter

SAFETY = 1.25  # of an error over the change that tells it
AROUND = 0.7  # in ln depth: a change counts as the error of its neighbours, for it may vanish where it changes sign
DENSE = 80  # depths at which changes are read
ROUNDS = 1  # of refinement
KEPT = ("tolerance", "elements_per_contact", "order", "penalty", "steps", "far_radius")


@dataclass(frozen=True, eq=False)
class Answer:
    """ln of the force at depths (n,), m, extrapolated in the steps; ``pressed`` the finest run; errors by cause."""

    depth: Array
    logarithm: Array
    pressed: Pressed
    budget: Mapping[str, Array]
    numerics: Numerics
    work: Mapping[str, int]


def indent(indenter: Indenter, depths: tuple[float, ...], given: Given, progress: Progress) -> Indentation:
    """Press to every depth, m; refine once where bars exceed the tolerance.

    Raises BadInput for depths that cannot be, NotReached where nothing settles.
    """
    clock = Clock()
    asked = np.array(indenter.checked(depths))
    course = Course.of(indenter, float(asked.min()), float(asked.max()))
    way = Indenting(course, asked, frozenset(given) - {"tolerance"}, progress)
    found, _ = refine(way, settings(given, course.rim))
    radius = found.pressed.contact_radius(asked)
    indenter.check_contacts(asked, radius)
    force = np.exp(np.interp(np.log(asked), np.log(found.depth), found.logarithm - np.log(found.depth)) + np.log(asked))
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
class Indenting:
    """The way of an indentation of what yields."""

    course: Course
    asked: Array
    pinned: frozenset[str]
    progress: Progress
    rounds: ClassVar[int] = ROUNDS

    def certified(self, numerics: Numerics) -> Answer:
        """Forces and what each setting changes of them. Raises NotReached where nothing settles."""
        dense = np.geomspace(self.asked.min(), self.asked.max(), DENSE)
        depth = np.unique(np.concatenate([dense, self.asked]))
        runs = Runs(self.course, depth, numerics, self.progress)
        return runs.answer()

    def finer(self, found: Answer) -> Finer:
        """Less of what dominates, until the tolerance is met."""
        errors = {cause: float(error.max()) for cause, error in found.budget.items()}
        if sum(errors.values()) <= found.numerics.tolerance:
            return Finer(None)
        return Finer(dominant(errors, found.numerics, self.pinned))


@dataclass(eq=False)
class Runs:
    """Loadings with settings varied, told at depths (n,), m."""

    course: Course
    depth: Array
    numerics: Numerics
    progress: Progress

    def answer(self) -> Answer:
        """Of all of them."""
        course = self.course
        if self.numerics.contact_radius != 1.0:  # it outgrew what was expected
            course = replace(course, deepest=course.deepest * self.numerics.contact_radius**2)
        base = self._run(course, self.numerics)
        coarse = coarser(self.numerics)
        steps = coarse.steps
        same = self._run(course, coarse)
        finer = self._run(course, coarse.varied(steps=2 * steps))
        few = coarse.varied(steps=max(steps // 2, 4))
        fewer = self._run(course, few)
        softer = self._run(course, few.varied(penalty=0.5 * few.penalty))
        nearer = self._run(course, few, cut=True)
        told = [run.pressed.logarithm(self.depth) for run in (base, same, finer, fewer, softer, nearer)]
        at_base, at_same, at_finer, at_fewer, at_softer, at_nearer = told
        budget = {
            "mesh": SAFETY * np.abs(at_base - at_same),
            "penalty": SAFETY * np.abs(at_fewer - at_softer),
            "time_step": SAFETY / 3.0 * np.abs(extrapolated(at_finer, at_same) - extrapolated(at_same, at_fewer)),
            "far_field": SAFETY / 3.0 * np.abs(at_fewer - at_nearer),
        }
        every = (base, same, finer, fewer, softer, nearer)
        return Answer(
            depth=self.depth,
            logarithm=at_base + 4.0 / 3.0 * (at_finer - at_same),
            pressed=base.pressed,
            budget={cause: around(self.depth, error) for cause, error in budget.items()},
            numerics=self.numerics,
            work={
                "degrees_of_freedom": base.presser.ground.unknowns,
                "contact_problems": sum(run.counts.problems for run in every),
                "iterations": sum(run.counts.iterations for run in every),
            },
        )

    def _run(self, course: Course, numerics: Numerics, cut: bool = False) -> Loading:
        self.progress(f"{numerics.elements_per_contact:.3g} elements along the contact radius, {numerics.steps} steps")
        loading = Loading.of(course, numerics, cut)
        loading.to(BEYOND * self.course.deepest)
        return loading


def extrapolated(fine: Array, coarse: Array) -> Array:
    """Of two runs whose steps are as one to two, without what errs by the square of the step."""
    return fine + (fine - coarse) / 3.0


def around(depth: Array, error: Array) -> Array:
    """The largest error near every depth."""
    near = np.abs(np.log(depth[:, None] / depth[None])) <= AROUND
    return np.asarray(np.where(near, error[None], 0.0).max(axis=1))
