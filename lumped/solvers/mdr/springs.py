"""Springs that are pressed together, as sums over them; all forces and energies are those of one half of the row.

A spring at x carries, per length, E_inf (depth - g) + eta depth' + sum z_k with z_k' = E_k depth' - z_k/tau_k. Springs
in contact are stretched alike, so z_k = Z_k - c_k: Z_k is that of the spring at the axis, c_k what that one carried
when this one was touched, and has kept since.
"""

from __future__ import annotations

from typing import NamedTuple

from lumped.materials import Relaxation
from lumped.solvers.mdr.memory import Fading

Values = list[float]


class Springs(NamedTuple):
    """Sums over springs of their widths w, and of w g, w g^2, and per branch w c_k, w c_k^2."""

    width: float
    rest: float
    rest_square: float
    kept: Values
    kept_square: Values

    @classmethod
    def one(cls, width: float, rest: float, kept: Values) -> Springs:
        """A single spring of this width, touched at the depth `rest`."""
        return cls(width, width * rest, width * rest * rest, [width * c for c in kept], [width * c * c for c in kept])

    def plus(self, other: Springs, sign: float = 1.0) -> Springs:
        """These and those; with the sign -1 these without those."""
        return Springs(
            self.width + sign * other.width,
            self.rest + sign * other.rest,
            self.rest_square + sign * other.rest_square,
            [mine + sign * its for mine, its in zip(self.kept, other.kept, strict=True)],
            [mine + sign * its for mine, its in zip(self.kept_square, other.kept_square, strict=True)],
        )

    def aged(self, left: Values) -> Springs:
        """The same when of every branch this share is left."""
        kept = [c * share for c, share in zip(self.kept, left, strict=True)]
        square = [c * share * share for c, share in zip(self.kept_square, left, strict=True)]
        return Springs(self.width, self.rest, self.rest_square, kept, square)

    def force(self, modulus: Relaxation, depth: float, velocity: float, axis: Values, kept: Values) -> float:
        """What they carry, N, when they have kept this."""
        lift = modulus.equilibrium * depth + modulus.viscosity * velocity + sum(axis)
        return lift * self.width - modulus.equilibrium * self.rest - sum(kept)

    def impulse(self, modulus: Relaxation, depth: float, axis: Values, faded: list[Fading], h: float) -> float:
        """What they pass on over a time h from this state while the depth rests, N s."""
        total = modulus.equilibrium * (depth * self.width - self.rest) * h
        for z, kept, fade in zip(axis, self.kept, faded, strict=True):
            total += (self.width * z - kept) * fade.filled
        return total

    def spent(self, modulus: Relaxation, axis: Values, faded: list[Fading], h: float, rate: float) -> float:
        """What their dashpots spend while the depth grows evenly for a time h, J: int z^2/(E tau) dt, eta rate^2 h."""
        total = modulus.viscosity * rate * rate * self.width * h
        for k, (stiffness, tau, fade) in enumerate(zip(modulus.moduli, modulus.times, faded, strict=True)):
            first, second = self._moments(k, axis)
            total += 0.5 * fade.filled * (1.0 + fade.left) * second / (stiffness * tau)
            total += fade.filled * fade.filled * rate * first / tau
            total += stiffness * rate * rate * fade.spilled * self.width
        return total

    def held(self, modulus: Relaxation, depth: float, axis: Values) -> float:
        """What their springs hold, J: E_inf (depth - g)^2/2 and z_k^2/(2 E_k)."""
        total = modulus.equilibrium * (depth * (depth * self.width - 2.0 * self.rest) + self.rest_square)
        for k, stiffness in enumerate(modulus.moduli):
            total += self._moments(k, axis)[1] / stiffness
        return 0.5 * total

    def _moments(self, k: int, axis: Values) -> tuple[float, float]:
        """Sums of w z_k and of w z_k^2."""
        z, kept = axis[k], self.kept[k]
        return self.width * z - kept, z * (self.width * z - 2.0 * kept) + self.kept_square[k]


def none(modulus: Relaxation) -> Springs:
    """No spring."""
    return Springs.one(0.0, 0.0, [0.0] * len(modulus.moduli))


def yielding(modulus: Relaxation, faded: list[Fading], h: float) -> float:
    """By how much the impulse over a time h rises with the rate at which the depth grows, per width."""
    total = (0.5 * modulus.equilibrium * h + modulus.viscosity) * h
    for stiffness, fade in zip(modulus.moduli, faded, strict=True):
        total += stiffness * fade.grown
    return total


def stretched(modulus: Relaxation, axis: Values, faded: list[Fading], rate: float) -> Values:
    """Z_k after a time in which the depth grew evenly at this rate."""
    branches = zip(modulus.moduli, axis, faded, strict=True)
    return [z * fade.left + stiffness * rate * fade.filled for stiffness, z, fade in branches]
