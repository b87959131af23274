"""Newmark's constant average acceleration: keeps the energy of a linear body, and every oscillation with it."""

from __future__ import annotations

from fe_contact.dynamics.schemes.base import Family, Scheme


def of(rho: float) -> Scheme:
    """One member only."""
    return Scheme(alpha_m=0.0, alpha_f=0.0, beta=0.25, gamma=0.5)


MEMBER = Family(of)
