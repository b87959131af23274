"""A scene's material by the parameters of a simple network, for a fit to change them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from lumped.errors import BadInput, Fault
from lumped.materials import Material, Relaxation
from lumped.materials.networks import NETWORKS
from lumped.schema.keys import Number

FAMILIES = ("elastic", "kelvin_voigt", "maxwell", "sls")
SOURCE = "free"


def keys() -> dict[str, Number]:
    """Every parameter of a network that a fit can change."""
    every = [item for family in FAMILIES for keys in NETWORKS.get(family).sets for item in keys.items()]
    return {name: key.kind for name, key in every if isinstance(key.kind, Number)}


def material(own: Material, values: Mapping[str, float]) -> Material:
    """The material with `values`, the rest of its network's parameters its own. Raises BadInput."""
    family, names = _network(own.young, values)
    known = {**own_values(own.young), **values}
    missing = [name for name in names if name not in known]
    if missing:
        reason = "missing; the scene's material does not tell it; accepted: free, or a fixed value"
        raise BadInput(Fault(SOURCE, name, reason) for name in missing)
    return replace(own, young=NETWORKS.get(family).of(**{name: known[name] for name in names}))


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
        raise BadInput(Fault(SOURCE, "", reason))
    return min(found, key=lambda kind: len(kind[1]))


def _open_to(young: Relaxation) -> tuple[str, ...]:
    if young.relaxed == 0.0:
        return ("maxwell",)
    if young.moduli:
        return ("sls",)
    return ("kelvin_voigt", "sls") if young.viscosity else ("elastic", "kelvin_voigt", "sls")
