"""The second route to the force of a material with memory: Q/P as a transfer function, "(13)" to "(16)".

F(s) = Q(s)/P(s) y(s) with y the elastic load, d^alpha and its factor. It knows nothing of relaxation moduli or
internal variables, and so judges the laws that do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault
from lumped.materials.relaxation import Relaxation

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TransferFunction:
    """P sigma = Q epsilon: `p` and `q` in ascending powers of d/dt, in units of s^k and Pa s^k.

    Raises BadInput unless the leading coefficients are not zero and deg q <= deg p + 1.
    """

    p: tuple[float, ...]
    q: tuple[float, ...]

    def __post_init__(self) -> None:
        for name, coefficients in (("p", self.p), ("q", self.q)):
            if not coefficients or coefficients[-1] == 0.0 or not np.all(np.isfinite(coefficients)):
                raise BadInput(Fault("transfer function", name, "accepted: finite coefficients, the last not zero"))
        if len(self.q) > len(self.p) + 1:
            raise BadInput(Fault("transfer function", "q", f"accepted: at most {len(self.p) + 1} coefficients"))

    @property
    def viscosity(self) -> float:
        """The part of Q/P that grows as s, Pa s: a dashpot in parallel, which answers the rate of the load."""
        return self.q[-1] / self.p[-1] if len(self.q) == len(self.p) + 1 else 0.0

    def force(self, step: float, load: ArrayLike, rate: ArrayLike | None = None) -> Array:
        """F, N, at times 0, step, 2 step ..., s, for the elastic load over the modulus, m2, at these times, (n,).

        `rate` is the time derivative of the load, m2/s, (n,); only a viscosity needs it, and answers it exactly.
        The rest is exact for a load that is linear between the samples (scipy.signal.lsim). The body is at rest
        before. Raises BadInput.
        """
        from scipy import signal

        y, speed = _checked(step, load, rate, self.viscosity)
        # Time counted in whole histories keeps the coefficients near one another.
        unit = step * y.size
        below, above = _in_units(self.p, unit), _in_units(self._proper(), unit)
        times = np.arange(y.size) / y.size
        _, answer, _ = signal.lsim((above[::-1], below[::-1]), y, times)
        return np.asarray(answer + self.viscosity * speed)

    def _proper(self) -> Array:
        """Q - viscosity s P, of no higher degree than P."""
        remainder = polynomial.polysub(self.q, polynomial.polymulx(np.multiply(self.viscosity, self.p)))
        return np.asarray(remainder[: len(self.p)], dtype=float)


def _in_units(coefficients: ArrayLike, unit: float) -> Array:
    """Coefficients of the derivatives by time in units of `unit`, s."""
    plain = np.asarray(coefficients, dtype=float)
    return np.asarray(plain / unit ** np.arange(plain.size))


def _checked(step: float, load: ArrayLike, rate: ArrayLike | None, viscosity: float) -> tuple[Array, Array]:
    """Load and rate as arrays of one length."""
    y = np.asarray(load, dtype=float)
    if rate is None and viscosity != 0.0:
        raise BadInput(Fault("transfer function", "rate", "missing; deg q = deg p + 1 answers the rate of the load"))
    speed = np.zeros_like(y) if rate is None else np.asarray(rate, dtype=float)
    if not 0.0 < step < np.inf:
        raise BadInput(Fault("transfer function", "step", "accepted: a finite time above zero, in s"))
    if y.ndim != 1 or y.size < 2 or speed.shape != y.shape or not (np.isfinite(y).all() and np.isfinite(speed).all()):
        message = "accepted: two or more finite values, load and rate of one length"
        raise BadInput(Fault("transfer function", "load", message))
    return y, speed


def polynomials(relaxation: Relaxation) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """P and Q of a relaxation modulus, as `operators.of` takes them: P = prod (1 + tau_k d/dt).

    Q/P is its operational modulus. Times that span many decades lose digits here, not in the series itself.
    """
    factors = [np.array([1.0, tau]) for tau in relaxation.times]
    p = _product(factors)
    q = polynomial.polymul(p, [relaxation.equilibrium, relaxation.viscosity])
    for k, (modulus, tau) in enumerate(zip(relaxation.moduli, relaxation.times, strict=True)):
        others = _product(factors[:k] + factors[k + 1 :])
        q = polynomial.polyadd(q, polynomial.polymul([0.0, modulus * tau], others))
    return tuple(p.tolist()), tuple(np.trim_zeros(q, "b").tolist())


def _product(factors: list[Array]) -> Array:
    whole = np.ones(1)
    for factor in factors:
        whole = np.convolve(whole, factor)
    return whole
