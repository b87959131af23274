"""The contact radius that the coming step of a march will find, told by those of the last steps."""

from __future__ import annotations

from collections.abc import Sequence

from fe_contact.steppers.steps import Step


def coming_square(steps: Sequence[Step], at: float) -> float:
    """Square of the contact radius at a time, s, after one step or more; m2.

    It is smooth in time, and zero at touch: the polynomial through the last two or three, Newton's form.
    """
    known = [(0.0, 0.0), *((step.radius_time, step.radius**2) for step in steps[-3:])][-3:]
    (before, previous), (last, value) = known[-2:]
    slope = (value - previous) / (last - before)
    if len(known) < 3:
        return value + slope * (at - last)
    first, start = known[0]
    bend = (slope - (previous - start) / (before - first)) / (last - first)
    return value + (at - last) * (slope + bend * (at - before))
