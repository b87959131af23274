"""How an impact can end."""

from __future__ import annotations

from enum import Enum

# In a fluid without gravity the approach may die away without a turn: below this share of the velocity at
# touch the striker counts as at rest.
AT_REST = 1e-7


class End(Enum):
    """Why the history of an impact stops; the value says so to the user."""

    SEPARATED = "separated"
    TIME = "not separated at end_time"
    REST = "not separated: the striker came to rest"
    SECOND_APPROACH = "the striker approaches again before it has left, which this law does not follow"
