"""Where a force law's numbers come from: the `[law]` table, else the scene's geometry and material."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TypeVar

from lumped.errors import BadInput, Fault
from lumped.laws._damping import EXACT, EXIT, Family, damping
from lumped.laws._force_law import bodies_of
from lumped.laws._power_law import spring_of_peak
from lumped.laws.base import check_half_space
from lumped.load_curves.base import LoadCurve
from lumped.scene.scene import Scene
from lumped.schema import Table
from lumped.schema.keys import Choice, Key, Number

Keys = Mapping[str, Key]
T = TypeVar("T")


def stiffness_key(unit: str) -> Keys:
    """The optional key of a spring, in the unit that its exponent gives it."""
    return {"k": Key(Number(1e-30, 1e30, unit), "stiffness", required=False)}


STIFFNESS, LINEAR_STIFFNESS = stiffness_key("N/m^alpha"), stiffness_key("N/m")
EXPONENT: Keys = {"alpha": Key(Number(0.5, 5.0), "exponent of the depth", required=False)}
# A damper with the power (alpha - 1)/2 of the depth is infinite at touch for alpha below 1.
EXPONENT_FROM_ONE: Keys = {"alpha": replace(EXPONENT["alpha"], kind=Number(1.0, 5.0))}
NO_KEYS: Keys = {}  # of a law whose exponent is no choice
EXIT_KEY = Key(EXIT, "what ends the contact by its return to zero", required=False)
COMMON: Keys = {"gap": Key(Number(0.0, 1e6, "m"), "distance before touch", required=False), "exit": EXIT_KEY}
RESTITUTION: Keys = {"e": Key(Number(1e-4, 1.0), "restitution which the damping is to meet", required=False)}
# The exact laws that tell the restitution of a scene's own material, the second where contact has a fixed area.
OF_MATERIAL, OF_FIXED_AREA, OF_TOLERANCE = "mdr", "ting", 1e-4
# The exponent for which the dampings of an oscillator are told.
TOLD_FOR = 1.5


def damping_key(name: str, unit: str = "") -> Keys:
    """The optional key of a damper, >= 0."""
    return {name: Key(Number(0.0, 1e30, unit), "damping", required=False)}


def formula_key(family: Family) -> Keys:
    """The key `damping`: by which formula e becomes the damping, exact by default or a published one."""
    kind = Choice((EXACT, *family.published))
    return {"damping": Key(kind, "formula by which e becomes the damping", required=False)}


def damped(family: Family, *dampings: Keys, stiffness: Keys = STIFFNESS, exponent: Keys = EXPONENT) -> tuple[Keys, ...]:
    """The keys of a spring with a damper, given by one of its own `dampings` or by e and a formula of the family."""
    formula = [formula_key(family)] if family.published else []
    return (stiffness, exponent, RESTITUTION, *dampings, *formula, COMMON)


@dataclass
class Parameters:
    """Reads the numbers of the law `name` for a scene, and notes what is missing; `checked` raises all of it."""

    scene: Scene
    name: str
    faults: list[Fault] = field(default_factory=list)
    taken: list[str] = field(default_factory=list)

    @property
    def values(self) -> Table:
        """What the `[law]` table says, if it is about this law."""
        law = self.scene.law
        return law.values if law is not None and law.name == self.name else {}

    @property
    def load_curve(self) -> LoadCurve | None:
        """The load curve of the scene's parabola; None in plane strain, where a half-space has none."""
        if not self.scene.has_geometry or self.scene.geometry.shape.plane:
            return None
        return self.scene.geometry.shape.resolved("parabola").load_curve

    def get(self, key: str, default: T) -> T:
        """A number with a default."""
        found: T = self.values.get(key, default)
        return found

    def exponent(self) -> float:
        """alpha of `[law]`; else the scene's own, Table 1, or 3/2 without geometry."""
        own = self.scene.geometry.shape.exponent_of_force if self.scene.has_geometry else 1.5
        return float(self.values.get("alpha", own))

    def common(self) -> Table:
        """What every force law has, last: the words of `taken` are complete then. Raises BadInput."""
        self.checked()
        own = {key: self.values[key] for key in COMMON if key in self.values}
        return {**own, "load_curve": self.load_curve, "source": "; ".join(self.taken)}

    def checked(self) -> None:
        """Raise BadInput with every fault noted."""
        if self.faults:
            raise BadInput(self.faults)

    def stiffness(self, alpha: float) -> float:
        """k of `[law]`; else that of the spring whose elastic impact peaks as the scene's Hertz impact does."""
        if "k" in self.values:
            return float(self.values["k"])
        if not self.scene.has_geometry:
            self.missing("k", "the stiffness in N/m^alpha; or a scene with shape and material")
            return 1.0
        self._check_half_space()
        relaxed = self.scene.contact_modulus.relaxed
        if relaxed == 0.0:
            reason = "a fluid has no relaxed modulus to take a stiffness from; accepted: a solid, or law.k"
            self.faults.append(Fault(self.scene.source, "target.material", reason))
            return 1.0
        bodies = bodies_of(self.scene)
        peak = self.scene.geometry.shape.hertz_impact(relaxed, bodies.mass, bodies.velocity).force
        k = spring_of_peak(peak, alpha, bodies)
        unit = "N/m" if alpha == 1.0 else f"N/m^{alpha:g}"
        self.taken.append(f"k = {k:.6g} {unit} from the Hertz impact with the relaxed modulus")
        return k

    def _check_half_space(self) -> None:
        """Raise BadInput where stiffness or damping would have to come from another geometry."""
        from lumped import laws

        own = f"--set law.name={self.name} --set law.k=..."
        own += " --set law.e=..." if "e" in laws.get(self.name).keys else ""
        check_half_space(self.scene, self.name, f", or with its own numbers: {own}")

    def damping(self, names: Sequence[str]) -> tuple[str, float]:
        """The one damping given, `names` or e; else e as the scene's own material has it by the exact law."""
        given = [name for name in ("e", *names) if name in self.values]
        accepted = " or ".join(("e", *names))
        if "damping" in self.values and set(given) & set(names):
            reason = f"names the formula for e, but {given[-1]} is given; accepted: e with it, or {given[-1]} alone"
            self.faults.append(Fault(self.scene.source, "law.damping", reason))
        if len(given) == 1:
            return given[0], float(self.values[given[0]])
        if given:
            reason = f"{', '.join(given)} are given; accepted: one of {accepted}"
            self.faults.append(Fault(self.scene.source, f"law.{given[1]}", reason))
            return given[0], 1.0
        if not self.scene.has_geometry:
            self.missing(names[0] if names else "e", f"the damping: one of {accepted}")
            return "e", 1.0
        return "e", self._own_restitution()

    def meeting(self, family: Family, e: float) -> float:
        """The dimensionless damping of a family for e at the law's exit, by the formula that `law.damping` names."""
        exit, formula = self.get("exit", "force"), self.get("damping", EXACT)
        try:
            return damping(family, e, exit, formula)
        except BadInput as bad:
            self.faults += [Fault(self.scene.source, "law.e", fault.message) for fault in bad.faults]
            return 0.0

    def linear(self, family: Family) -> Table:
        """k, N/m, and c, N s/m, of a dashpot beside it: given, or of xi "(7)", or of e at the law's exit."""
        k, (kind, value) = self.stiffness(1.0), self.damping(("xi", "c"))
        if kind == "e":
            value = self.meeting(family, value)
        return {"k": k, "c": value if kind == "c" else 2.0 * value * math.sqrt(k * self.scene.reduced_mass)}

    def oscillator(self, family: Family, key: str, unit: float = 1.0) -> Table:
        """alpha, k and c = unit times the damping called `key` times sqrt(m k), N s/m^((alpha + 1)/2).

        Of e it is the damping with the ratio, and so the restitution, that the family's has at alpha = 3/2.
        """
        alpha = self.exponent()
        k, (kind, value) = self.stiffness(alpha), self.damping((key,))
        if kind == "e":
            value = self.meeting(family, value) * math.sqrt((alpha + 1.0) / (TOLD_FOR + 1.0))
        return {"k": k, "c": unit * value * math.sqrt(self.scene.reduced_mass * k), "alpha": alpha}

    def spring_damper(self, family: Family, key: str, unit: Callable[[float, float], float]) -> Table:
        """alpha, k and the damping called `key`; of e the family's d, made by `unit` of d and k what the key is."""
        alpha = self.exponent()
        k, (kind, value) = self.stiffness(alpha), self.damping((key,))
        if kind == "e":
            value = unit(self.meeting(family, value), k)
        return {"k": k, key: value, "alpha": alpha}

    def missing(self, key: str, accepted: str) -> None:
        """Note a key that has to be given."""
        self.faults.append(Fault(self.scene.source, f"law.{key}", f"missing; accepted: {accepted}"))

    def _own_restitution(self) -> float:
        """The restitution of the scene's first impact by the exact law. Raises NotReached."""
        if self.scene.contact_modulus.is_elastic:
            return 1.0
        exact = OF_MATERIAL if self.scene.profile.fixed_radius is None else OF_FIXED_AREA
        if exact == OF_MATERIAL:
            self._check_half_space()
        e = restitution_by(exact, replace(self.scene, law=None, motion=replace(self.scene.motion, impacts=1)))
        if e is None:
            reason = f"missing, and the scene, which does not separate, has none; accepted: law.e for {self.name}"
            self.faults.append(Fault(self.scene.source, "law.e", reason))
            return 1.0
        self.taken.append(f"e = {e:.6g} of the scene by {exact}")
        return float(min(max(e, 1e-4), 1.0))


@lru_cache(maxsize=16)  # all laws that are compared on a scene ask for it
def restitution_by(name: str, scene: Scene) -> float | None:
    """Of a scene by a law, None where it does not separate. Raises NotReached."""
    from lumped import laws

    return laws.get(name).of(scene).simulate(scene, OF_TOLERANCE).quantities["restitution"].value
