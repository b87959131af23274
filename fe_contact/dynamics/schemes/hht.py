"""Hilber, Hughes and Taylor 1977, doi:10.1002/eqe.4290050306: order two, forces balanced before the step's end."""

from __future__ import annotations

from fe_contact.dynamics.schemes.base import Family, Scheme

LEAST = 0.5  # spectral radius below which the family's order or stability is lost


def of(rho: float) -> Scheme:
    """``rho`` between 1/2 and 1; less is taken as 1/2."""
    radius = max(rho, LEAST)
    alpha = (1 - radius) / (1 + radius)
    return Scheme(alpha_m=0.0, alpha_f=alpha, beta=(1 + alpha) ** 2 / 4, gamma=0.5 + alpha)


MEMBER = Family(of)
