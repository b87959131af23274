"""What a model of impact or slow indentation leaves out, each effect estimated relative to peak force."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import overload

from lumped.errors import FeContactError
from lumped.load_curves.base import LoadCurve
from lumped.materials import Material, Relaxation
from lumped.materials.energies.base import DEFAULT, energy_of
from lumped.materials.friction import mismatch, slipping, stuck
from lumped.materials.radiation import Pulse, met_at_once
from lumped.result.history import History
from lumped.result.result import LedgerEntry, Quantity, percent
from lumped.scene.geometry import Geometry, changing_faults, finite_faults, flying_faults, plasticity_faults
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.shapes._block import Block
from lumped.shapes.base import Shape
from lumped.targets.base import LeftOut
from lumped.targets.half_space import HalfSpace
from lumped.targets.plane import Plane
from lumped.targets.rod import Rod
from lumped.targets.sphere import SphereTarget

GRAVITY = 9.81  # physics: m/s2
LARGE = "model.kinematics"
FINITE_LENGTH = "finite length"  # by its name it is measured: no key selects it
ENERGY_NAMES = {
    "st_venant_kirchhoff": "St Venant-Kirchhoff",
    "neo_hooke": "neo-Hooke",
    "hencky": "Hencky",
    "neo_hooke_split": "neo-Hooke, split",
    "mooney_rivlin": "Mooney-Rivlin",
    "yeoh": "Yeoh",
    "ogden": "Ogden",
}
# By how much less a rod's end comes in than a half-space, its uniform shortening apart, over F/(E* b), b the rod's
# radius: 0.61 at nu = -0.5 to 0.66 at 0.5; tests/fe/test_rod_end.py finds it again.
ROD_END = 0.65
IN_AN_IMPACT = 0.5  # of the change at one depth, since what was brought is given
ROWS, NEWTON = 200, 8  # steps in an impact that tells of a modulus, and of Newton's method in each
LIKE_HALF_SPACES = (HalfSpace, SphereTarget, Plane)  # near the contact
AT_TOUCH = 1e-6  # rounding: share of a contact before which a peak is the touch itself
TIP = 1e-4  # rounding: of a tip's radius, where the gap beside it is a parabola to 1e-8
ALMOST_FLAT = 1.0 + 1e-6  # rounding: exponent of the force below which a profile counts as flat
FLOW = 0.047  # 1/(1 + FLOW ln^2 w): how force falls behind Hertz'; tests/fe/test_plastic.py finds it again
# What a rim adds to that: it yields at any load, in a zone that grows as its square (Irwin), up to where all does.
RIM = 0.03


@dataclass(frozen=True)
class Peak:
    """Scales of an impact: N, m, m, s. `duration` may be twice the time of the peak."""

    force: float
    depth: float
    contact_radius: float
    duration: float

    @classmethod
    def of(cls, quantities: Mapping[str, Quantity], history: History) -> Peak:
        """Of an impact."""
        number = {name: quantity.value or 0.0 for name, quantity in quantities.items()}
        duration = pulse_lasts(number["duration"], number["peak_time"], float(history.time[-1]))
        return cls(number["peak_force"], number["peak_depth"], float(history.contact_radius.max()), duration)


def pulse_lasts(duration: float | None, peak_time: float, followed: float) -> float:
    """How long, s: the contact, or where that does not end twice as long as to its peak; all the time for which it is
    ``followed``, s, where it peaks at the touch.
    """
    return duration or (2.0 * peak_time if peak_time > AT_TOUCH * followed else followed)


def model_ledger(scene: Scene, peak: Peak, model: Model | None = None) -> tuple[LedgerEntry, ...]:
    """The ledger of a scene under `model` (default: the scene's own), with the scales of its impact."""
    resolved = model or scene.model
    if not scene.has_geometry:
        return (gravity(scene, resolved, peak, scene.mass),)
    dented = isinstance(scene.target, Rod) and scene.profile.fixed_radius is None
    if dented:
        peak = of_dent(scene, peak)
    entries = [
        inertia(scene, resolved, peak),
        profile(scene.geometry.shape, resolved, peak),
        strained_much(scene, resolved, peak),
        *(sideways(scene, peak, part) for part, _ in reversed(scene.geometry.yielding)),
        series(scene, peak),
        striker(scene),
        gravity(scene, resolved, peak, scene.mass),
        plasticity(scene, resolved, peak, struck=True),
        adhesion(scene, peak),
        *friction(scene, resolved, peak, impact=True),
    ]
    if scene.geometry.shape.plane:
        entries.append(ends(scene.geometry, peak))
    if dented:
        entries.append(rod_end(scene, peak))
    return tuple(entries)


@dataclass(frozen=True)
class Ledger(Sequence[LedgerEntry]):
    """That of :func:`model_ledger`, reckoned when it is first read: of many impacts the numbers alone are asked."""

    scene: Scene
    peak: Peak
    model: Model

    @cached_property
    def entries(self) -> tuple[LedgerEntry, ...]:
        """All of them."""
        return model_ledger(self.scene, self.peak, self.model)

    @overload
    def __getitem__(self, place: int) -> LedgerEntry: ...

    @overload
    def __getitem__(self, place: slice) -> tuple[LedgerEntry, ...]: ...

    def __getitem__(self, place: int | slice) -> LedgerEntry | tuple[LedgerEntry, ...]:
        """One entry, or some."""
        return self.entries[place]

    def __len__(self) -> int:
        """How many effects it names."""
        return len(self.entries)


def ledger_at_rest(indenter: Indenter, peak: Peak) -> tuple[LedgerEntry, ...]:
    """The same of a slow indentation at its deepest, which has neither inertia nor time."""
    shape, target = indenter.shape, indenter.target
    entries = [strained_much(indenter, indenter.model, peak)]
    if any(material.yield_strength is not None for _, material in indenter.geometry.yielding):
        entries.append(plasticity(indenter, indenter.model, peak))
    if target.fixed_radius(shape) is None:
        entries.append(profile(shape, indenter.model, peak))
    entries += friction(indenter, indenter.model, peak)
    return (*entries, ends(indenter.geometry, peak)) if shape.plane else tuple(entries)


def inertia(scene: Scene, model: Model, peak: Peak) -> LedgerEntry:
    """As the target knows it."""
    effect = "target inertia"
    if model.inertia:
        return LedgerEntry(effect, "included", 0.0)
    mass, geometry = scene.reduced_mass, scene.geometry
    pulse = Pulse(peak.force, peak.duration, mass, 0.5 * mass * scene.velocity**2, peak.contact_radius)
    found = _left_out_or_met(geometry, pulse)
    faults = changing_faults("", geometry)
    if scene.target.waves_under(geometry.shape):
        faults += flying_faults("", geometry, scene.mass, scene.target_mass)
    refused = [str(fault) for fault in faults]
    if isinstance(geometry.shape, Block) and geometry.material.young.viscosity > 0.0:
        refused.append("a dashpot in parallel has no wave speed")
    if scene.motion.impacts > 1 and scene.target.rings_on(geometry.shape):
        refused.append("what rings on between contacts is followed in one impact")
    built = scene.target.waves_under(geometry.shape) and not (model.finite or refused)
    said = found.note if found.note == scene.target.needs_density else "; ".join([found.note, *refused])
    key = "model.inertia" if built else ""
    if found.size is not None and found.either:
        return LedgerEntry(effect, "neglected", None, said, key, (-found.size, found.size), built or None)
    return LedgerEntry(effect, "neglected", found.size, said, key, value=built or None)


def _left_out_or_met(geometry: Geometry, pulse: Pulse) -> LeftOut:
    """As the target knows it; more where a flat end meets density c v of it at once, which is there before anything is
    pressed.

    Beside a half-space, into which that spreads, it stands alone; in a column, from whose base it comes back, it adds
    to what presses: by sqrt(M/m) of a mass M under a striker m, which meets twice as much at least with its echo
    (Saint-Venant; Timoshenko and Goodier, ISBN 978-0-07-085805-3, art. 169).
    """
    shape, target, striking = geometry.shape, geometry.target, geometry.striker_material
    if striking is not None:
        return target.left_out_of_both(shape, geometry.material, striking, pulse)
    left_out = target.inertia_left_out(shape, geometry.material, pulse)
    area, comes_back = target.met_flat(shape)
    met = met_at_once(geometry.material, pulse, area) if area else None
    if left_out.size is None or met is None:
        return left_out
    more = max(met, 2.0 * met - 1.0) if comes_back else met - 1.0
    if more <= left_out.size:
        return left_out
    return LeftOut(more, f"a flat end meets {percent(met)} of the peak force at the touch")


def gravity(scene: Scene, model: Model, peak: Peak, mass: float) -> LedgerEntry:
    """What the weight of a mass, kg, adds to the peak force, where the motion leads down."""
    effect = "gravity"
    if scene.target_mass is not None:
        return LedgerEntry(effect, "none between two free bodies", 0.0)
    if model.gravity != 0.0:
        return LedgerEntry(effect, "included", 0.0)
    if model.direction == "horizontal":
        return LedgerEntry(effect, "across the motion", 0.0)
    more = _pressed_on(GRAVITY * mass / peak.force, _exponent(scene, peak)) if peak.force > 0.0 else math.inf
    if model.direction == "down":
        note = "of a mass that meets a power of the depth"
        return LedgerEntry(effect, "neglected", more, note, "model.gravity", value=GRAVITY)
    down = f"a drop (--set model.direction=down) leaves out {percent(more)}"
    asked = f"{down}, a horizontal motion (--set model.direction=horizontal) nothing"
    return LedgerEntry(effect, "none assumed", None, asked)


def _exponent(scene: Scene | Indenter, peak: Peak) -> float:
    """Of the force over the depth, at the peak; 1 where no load curve tells it: the least."""
    if peak.depth <= 0.0 or (isinstance(scene, Scene) and not scene.has_geometry):
        return 1.0
    try:
        curve = scene.target.load_curve(scene.profile, scene.geometry.material.nu)
        return max(_power(curve, peak.depth)[1], 1.0)
    except FeContactError:  # no load curve, or one that ends before this depth
        return 1.0


def _power(curve: LoadCurve, depth: float) -> tuple[float, float]:
    """Force of a load curve at a depth, over its modulus, and the exponent there. Raises BadInput beyond its range."""
    force, slope = map(float, curve.force_and_slope(depth))
    return force, depth * slope / force


def _pressed_on(weight: float, n: float) -> float:
    """By how much more than 1 a force x^n grows, where a ``weight`` over the peak force without it does work, too.

    Of the energies: x^(n + 1) = 1 + (n + 1) w x. By Newton's method from above, on a function that is convex.
    """
    if not math.isfinite(weight):
        return math.inf
    x = 1.0 + ((n + 1.0) * weight) ** (1.0 / n)
    for _ in range(NEWTON):
        x -= (x ** (n + 1.0) - 1.0 - (n + 1.0) * weight * x) / ((n + 1.0) * (x**n - weight))
    return float(x**n - 1.0)


def profile(shape: Shape, model: Model, peak: Peak) -> LedgerEntry:
    """The load curves of sphere and parabola at the peak depth; in plane strain their heights at its edge."""
    effect = "parabola against true profile"
    true, parabolic = shape.resolved("exact"), shape.resolved("parabola")
    if model.profile == "exact" or true == parabolic:
        return LedgerEntry(effect, "true profile", 0.0)
    if shape.plane:
        heights = [float(one.height(peak.contact_radius)) for one in (true, parabolic)]
        estimate = abs(heights[1] / heights[0] - 1.0) if heights[0] > 0.0 else 0.0
        return LedgerEntry(effect, "parabola", estimate, key="model.profile", value="exact")
    exact, parabola = (float(one.load_curve.force(peak.depth)) for one in (true, parabolic))
    return LedgerEntry(effect, "parabola", abs(parabola / exact - 1.0), key="model.profile", value="exact")


def strained_much(scene: Scene | Indenter, model: Model, peak: Peak) -> LedgerEntry:
    """Included, by the energy of the material, or what :func:`finite_strain` estimates of it; no key if not built."""
    geometry, impacts = scene.geometry, scene.motion.impacts if isinstance(scene, Scene) else None
    material = geometry.material
    if model.finite:
        return LedgerEntry("finite strain", f"included: W = {energy_of(material.hyperelastic).formula}", 0.0)
    if too_deep := geometry.target.check_depth(geometry.shape, peak.depth):
        return LedgerEntry("finite strain", "small displacements", None, f"a depth of {peak.depth:.3g} m: {too_deep}")
    found = finite_strain(geometry, peak, impacts is not None)
    refused = finite_faults("", replace(model, kinematics="finite"), geometry, impacts)
    return replace(found, key="", value=None, note=f"{found.note}; {refused[0]}") if refused else found


def finite_strain(geometry: Geometry, peak: Peak, struck: bool) -> LedgerEntry:
    """From small displacements to large ones, to first order, by the work of an elastic energy's cubic terms, and of
    the profile met by a surface that moves along it, in the body's small strains: at a depth, or `struck` by what
    brings the work. Energies with the same E and nu differ in it, in sign too. One energy alone, where it is known.
    """
    effect, treated, material = "finite strain", "small displacements", geometry.material
    if peak.contact_radius == 0.0 or peak.depth == 0.0:
        return LedgerEntry(effect, treated, 0.0, "nothing touches", key=LARGE, value="finite")
    rim = geometry.target.fixed_radius(geometry.shape) or math.inf  # beyond it, by rounding, a punch has no profile
    strains = geometry.target.strains(geometry.shape, material.nu, peak.depth, min(peak.contact_radius, rim))
    energies = ENERGY_NAMES if material.hyperelastic is None else (material.hyperelastic,)
    lost = [name for name in energies if geometry.target.pinched and strains.collapses(energy_of(name))]
    if lost:
        note = f"at nu = {material.nu:g} {ENERGY_NAMES[lost[0]]} loses its bulk modulus in these strains"
        return LedgerEntry(effect, treated, None, f"{note}; {LARGE} = finite tells", LARGE, value="finite")
    if material.hyperelastic is not None:
        size, name = abs(strains.change(energy_of(material.hyperelastic), struck)), ENERGY_NAMES[material.hyperelastic]
        return LedgerEntry(effect, treated, size, f"{name}, to first order in strain", key=LARGE, value="finite")
    found = {name: strains.change(energy_of(key), struck) for key, name in ENERGY_NAMES.items()}
    lowest, highest = (of(found, key=lambda name: found[name]) for of in (min, max))
    spread, usual = (found[lowest], found[highest]), ENERGY_NAMES[DEFAULT]
    told = f"{lowest} to {highest}, {usual} {percent(abs(found[usual]))}"
    note = f"{told}: the scene gives no law of large strains"
    least = min(map(abs, spread)) if spread[0] * spread[1] > 0.0 else None
    return LedgerEntry(effect, treated, least, note, LARGE, spread, "finite")


def of_dent(scene: Scene, peak: Peak) -> Peak:
    """With the depth of the dent in a rod's end, a half-space's at that contact radius, not the striker's way."""
    return replace(peak, depth=float(scene.profile.load_curve.depth(peak.contact_radius)))


def rod_end(scene: Scene, peak: Peak) -> LedgerEntry:
    """A rod's end comes in less than a half-space of its material, by k F/(E* b), b the rod's radius.

    What a half-space stores too much, k F^2/(2 E* b), is left to others, where the force goes as energy^(n/(n + 1)): to
    the dent alone, whose energy is F d/(n + 1), or to all that the striker brought. The geometric mean of both.
    """
    assert isinstance(scene.target, Rod)
    radius, n = math.sqrt(scene.target.area / math.pi), scene.profile.exponent_of_force
    stored = 0.5 * ROD_END * peak.force**2 / (scene.contact_modulus.spring * radius)
    dented, brought = peak.force * peak.depth / (n + 1.0), 0.5 * scene.reduced_mass * scene.velocity**2
    estimate = n / (n + 1.0) * stored / math.sqrt(dented * brought)
    note = f"the contact over the rod's radius is {peak.contact_radius / radius:.2g}"
    return LedgerEntry("dent of the rod's end", "a half-space's closed form", estimate, note)


def ends(geometry: Geometry, peak: Peak) -> LedgerEntry:
    """Plane strain against a body as long as its striker, whose ends are free: softer at the same depth.

    From 0.8 to 1.5 times what three-dimensional finite elements find (tests/fe/test_finite_length.py).
    """
    effect, treated, shape = FINITE_LENGTH, "plane strain", geometry.shape
    end = geometry.target.ends(shape, geometry.material.nu, peak.contact_radius)
    if end is None:
        return LedgerEntry(effect, treated, None, "how far the ends reach in is known of a layer or a ring only")
    note = f"softer: free ends have {percent(1.0 - end.share)} of the force, and reach {end.reach:.2g} m in"
    return LedgerEntry(effect, treated, end.softer(shape.total), note)


def striker(scene: Scene) -> LedgerEntry:
    """Unknown without a material of its own; nothing where it yields beside the target, or alone on a rigid one."""
    effect = "striker compliance"
    if scene.geometry.striking is not None:
        return LedgerEntry(effect, "included", 0.0)
    return LedgerEntry(effect, "rigid", None, "the scene gives the striker no material")


def sideways(scene: Scene, peak: Peak, part: str) -> LedgerEntry:
    """By how much the peak force changes, both ways, of a mass that meets a power of the depth, by the material of
    a ``part``; a scene of constant bulk modulus has chosen.
    """
    effect, material = "constant nu against constant bulk modulus", dict(scene.geometry.yielding)[part]
    if part != scene.target.owner:
        effect = f"{effect} of the {part}"
    treated, own = "constant nu", f"{part}.material.constant"
    if material.constant == "bulk":
        return LedgerEntry(effect, "constant bulk modulus", 0.0, "as the scene says")
    if material.young.is_elastic or math.isinf(material.bulk):
        return LedgerEntry(effect, treated, 0.0, "elastic or incompressible: the same")
    if material.young.relaxed == 0.0:
        return LedgerEntry(effect, treated, None, "no bulk modulus of a fluid is known")
    if material.young.viscosity > 0.0 and scene.target.has_length:
        return LedgerEntry(effect, treated, None, "not known of a dashpot in a body with lengths")
    if peak.depth == 0.0 or peak.duration == 0.0:
        return LedgerEntry(effect, treated, None, "not known without a contact")
    try:
        curve = scene.target.load_curve(scene.profile, scene.geometry.material.nu)
        alike = _own_modulus(scene.geometry)
        moduli = _bulk_modulus(scene, peak, part), alike
        forces = [_struck(one, curve, scene, peak, alike.spring) for one in moduli]
    except FeContactError:  # no load curve, or one that ends before this depth
        return LedgerEntry(effect, treated, None, f"no load curve tells it; run both of {own}")
    refused = _no_bulk(scene)
    note, key = "both, by a power of the depth", "" if refused else own
    said = f"{note}; {refused}" if refused else note
    return LedgerEntry(effect, treated, abs(forces[0] / forces[1] - 1.0), said, key, value=None if refused else "bulk")


def _no_bulk(scene: Scene) -> str:
    """Why finite elements take no bulk modulus that stays while the shear modulus relaxes; empty where they do."""
    geometry, state = scene.geometry, "with a constant bulk modulus in this version"
    target, shape = geometry.target, geometry.shape
    if scene.model.finite:
        constant = replace(geometry.material, constant="bulk")
        refused = finite_faults("", scene.model, replace(geometry, material=constant), scene.motion.impacts)
        return str(refused[0]) if refused else ""
    if scene.model.inertia and target.steady_waves(shape):
        return f"no waves {state}"
    if not target.has_length or (isinstance(shape, Block) and shape.uniform):
        return ""
    if isinstance(target, HalfSpace):
        return f"no impact of a {shape.name} on a {target.name} {state}"
    return f"one impact is followed {state}" if scene.motion.impacts > 1 else ""


def _own_modulus(geometry: Geometry) -> Relaxation:
    """E* of a body as of a half-space, also where it is a block; that of both where two yield."""
    return geometry.material.contact_modulus() if geometry.striker_material is None else geometry.contact_modulus


def _bulk_modulus(scene: Scene, peak: Peak, part: str) -> Relaxation:
    """The same where that ``part`` has a constant bulk modulus; its branches by as much more as a body with lengths
    confines it at once.
    """
    geometry, target = scene.geometry, scene.target
    if part != target.owner:
        assert geometry.striker_material is not None
        return _own_modulus(replace(geometry, striker_material=replace(geometry.striker_material, constant="bulk")))
    alike = geometry.material
    modulus = _own_modulus(replace(geometry, material=replace(alike, constant="bulk")))
    if not target.has_length:
        return modulus
    nu = replace(alike, constant="bulk").elastic(instant=True).nu
    confined, own = (float(target.load_curve(scene.profile, one).force(peak.depth)) for one in (nu, alike.nu))
    more = max(confined / own * modulus.glassy - modulus.relaxed, 0.0) / (modulus.glassy - modulus.relaxed)
    return replace(modulus, moduli=tuple(more * one for one in modulus.moduli))


def _struck(modulus: Relaxation, curve: LoadCurve, scene: Scene, peak: Peak, spring: float) -> float:
    """Largest force of the impact by F = int E*(t-s) d(c y), y = depth^n, over that by a `spring` alone, Pa.

    n and c are the load curve's at the peak; lengths over the elastic depth, which is reached in a time of one.
    """
    force, n = _power(curve, peak.depth)
    work, brought = force * peak.depth / (n + 1.0), 0.5 * scene.reduced_mass * scene.velocity**2
    unit = peak.depth * (brought / (spring * work)) ** (1.0 / (n + 1.0)) / scene.velocity
    return _largest_force(modulus.stretched(1.0 / unit).scaled(1.0 / spring), n, peak.duration / unit / ROWS)


def _largest_force(modulus: Relaxation, n: float, step: float) -> float:
    """Of x'' = -(n + 1)/2 F, F = int E(t-s) d(x^n), x' = 1 at first, on the way in, within a contact's steps.

    The trapezoidal rule with exact branches; each step's end by Newton's method on a function that is convex.
    """
    slowed, times = 0.25 * (n + 1.0) * step, modulus.times
    kept = [math.exp(-step / tau) for tau in times]
    gains = [e * tau * (1.0 - k) / step for e, tau, k in zip(modulus.moduli, times, kept, strict=True)]
    pressed = modulus.relaxed + sum(gains) + modulus.viscosity / step
    depth, speed, load, force, most, branches = 0.0, 1.0, 0.0, 0.0, 0.0, [0.0] * len(kept)
    for _ in range(ROWS):
        branches = [k * one - gain * load for k, one, gain in zip(kept, branches, gains, strict=True)]
        carried, free = sum(branches) - modulus.viscosity / step * load, depth + step * speed
        depth = free
        for _ in range(NEWTON):
            over = depth - free + 0.5 * step * slowed * (force + pressed * depth**n + carried)
            depth -= over / (1.0 + 0.5 * step * slowed * pressed * n * depth ** (n - 1.0))
        load, before = depth**n, force
        branches = [one + gain * load for one, gain in zip(branches, gains, strict=True)]
        force = pressed * load + carried
        speed, most = speed - slowed * (before + force), max(most, force)
        if speed < 0.0:
            break
    return most


def series(scene: Scene, peak: Peak) -> LedgerEntry:
    """How far a Prony series may be from the modulus which it was fitted to."""
    effect, fidelity = "material series", scene.geometry.material.young.fidelity
    if fidelity is None:
        return LedgerEntry(effect, "the material itself", 0.0)
    shortest, longest = fidelity.window
    treated = f"fitted to {fidelity.inside:.2g} over {shortest:.3g} to {longest:.3g} s"
    bound = fidelity.of_force(peak.duration)
    return LedgerEntry(effect, treated, bound if math.isfinite(bound) else None, "bound until the contact recedes")


def plasticity(scene: Scene | Indenter, model: Model, peak: Peak, struck: bool = False) -> LedgerEntry:
    """At the same depth F = F_Hertz/(1 + 0.047 ln^2 w), w the depth over that of first yield; ``struck``: half of it.

    What finite elements find without hardening at nu = 0.3, to a sixth for w = 1.5 to 30; Jackson and Green 2005 (doi
    10.1115/1.1866166) to a tenth up to w = 100. A rim yields before; of two bodies the one that does so first counts:
    where one has no yield strength, at least the other.
    """
    effect, geometry = "plasticity", scene.geometry
    shape, target = geometry.shape, geometry.target
    if model.plasticity:
        return LedgerEntry(effect, "included", 0.0)
    ratios, needs = list[tuple[float, Material]](), list[str]()
    for part, material in reversed(geometry.yielding):
        if material.yield_strength is None:
            needs.append(f"needs {part}.material.yield_strength")
            continue
        stress = target.mises(shape, material.nu, peak.force, peak.contact_radius) if peak.contact_radius else 0.0
        ratios.append((stress / material.yield_strength, material))
    over, material = max(ratios, key=lambda one: one[0], default=(0.0, geometry.material))
    if target.sides(shape):
        change = yielded_alike(over, material, target.sides(shape) == "free", struck)
    else:
        softer = FLOW * math.log(max(over, 1.0) ** 2) ** 2
        if target.fixed_radius(shape) is not None:
            softer += RIM * min(over, 1.0) ** 2
        change = (IN_AN_IMPACT if struck else 1.0) * softer / (1.0 + softer)
    if needs and not change:
        return LedgerEntry(effect, "neglected", None, needs[0])
    note = f"von Mises finds {over:.3g} Y where it is elastic"
    if needs:
        return LedgerEntry(effect, "neglected", change, f"{note}; {needs[0]}", spread=(-1.0, -change))
    impacts = scene.motion.impacts if isinstance(scene, Scene) else 1
    refused = plasticity_faults("", replace(model, plasticity=True), scene.geometry, impacts)
    if refused:
        return LedgerEntry(effect, "neglected", change, f"{note}; {refused[0]}")
    return LedgerEntry(effect, "neglected", change, note, "model.plasticity", value=True)


def yielded_alike(over: float, material: Material, free: bool, struck: bool) -> float:
    """What a block loses whose stress would be so many times what it yields at: at that depth, or ``struck`` by what
    brings the work. Beyond it follows with H/(E + H) of its stiffness, or with its sides held as its bulk does and
    H/(3 G + H) of its shear.
    """
    if over <= 1.0:
        return 0.0
    young, hardening = material.young.spring, material.hardening_modulus or 0.0
    shear = young / (2.0 * (1.0 + material.nu))
    flows = hardening / (3.0 * shear + hardening) if hardening else 0.0
    if free:
        tangent = hardening / (young + hardening) if hardening else 0.0
    else:
        volume = (1.0 + material.nu) / (3.0 * (1.0 - material.nu))  # share of the bulk in K + 4 G/3
        tangent = volume + (1.0 - volume) * flows
    if struck:
        return 1.0 - math.sqrt(1.0 / over**2 + tangent * (1.0 - 1.0 / over**2))
    return (1.0 - tangent) * (1.0 - 1.0 / over)


def adhesion(scene: Scene, peak: Peak) -> LedgerEntry:
    """The pull-off force (3/2) pi w R of Johnson, Kendall and Roberts 1971, doi 10.1098/rspa.1971.0141; of two round
    bodies 1/R = 1/R1 + 1/R2.
    """
    geometry, target = scene.geometry, scene.target
    work = geometry.of_pair("work_of_adhesion")
    if work is None:
        return LedgerEntry("adhesion", "neglected", None, f"needs {target.owner}.material.work_of_adhesion")
    tip = geometry.shape.tip_radius
    if tip is None or geometry.shape.plane:
        return LedgerEntry("adhesion", "neglected", None, "the pull-off force is known for a round tip only")
    near = TIP * tip
    radius = near**2 / (-2.0 * float(target.overlap(geometry.shape, near, 0.0)))
    return LedgerEntry("adhesion", "neglected", 1.5 * math.pi * work * radius / peak.force, "JKR pull-off force")


def friction(scene: Scene | Indenter, model: Model, peak: Peak, impact: bool = False) -> list[LedgerEntry]:
    """What it adds to the force at the same depth, or to the peak of an ``impact``; none of a block, whose faces say.

    As where all of the contact slips, by its coefficient, but no more than where nothing does. Both are of elastic
    bodies: at nu = 0.49 a punch that sticks bears some 0.5 % more by finite elements where a body flows, 0.02 % before.
    """
    geometry = scene.geometry
    shape, target, coefficient = geometry.shape, geometry.target, geometry.of_pair("friction")
    if isinstance(shape, Block):
        return []
    effect, treated = "friction", "frictionless"
    if coefficient == 0.0:
        return [LedgerEntry(effect, treated, 0.0)]
    if shape.plane or not isinstance(target, LIKE_HALF_SPACES):
        what = "in plane strain" if shape.plane else f"on {target.called or f'a {target.name}'}"
        return [LedgerEntry(effect, treated, None, f"no formula {what}")]
    if model.plasticity:
        return [LedgerEntry(effect, treated, None, "no formula for a body that yields")]
    exponent = _exponent(scene, peak)
    power = 1.0 / (exponent - 1.0) if exponent > ALMOST_FLAT else math.inf
    beta = mismatch(geometry.material, geometry.striker_material)
    most = _peak_of(stuck(beta, power), exponent if impact else 0.0)
    if coefficient is None:
        needs = f"needs {target.owner}.material.friction"
        return [LedgerEntry(effect, treated, None if most else 0.0, needs, spread=(0.0, most) if most else None)]
    slips = _peak_of(1.0 + slipping(power) * beta * coefficient, exponent if impact else 0.0)
    return [LedgerEntry(effect, treated, min(slips, most), f"at most {percent(most)}, where nothing slips")]


def _peak_of(firmer: float, exponent: float) -> float:
    """What a force so many times as large at every depth adds to the peak of an impact, whose energy is the same; to
    the force itself for an ``exponent`` 0 of it.
    """
    return float(firmer ** (1.0 / (exponent + 1.0)) - 1.0)
