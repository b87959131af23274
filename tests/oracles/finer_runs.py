"""Bars against finer runs: both answers hold the truth, so they lie within the sum of their bars."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TypeVar

import numpy as np

from fe_contact.indentation import indent
from fe_contact.solids.newton import BeyondRange
from lumped import NotReached, Result
from lumped.indentation import Indentation
from lumped.scene.indenter import Indenter

Answer = TypeVar("Answer", Indentation, Result)


def answered(ask: Callable[[], Answer], converged: list[bool]) -> Answer | None:
    """Note whether it converged, or not at all where the material ends; None where a named failure says why."""
    try:
        found = ask()
    except BeyondRange:
        return None
    except NotReached:
        converged.append(False)
        return None
    converged.append(found.converged)
    return found


def compare_forces_with_finer(
    pressed: Indenter, depths: tuple[float, ...], tolerance: float, converged: list[bool], wrong: list[str]
) -> None:
    """Note whether a slow indentation converged, and where it lies outside its bars and those of a quarter of it."""
    loose = answered(partial(indent, pressed, depths, {"tolerance": tolerance}), converged)
    tight = loose and answered(partial(indent, pressed, depths, {"tolerance": 0.25 * tolerance}), [])
    if loose is None or tight is None:
        return
    apart = np.abs(loose.force - tight.force) / (loose.force_error + tight.force_error)
    if apart.max() > 1.0:
        wrong.append(f"{pressed.material} {pressed.target} {depths}: {apart}")
