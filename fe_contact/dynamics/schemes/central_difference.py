"""Central difference: nothing to solve with a diagonal mass, stable up to dt = 2/omega_max."""

from __future__ import annotations

from fe_contact.dynamics.schemes.base import Family, Scheme


def of(rho: float) -> Scheme:
    """One member only."""
    return Scheme(alpha_m=0.0, alpha_f=0.0, beta=0.0, gamma=0.5)


MEMBER = Family(of)
