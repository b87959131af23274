"""Central difference, each step in as many equal stages as its limit 2/omega_max asks for: stable for any step.

Two stages are the double step of the leapfrog, whose polynomial in the stiffness is Chebyshev's of order two; elements
of equal length carry waves without dispersion wherever a stage is the time in which one crosses an element.
"""

from __future__ import annotations

from fe_contact.dynamics.schemes.base import Family, Scheme


class _Staged(Scheme):
    """Central difference's numbers, for stages."""

    __slots__ = ()

    @property
    def staged(self) -> bool:
        return True


def of(rho: float) -> Scheme:
    """One member only."""
    return _Staged(alpha_m=0.0, alpha_f=0.0, beta=0.0, gamma=0.5)


MEMBER = Family(of)
