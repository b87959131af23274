"""Newmark with beta = gamma = 1: order one, damps everything; kept as the classical contrast."""

from __future__ import annotations

from fe_contact.dynamics.schemes.base import Family, Scheme


def of(rho: float) -> Scheme:
    """One member only."""
    return Scheme(alpha_m=0.0, alpha_f=0.0, beta=1.0, gamma=1.0)


MEMBER = Family(of)
