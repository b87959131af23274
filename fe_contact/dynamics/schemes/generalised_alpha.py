"""Chung and Hulbert's generalised-alpha 1993, doi:10.1115/1.2900803: order two, damps what the step cannot follow."""

from __future__ import annotations

from fe_contact.dynamics.schemes.base import Family, Scheme


def of(rho: float) -> Scheme:
    """``rho`` 1: no damping at all; 0: the fastest oscillations are gone after one step."""
    alpha_m, alpha_f = (2 * rho - 1) / (rho + 1), rho / (rho + 1)
    return Scheme(alpha_m, alpha_f, beta=(1 - alpha_m + alpha_f) ** 2 / 4, gamma=0.5 - alpha_m + alpha_f)


MEMBER = Family(of)
