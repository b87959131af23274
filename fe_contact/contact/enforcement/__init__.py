"""Ways to keep two surfaces apart, one a file: each offers ``enforce(problem, *guesses)``.

A member maps a :class:`fe_contact.contact.problem.ContactProblem` and first guesses of the touching points, one or one
for each contact problem it solves, to a :class:`fe_contact.contact.problem.ContactSolution`. It says in ``SOLVES`` how
many contact problems it costs at most. A member whose pressure follows from the overlap alone also offers
``signed_pressure(overlap, penalty)``; one whose answer depends on the penalty says ``SOFT = True``.
"""

from __future__ import annotations

from lumped.schema.members import get


def is_soft(name: str) -> bool:
    """Whether what a member answers depends on the penalty."""
    return getattr(get(__name__, name), "SOFT", False)
