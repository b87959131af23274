"""Central difference, each step in as many equal stages as its limit 2/omega_max asks for: stable for any step.

Two stages are the double step of the leapfrog, whose polynomial in the stiffness is Chebyshev's of order two; elements
of equal length carry waves without dispersion wherever a stage is the time in which one crosses an element.
"""

from __future__ import annotations

from fe_contact.dynamics.schemes.base import Family, Scheme


def of(rho: float) -> Scheme:
    """One member only."""
    return Scheme(alpha_m=0.0, alpha_f=0.0, beta=0.0, gamma=0.5, staged=True)


MEMBER = Family(of)
