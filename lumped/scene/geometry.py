"""What strikes what: the bodies, which of them has a material, the modulus of both together, scales of an impact."""

from __future__ import annotations

from dataclasses import dataclass, replace

from lumped.errors import BadInput, Fault
from lumped.load_curves import HertzImpact
from lumped.materials import Material, Relaxation
from lumped.materials.energies.base import DEFAULT, ENERGIES, energy_of
from lumped.scene.tables import Model
from lumped.schema import Table
from lumped.shapes import Shape
from lumped.shapes._block import Block
from lumped.targets import Target

YIELDING_UNDER = ("sphere", "cone", "power", "punch")  # strikers under which a half-space may yield
STEADY = '"bulk" changes nu in time, which no far field follows in this version; accepted: "poisson"'
SPARE_MASS = 0.01  # of a whole body with inertia, which its density gives way to


@dataclass(frozen=True)
class Geometry:
    """What finite elements and the laws of the half-space need: striker's shape, target, its material.

    `striker_material`: of a striker which yields as the target does, None: rigid.
    """

    shape: Shape
    target: Target
    material: Material
    striker_material: Material | None = None

    @property
    def striking(self) -> Material | None:
        """The striker's material, None where it is rigid."""
        return self.striker_material if self.target.deformable else self.material

    def of_pair(self, key: str) -> float | None:
        """What a key says of both surfaces together, whichever of their materials gives it."""
        given = [getattr(one, key) for one in (self.material, self.striker_material) if one is not None]
        return next((value for value in given if value is not None), None)

    @property
    def yielding(self) -> list[tuple[str, Material]]:
        """The bodies that have a material, by the table that gives it."""
        found = [("striker", self.striking), ("target", self.material if self.target.deformable else None)]
        return [(part, material) for part, material in found if material is not None]

    @property
    def changing(self) -> list[str]:
        """The tables whose materials have a Poisson's ratio that changes in time."""
        return [part for part, one in self.yielding if one.constant == "bulk" and not one.young.is_elastic]

    @property
    def sharp_rim(self) -> bool:
        """Whether the striker ends in a rim that cuts into the body."""
        return self.target.endless and self.target.fixed_radius(self.shape) is not None

    @property
    def surface_remembers(self) -> bool:
        """Whether elastic bodies and E*(t) tell all: of a body with lengths, where nu stays or strain is uniform."""
        uniform = isinstance(self.shape, Block) and self.shape.uniform
        return not self.changing or uniform or not self.target.has_length

    @property
    def springs(self) -> Geometry:
        """The same of elastic bodies: where nu stays, their load curve over their modulus is that of these.

        As they are in the end, or at once where a fluid is among them; dashpots alone count by their viscosities.
        """
        bodies = [self.material] if self.striker_material is None else [self.material, self.striker_material]
        known = zip(*((one.young.relaxed, one.young.glassy, one.young.viscosity) for one in bodies), strict=True)
        moduli = next((found for found in known if all(found)), [1.0] * len(bodies))
        alike = [Material(Relaxation(modulus), one.nu) for modulus, one in zip(moduli, bodies, strict=True)]
        return replace(self, material=alike[0], striker_material=None if len(alike) == 1 else alike[1])

    @property
    def contact_modulus(self) -> Relaxation:
        """The modulus E*(t) which the force is in proportion to, Pa: of one body, or of both.

        Compliances add, 1/E*(s) = 1/E1*(s) + 1/E2*(s), and the sum is inverted as a whole.
        """
        own = self.shape.modulus(self.material)
        if self.striker_material is None:
            return own
        return (own.creep() + self.shape.modulus(self.striker_material).creep()).relaxation()

    def check_striker(self, source: str, inertia: bool) -> None:
        """Raise BadInput for a striker which the target is not for, or whose material is one too many."""
        self.target.check_striker(source, self.shape)
        refused = [] if self.striker_material is None else self.target.yielding_faults(source, self.shape, inertia)
        if refused:
            raise BadInput(refused)

    def places(self, deep: str) -> dict[str, str]:
        """Where in a scene file stands what a part refuses; `deep`: what a depth comes from."""
        material = f"{self.target.owner}.material"
        own = {"material": material, "relaxation": material, "numerics": "numerics"}
        return {**own, "depth": deep, self.target.name: "target", self.shape.name: "striker"}

    def tables(self) -> tuple[Table, Table]:
        """The striker's and the target's table of a scene file that gives them back."""
        own, held = self.shape.to_dict(), self.target.to_dict()
        if self.striking is not None:
            own["material"] = self.striking.to_dict()
        if self.target.deformable:
            held["material"] = self.material.to_dict()
        return own, held


def dashpot_as_spring(shape: Shape, viscosity: float, mass: float, velocity: float) -> float:
    """The contact modulus eta/T, Pa, of the spring whose own Hertz contact lasts T; viscosity eta in Pa s.

    T grows as modulus^(-2/5), so T = T_1^(5/3) with T_1 that of the modulus which is eta in number.
    """
    unit = shape.hertz_impact(viscosity, mass, velocity).duration
    return float(viscosity / unit ** (5.0 / 3.0))


def stiffest_impact(shape: Shape, modulus: Relaxation, mass: float, velocity: float) -> HertzImpact:
    """The Hertz impact on the stiffest answer of the material, glassy springs or dashpot: the shallowest."""
    springs = [modulus.glassy] if modulus.glassy else []
    if modulus.viscosity:
        springs.append(dashpot_as_spring(shape, modulus.viscosity, mass, velocity))
    return shape.hertz_impact(max(springs), mass, velocity)


def relaxed_impact(shape: Shape, modulus: Relaxation, mass: float, velocity: float) -> HertzImpact:
    """The Hertz impact with the relaxed modulus; of a fluid with the glassy one, or that of its dashpot."""
    if not modulus.spring:
        return stiffest_impact(shape, modulus, mass, velocity)
    return shape.hertz_impact(modulus.spring, mass, velocity)


def absurd_depth(shape: Shape, modulus: Relaxation, mass: float, velocity: float) -> str:
    """What to say where even the stiffest answer lets a round striker sink in deeper than it is round; else empty."""
    impact = stiffest_impact(shape, modulus, mass, velocity)
    if shape.tip_radius is None or impact.contact_radius > impact.depth:
        return ""
    return (
        f"the striker sinks in by {impact.depth:.3g} m, deeper than its radius: no small-displacement theory "
        "holds; accepted: a lower velocity or mass, or a stiffer material: are its moduli in Pa?"
    )


def flying_faults(source: str, geometry: Geometry, mass: float, target_mass: float | None) -> list[Fault]:
    """What is wrong with the masses, kg, of bodies with inertia that fly whole: their densities say the same."""
    target = geometry.target
    faults = target.inertia_faults(source, geometry.striking)
    if geometry.striking is not None and target.deformable and geometry.striking.density is None:
        reason = "missing; model.inertia = true needs it, in kg/m3"
        faults.append(Fault(source, "striker.material.density", reason))
    return faults + whole_mass_faults(source, geometry, mass, target_mass)


def whole_mass_faults(source: str, geometry: Geometry, mass: float, target_mass: float | None) -> list[Fault]:
    """Masses, kg, of whole bodies that are not those of their densities."""
    faults = list[Fault]()
    for part, body, material, given in (
        ("striker", geometry.shape, geometry.striking, mass),
        ("target", geometry.target, geometry.material, target_mass),
    ):
        whole = body.whole_mass(material.density) if material is not None and material.density is not None else None
        if whole is not None and (given is None or abs(given - whole) > SPARE_MASS * whole):
            said = "missing" if given is None else f"{given:g} kg"
            reason = f"{said}; with model.inertia a {body.name} has the mass of its density; accepted: {whole:.6g} kg"
            faults.append(Fault(source, f"{part}.mass", f"{reason} within {SPARE_MASS:.0%}, or another density"))
    return faults


def changing_faults(source: str, geometry: Geometry) -> list[Fault]:
    """A Poisson's ratio that changes in time, for bodies whose waves are followed only where it stays the same."""
    if not geometry.target.steady_waves(geometry.shape):
        return []
    return [Fault(source, f"{part}.material.constant", STEADY) for part in geometry.changing]


def plasticity_faults(source: str, model: Model, geometry: Geometry | None, impacts: int = 1) -> list[Fault]:
    """What stands beside `model.plasticity = true` and cannot, or is missing; `geometry` None: a law's parameters."""
    if not model.plasticity:
        return []
    if geometry is None:
        return [Fault(source, "model.plasticity", "true: a law of its own has no material; accepted: false")]
    shape, target, material = geometry.shape, geometry.target, geometry.material
    elastic, state, shapes = material.young.is_elastic, "with model.plasticity", ", ".join(YIELDING_UNDER)
    own = f"{target.owner}.material"
    wrong = [
        (material.yield_strength is None, f"{own}.yield_strength", f"missing, in Pa; {state} it is needed"),
        (not elastic, f"{own}.law", f"no viscosity {state} in this version; accepted: elastic"),
        (model.finite, "model.kinematics", f"finite: no large strains {state} in this version; accepted: small"),
        (impacts > 1, "motion.impacts", f"{impacts}: one impact {state} in this version; accepted: 1"),
        (geometry.striker_material is not None, "striker.material", f"the striker is rigid {state}; leave it out"),
        (target.name != "half_space", "target.shape", f"{target.name}: {state} accepted half_space"),
        (shape.name not in YIELDING_UNDER, "striker.shape", f"{shape.name}: {state} accepted {shapes}"),
    ]
    return [Fault(source, key, reason) for refused, key, reason in wrong if refused]


def finite_faults(source: str, model: Model, geometry: Geometry, impacts: int | None = None) -> list[Fault]:
    """What stands beside `model.kinematics = "finite"` and cannot, pressed slowly or in so many `impacts`."""
    if not model.finite:
        return []
    shape, target, material = geometry.shape, geometry.target, geometry.material
    instead = target.strained_instead(shape)
    relaxing, state = impacts is not None and not material.young.is_elastic, "with large strains in this version"
    wrong = [
        (
            bool(instead),
            "striker.shape" if target.large_strains else "target.shape",
            f"a {shape.name} on a {target.name} is not built {state}; accepted: {instead}",
        ),
        (geometry.striker_material is not None, "striker.material", f"the striker is rigid {state}; leave it out"),
        (model.inertia, "model.inertia", f"true: no waves {state}; accepted: false"),
        (model.plasticity, "model.plasticity", f"true: nothing yields {state}; accepted: false"),
        (
            relaxing and material.young.viscosity > 0.0,
            f"{target.owner}.material.law",
            f"no dashpot in parallel {state}; accepted: elastic, maxwell, sls, prony",
        ),
        (
            relaxing and material.constant == "bulk" and target.endless,
            f"{target.owner}.material.constant",
            f'"bulk": in a {target.name} the whole stress relaxes {state}; accepted: "poisson"',
        ),
        (
            relaxing and material.constant == "bulk" and not energy_of(material.hyperelastic).splits,
            f"{target.owner}.material.hyperelastic",
            f"{material.hyperelastic or DEFAULT}: its volume does not stand apart and relaxes with all else; "
            f'accepted: {", ".join(_split())}, or constant = "poisson"',
        ),
        (impacts is not None and impacts > 1, "motion.impacts", f"{impacts}: one is followed {state}; accepted: 1"),
    ]
    return [Fault(source, key, f"{reason}; or model.kinematics = small") for refused, key, reason in wrong if refused]


def _split() -> list[str]:
    """Energies of the volume and of what changes none."""
    return [name for name, energy in ENERGIES.members.items() if energy.splits]
