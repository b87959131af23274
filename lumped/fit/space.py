"""The parameters of a fit, of a law and of a simple network: which are free, within which bounds, and their scene."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from lumped import laws
from lumped.errors import BadInput, Fault, nearest
from lumped.laws._parameters import COMMON, EXPONENT, RESTITUTION, STIFFNESS
from lumped.materials import Material, Relaxation
from lumped.materials.networks import NETWORKS
from lumped.scene.scene import Scene
from lumped.scene.tables import LawChoice
from lumped.schema import Table
from lumped.schema.keys import Number

Bounds = Mapping[str, tuple[float, float]]
# The touch on the curve's clock, s: the one parameter that may be negative.
TOUCH = "touch"
TOUCH_KEY = Number(-1e12, 1e12, "s")
# What nobody has bounded is sought within this factor of its first guess.
REACH = 1e8
# Networks whose parameters a fit can change.
FAMILIES = ("elastic", "kelvin_voigt", "maxwell", "sls")
# Parts of a fit that know no option: see :func:`lumped.errors.addressed`.
FREE, FIXED, BOUNDS = "free", "fixed", "bounds"
GAP = "gap"
UNSEEN = {GAP: "no force tells it, for time starts at touch; accepted: fixed"}


@dataclass(frozen=True, eq=False)
class Space:
    """Parameters of a law and of a scene's material: free ones with their keys, held ones with their values."""

    law: str
    scene: Scene
    free: Mapping[str, Number]
    held: Mapping[str, float]
    bounds: Bounds

    def scene_at(self, values: Mapping[str, float]) -> Scene:
        """The scene with these values of the free parameters. Raises BadInput."""
        every, own = {**self.held, **values}, own_keys(self.law)
        of_law = {name: every[name] for name in every if name in own}
        of_network = {name: every[name] for name in every if name not in own and name != TOUCH}
        scene = replace(self.scene, law=LawChoice(self.law, {**_said(self.scene, self.law, of_law), **of_law}))
        if not of_network:
            return scene
        return replace(scene, material=_material(self.scene.geometry.material, of_network))

    def touch(self, values: Mapping[str, float]) -> float:
        """When the bodies touch on the curve's clock, s."""
        return {TOUCH: 0.0, **self.held, **values}[TOUCH]

    def limits(self, name: str, guess: float) -> tuple[float, float]:
        """Lowest and highest value of a free parameter."""
        if name in self.bounds:
            return self.bounds[name]
        key = self.free[name]
        if name == TOUCH:
            return key.low, key.high
        inside = min(max(guess, key.low), key.high)
        return max(key.low, inside / REACH), min(key.high, inside * REACH)


def space_of(law: str, scene: Scene, free: Sequence[str] | None, fixed: Mapping[str, float], bounds: Bounds) -> Space:
    """The parameters asked for, checked; by default those that a law is known by. Raises BadInput, every fault."""
    scene.check_single("a fit")
    own = own_keys(law)
    known = {**own, TOUCH: TOUCH_KEY, **{name: key for name, key in network_keys().items() if name not in own}}
    names = tuple(default_free(law, scene, fixed) if free is None else free)
    asked = [(FREE, name) for name in names] + [(FIXED, name) for name in fixed] + [(BOUNDS, name) for name in bounds]
    faults = [_unknown(place, name, law, known) for place, name in asked if name not in known]
    faults += [Fault(FREE, "", "empty; accepted: at least one parameter")] if not names else []
    faults += [Fault(FREE, name, UNSEEN[name]) for name in names if name in UNSEEN]
    faults += [Fault(FIXED, name, "both free and fixed; accepted: one of them") for name in names if name in fixed]
    unbound = [name for name in bounds if name not in names]
    faults += [Fault(BOUNDS, name, "has bounds and is not free; accepted: free") for name in unbound]
    faults += [
        Fault(BOUNDS, name, f"{low:g}:{high:g} is empty; accepted: low < high")
        for name, (low, high) in bounds.items()
        if not low < high
    ]
    given = [(FIXED, *one) for one in fixed.items()]
    given += [(BOUNDS, name, end) for name, ends in bounds.items() for end in ends]
    faults += [fault for one in given if one[1] in known for fault in _range_faults(*one, known[one[1]])]
    if faults:
        raise BadInput(faults)
    return Space(law, scene, {name: known[name] for name in names}, dict(fixed), dict(bounds))


def own_keys(law: str) -> dict[str, Number]:
    """The numbers that a law has of its own."""
    return {name: key.kind for name, key in laws.get(law).keys.items() if isinstance(key.kind, Number)}


def damping_names(law: str) -> tuple[str, ...]:
    """The damper's parameters, each zero or more, one of which is given in the place of e."""
    return tuple(name for name, key in own_keys(law).items() if key.low == 0.0 and name not in COMMON)


def default_free(law: str, scene: Scene, fixed: Mapping[str, float]) -> tuple[str, ...]:
    """Stiffness and damping; of a law without numbers of its own those of the material, E0 held as in "(26)"."""
    own, dampers = own_keys(law), damping_names(law)
    if laws.get(law).elastic:
        names: tuple[str, ...] = ("E",)
    elif not own:
        names = ("R1", "R2") if scene.geometry.material.young.relaxed else ("E", "eta")
    else:
        springs = [name for name in own if name not in {*STIFFNESS, *EXPONENT, *RESTITUTION, *COMMON, *dampers}]
        names = (*(springs or STIFFNESS), *(() if {"e", *dampers} & fixed.keys() else dampers[:1]))
    return tuple(name for name in names if name not in fixed)


def quietly_held(space: Space) -> tuple[str, ...]:
    """What would be free by default, and is neither free nor fixed: the scene's own values hold it.

    Of a material those alone of a fit that has no number free: it stands by one set of names or another.
    """
    default = default_free(space.law, space.scene, {**space.held, **dict.fromkeys(space.free, 0.0)})
    own = own_keys(space.law)
    return tuple(name for name in default if name in own or space.free.keys() == {TOUCH})


def _said(scene: Scene, law: str, chosen: Mapping[str, float]) -> Table:
    """What the scene's own [law] says, without another name of a damping that is chosen here.

    Of another law the gap alone, which belongs to the bodies.
    """
    if scene.law is None or scene.law.name != law:
        known = {} if scene.law is None else scene.law.values
        return {GAP: known[GAP]} if GAP in known and GAP in own_keys(law) else {}
    dampings = {"e", "damping", *damping_names(law)}
    dropped = dampings if dampings & chosen.keys() else set()
    return {name: value for name, value in scene.law.values.items() if name not in dropped}


def _unknown(place: str, name: str, law: str, known: Mapping[str, Number]) -> Fault:
    own = [one for one in known if one in own_keys(law)]
    others = ", ".join(one for one in known if one not in own)
    accepted = f"of {law} {', '.join(own)}; {others}" if own else others
    return Fault(place, name, f"unknown parameter; accepted: {accepted}{nearest(name, tuple(known))}")


def _range_faults(place: str, name: str, value: float, key: Number) -> list[Fault]:
    try:
        key.read(value)
    except ValueError:
        return [Fault(place, name, f"{value!r} is not accepted; accepted: {key.accepted}")]
    return []


def network_keys() -> dict[str, Number]:
    """Every parameter of a network that a fit can change."""
    every = [item for family in FAMILIES for keys in NETWORKS.get(family).sets for item in keys.items()]
    return {name: key.kind for name, key in every if isinstance(key.kind, Number)}


def _material(own: Material, values: Mapping[str, float]) -> Material:
    """The material with `values`, at its reference temperature, the rest of its network's parameters its own.

    Raises BadInput.
    """
    family, names = _network(own.young, values)
    known = {**own_values(own.reference), **values}
    missing = [name for name in names if name not in known]
    if missing:
        reason = "missing; the scene's material does not tell it; accepted: free, or a fixed value"
        raise BadInput(Fault(FREE, name, reason) for name in missing)
    return own.with_reference(NETWORKS.get(family).of(**{name: known[name] for name in names}))


def own_values(young: Relaxation) -> dict[str, float]:
    """What a relaxation modulus says of the parameters of the networks, as far as it is one of them."""
    relaxed, values = young.relaxed, {"E": young.spring}
    if relaxed:
        values["E0"] = relaxed
    if young.viscosity and not young.moduli:
        values["eta"] = young.viscosity
    if len(young.moduli) != 1 or young.viscosity:
        return values
    (modulus,), (time,) = young.moduli, young.times
    if not relaxed:
        return values | {"eta": modulus * time}
    ratio = modulus / relaxed
    return values | three_parameters(relaxed, ratio, time * (1.0 + ratio))


def three_parameters(E0: float, R1: float, R2: float) -> dict[str, float]:
    """The 3-parameter solid by both sets of its names, "(25)"."""
    E1 = E0 * (1.0 + R1) / R1
    return {"E0": E0, "R1": R1, "R2": R2, "E1": E1, "E2": E0 * (1.0 + R1), "C1": R2 * E1}


def _network(young: Relaxation, names: Iterable[str]) -> tuple[str, tuple[str, ...]]:
    """The smallest network with these parameters that forgets nothing of what the scene's own remembers."""
    found = [
        (family, tuple(keys))
        for family in _open_to(young)
        for keys in NETWORKS.get(family).sets
        if set(names) <= set(keys)
    ]
    if not found:
        sets = [", ".join(kind) for family in _open_to(young) for kind in NETWORKS.get(family).sets]
        reason = f"no network of the material has {', '.join(names)}; accepted, of one set: {'; '.join(sets)}"
        raise BadInput(Fault(FREE, "", reason))
    return min(found, key=lambda kind: len(kind[1]))


def _open_to(young: Relaxation) -> tuple[str, ...]:
    if young.relaxed == 0.0:
        return ("maxwell",)
    if young.moduli:
        return ("sls",)
    return ("kelvin_voigt", "sls") if young.viscosity else ("elastic", "kelvin_voigt", "sls")
