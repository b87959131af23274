"""A material: its network, how it deforms sideways, and what only the model ledger needs."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, ClassVar

from lumped.errors import BadInput, Fault
from lumped.materials.relaxation import Relaxation
from lumped.schema import Table
from lumped.schema.keys import Choice, Key, Number, Numbers, Record, written
from lumped.schema.members import Member

HARDENING = Number(0.0, 1e16, "Pa")
MODULUS, DENSITY = Number(1e-3, 1e16, "Pa"), Number(1e-3, 1e6, "kg/m3")
POISSON = Number(-1.0, 0.5, above=True)
TEMPERATURE = Number(0.0, 1e4, "K", above=True)
GAS = 8.314462618  # physics: J/(mol K)
SHIFTS = ("wlf", "activation_energy")
MOST_SHIFT = 1e30  # rounding: of times, either way; beyond it a material is glass, or has relaxed


@dataclass(frozen=True)
class Material(Record):
    """An isotropic linear viscoelastic material.

    `young` is the relaxation modulus of the network (Pa, s). `constant = "poisson"`: nu is constant and
    the network is Young's modulus. `"bulk"`: G(t) = young(t)/(2(1+nu)), and the bulk modulus is the constant
    K = E_inf/(3(1-2 nu)); a fluid (E_inf = 0) gives `bulk_modulus`.

    With a `temperature`, K, `young` is the network as it is there: all its times at the `reference_temperature`
    multiplied by the shift a_T of `wlf`, log10 a_T = -C1 (T - T_ref)/(C2 + T - T_ref) (Williams, Landel and Ferry 1955,
    doi 10.1021/ja01619a008), or of Arrhenius' `activation_energy`, J/mol. Raises BadInput.
    """

    young: Relaxation
    nu: Annotated[float, Key(POISSON, "Poisson's ratio")]
    density: Annotated[float | None, Key(DENSITY, "density")] = None
    constant: Annotated[str, Key(Choice(("poisson", "bulk")), "what does not relax")] = "poisson"
    bulk_modulus: Annotated[float | None, Key(MODULUS, "constant bulk modulus of a fluid")] = None
    yield_strength: Annotated[float | None, Key(MODULUS, "stress at which it yields")] = None
    hardening_modulus: Annotated[
        float | None, Key(HARDENING, "slope of the yield stress over the amount of plastic strain")
    ] = None
    work_of_adhesion: Annotated[float | None, Key(Number(1e-9, 1e6, "J/m2"), "work to part two surfaces")] = None
    friction: Annotated[
        float | None, Key(Number(0.0, 10.0), "coefficient against what touches it, for the model ledger alone")
    ] = None
    hyperelastic: Annotated[
        str | None, Key(Member("lumped.materials.energies"), "elastic energy of large strains", required=False)
    ] = None
    temperature: Annotated[float | None, Key(TEMPERATURE, "its own, which shifts all times of the network")] = None
    reference_temperature: Annotated[float | None, Key(TEMPERATURE, "at which the network is given")] = None
    wlf: Annotated[tuple[float, ...] | None, Key(Numbers(Number(0.0, 1e6), 2), "C1, and C2 in K, of the shift")] = None
    activation_energy: Annotated[float | None, Key(Number(0.0, 1e8, "J/mol"), "of Arrhenius' shift")] = None
    name: ClassVar[str] = "material"

    def with_reference(self, network: Relaxation) -> Material:
        """The same with another network, as it is at the reference temperature."""
        return replace(self, young=network.stretched(self.shift))

    @property
    def reference(self) -> Relaxation:
        """The network at the reference temperature."""
        return self.young.stretched(1.0 / self.shift)

    @property
    def shift(self) -> float:
        """a_T, how much slower the network is than at its reference temperature; 1 without a temperature."""
        if self.temperature is None or self.reference_temperature is None:
            return 1.0
        if self.wlf is None:
            inverse = 1.0 / self.temperature - 1.0 / self.reference_temperature
            exponent = (self.activation_energy or 0.0) / GAS * inverse
        else:
            warmer = self.temperature - self.reference_temperature
            exponent = -math.log(10.0) * self.wlf[0] * warmer / (self.wlf[1] + warmer)
        return math.exp(min(max(exponent, -700.0), 700.0))

    def __post_init__(self) -> None:
        super().__post_init__()
        self._check_shift()
        message = self._bulk_fault()
        if message:
            raise BadInput(Fault("material", "bulk_modulus", message))
        if self.constant == "bulk" and math.isinf(self.bulk):
            reason = "0.5: no finite bulk modulus E_inf/(3(1-2 nu)) to hold; accepted: below 0.5, or 'poisson'"
            raise BadInput(Fault("material", "nu", reason))

    @property
    def bulk(self) -> float:
        """The constant bulk modulus K (for `constant = "bulk"`), Pa; infinite where nu = 0.5 keeps the volume."""
        if self.bulk_modulus is not None:
            return self.bulk_modulus
        return math.inf if self.nu == 0.5 else self.young.relaxed / (3.0 * (1.0 - 2.0 * self.nu))

    @property
    def shear(self) -> Relaxation:
        """The relaxation modulus of shear G(t), Pa."""
        return self.young.scaled(1.0 / (2.0 * (1.0 + self.nu)))

    def contact_modulus(self) -> Relaxation:
        """E*(t) of the half-space, E/(1-nu^2) for constant nu, in Pa."""
        if self.constant == "bulk":
            return _bulk_contact_modulus(self.shear, self.bulk)
        return self.young.scaled(1.0 / (1.0 - self.nu**2))

    def uniaxial_modulus(self) -> Relaxation:
        """Stress over strain where the sides are free, 9KG/(3K+G), Pa: the network itself for constant nu."""
        return _bulk_uniaxial_modulus(self.shear, self.bulk) if self.constant == "bulk" else self.young

    def confined_modulus(self) -> Relaxation:
        """Stress over strain where nothing moves sideways, K + 4G/3, Pa. Raises BadInput where it is infinite."""
        if self.constant == "bulk":
            shear = self.shear.scaled(4.0 / 3.0)
            return replace(shear, equilibrium=shear.equilibrium + self.bulk)
        if self.nu == 0.5:
            reason = "0.5: held sideways, an incompressible body does not yield at all; accepted: below 0.5"
            raise BadInput(Fault("material", "nu", reason))
        return self.young.scaled((1.0 - self.nu) / ((1.0 + self.nu) * (1.0 - 2.0 * self.nu)))

    def elastic(self, instant: bool) -> Material:
        """The elastic material that a slow or, `instant`, a sudden load meets; it has to be finite and no fluid."""
        young = self.young.glassy if instant else self.young.relaxed
        if self.constant == "poisson":
            return Material(Relaxation(young), self.nu, hyperelastic=self.hyperelastic)
        shear = young / (2.0 * (1.0 + self.nu))
        stiffness = 9.0 * self.bulk * shear / (3.0 * self.bulk + shear)
        return Material(Relaxation(stiffness), 0.5 * stiffness / shear - 1.0, hyperelastic=self.hyperelastic)

    def to_dict(self) -> Table:
        """The table of a scene file that gives this material back."""
        young = self.reference
        table: Table = {"law": "prony", "E_inf": young.equilibrium}
        if young.moduli:
            table |= {"E": list(young.moduli), "tau": list(young.times)}
        if young.viscosity:
            table["eta"] = young.viscosity
        table |= _fit_keys(young)
        return table | written(self)

    def _check_shift(self) -> None:
        """Raise BadInput for a temperature without all that a shift needs, and for a shift beyond all use."""
        given = [key for key in ("temperature", "reference_temperature", *SHIFTS) if getattr(self, key) is not None]
        if not given:
            return
        if len(given) != 3 or given[:2] != ["temperature", "reference_temperature"]:
            accepted = f"accepted: temperature and reference_temperature with one of {', '.join(SHIFTS)}"
            raise BadInput(Fault("material", "temperature", f"{', '.join(given)} given; {accepted}"))
        if self.wlf is not None and len(self.wlf) != 2:
            raise BadInput(Fault("material", "wlf", f"{len(self.wlf)} values; accepted: 2, C1 and C2 in K"))
        lowest = (self.reference_temperature or 0.0) - self.wlf[1] if self.wlf is not None else 0.0
        if (self.temperature or 0.0) <= lowest or not 1.0 / MOST_SHIFT <= self.shift <= MOST_SHIFT:
            reason = f"{self.temperature:g} K: shifts all times by more than {MOST_SHIFT:.0e}; accepted: nearer to"
            raise BadInput(Fault("material", "temperature", f"{reason} {self.reference_temperature:g} K"))

    def _bulk_fault(self) -> str:
        """Why this bulk modulus cannot stand with this network; empty when it can."""
        if self.bulk_modulus is None:
            missing = self.constant == "bulk" and self.young.relaxed == 0.0
            return "missing: a fluid with constant = 'bulk' needs it" if missing else ""
        if self.constant != "bulk":
            return "only with constant = 'bulk'; for constant = 'poisson' it follows from the network and nu"
        return "only for a fluid: a solid has K = E_inf/(3(1-2 nu))" if self.young.relaxed > 0.0 else ""


def _fit_keys(young: Relaxation) -> Table:
    """What a fitted series says of its fit, in the keys of a Prony series."""
    fidelity = young.fidelity
    if fidelity is None:
        return {}
    bounds = {"fit_error_before": fidelity.before, "fit_error_after": fidelity.after}
    known = {name: bound for name, bound in bounds.items() if math.isfinite(bound)}
    return {"fit_window": list(fidelity.window), "fit_error": fidelity.inside} | known


def _bulk_contact_modulus(shear: Relaxation, bulk: float) -> Relaxation:
    """E*(s) = 4G(3K+G)/(3K+4G) = G + 9K/4 - (27 K^2/4)/(3K+4G), exactly, as a Prony series.

    1/(3K+4G) is the creep compliance of the series 3K + 4G(t): the weights (27 K^2/4) J_k are positive.
    """
    confined = shear.scaled(4.0)
    creep = Relaxation(confined.equilibrium + 3.0 * bulk, confined.moduli, confined.times, confined.viscosity).creep()
    g = shear.relaxed
    equilibrium = 4.0 * g * (3.0 * bulk + g) / (3.0 * bulk + 4.0 * g)
    moduli = shear.moduli + tuple(6.75 * bulk**2 * compliance for compliance in creep.compliances)
    return Relaxation(equilibrium, moduli, shear.times + creep.times, shear.viscosity)


def _bulk_uniaxial_modulus(shear: Relaxation, bulk: float) -> Relaxation:
    """9KG/(3K+G) = 9K - 27 K^2/(3K+G), exactly, as a Prony series; see :func:`_bulk_contact_modulus`."""
    creep = replace(shear, equilibrium=shear.equilibrium + 3.0 * bulk).creep()
    equilibrium = 9.0 * bulk * shear.relaxed / (3.0 * bulk + shear.relaxed)
    return Relaxation(equilibrium, tuple(27.0 * bulk**2 * compliance for compliance in creep.compliances), creep.times)
