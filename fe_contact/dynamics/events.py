"""First touch and separation within a step, from what is known at its ends."""

from __future__ import annotations

import numpy as np

from fe_contact.assembly.forms import Array


def touched(time: float, step: float, overlap: Array, closing: Array) -> float:
    """When the first open point closes, s, in a step from ``time`` that ends in touch; overlaps (q,) at its start."""
    coming = closing > 0.0
    if not coming.any():
        return time + step
    return time + float(np.clip(np.min(-overlap[coming] / closing[coming]), 0.0, step))


def parted(time: float, step: float, held: Array, open_: Array) -> float:
    """When the last point opened, s, in a step from ``time``: the signed pressures (q,) at its ends, along a line."""
    last, beyond = float(held.max()), float(open_.max())
    return time + step * last / (last - beyond)
