"""What the public API says of itself: every name of it, units of numbers, shapes of arrays, causes of failures.

Public is what the three packages export, and the contracts of members: whoever writes one reads them.
"""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import pytest

import fe_contact
import lumped
import meshes
from fe_contact.budget.refine import Way
from fe_contact.contact.enforcement.base import Enforcement
from fe_contact.dynamics.mass.base import Mass, MassMatrix
from fe_contact.dynamics.schemes.base import Family, Scheme
from fe_contact.schemes.base import MemoryScheme
from fe_contact.targets.base import MeshedTarget
from fe_contact.waves.targets.base import WaveTarget
from lumped.laws.base import LawKind
from lumped.load_curves.base import LoadCurve
from lumped.shapes.base import Shape
from lumped.targets.base import Target

PACKAGES = ("lumped", "meshes", "fe_contact")
CONTRACTS = (
    LawKind, LoadCurve, Shape, Target, MemoryScheme, Enforcement, Mass, MassMatrix, Family, Scheme, MeshedTarget,
    WaveTarget, Way,
)  # fmt: skip
UNIT = r"(?:m|s|N|kg|Pa|J|K|rad|1)(?:\^?\d)?(?:[ /](?:m|s|N|kg|Pa|J)(?:\^?[\d.a-z]+)?)*"
TOLD = re.compile(
    rf"(?<![\w.]){UNIT}(?![\w])|SI units|`unit`|share|ratio|relative| over |times|from \S+ to|\d to \d|times as"
)
NUMBERS = {"tolerance", "nu", "restitution", "estimate", "elements", "normalized"}  # words that are no quantity
SHAPE = re.compile(r"\((?:[a-z0-9_]+(?: [+*-] \d)?, ?)+(?:[a-z0-9_ ]+)?\)|of one length|scalars? or arrays?|broadcasts")


def public() -> Iterator[tuple[str, Any]]:
    """Names and objects."""
    for package in (lumped, meshes, fe_contact):
        names = getattr(package, "__all__", [name for name in vars(package) if not name.startswith("_")])
        for name in names:
            thing = getattr(package, name)
            if inspect.isclass(thing) or inspect.isfunction(thing):
                yield f"{package.__name__}.{name}", thing
    for contract in CONTRACTS:
        yield f"{contract.__module__}.{contract.__name__}", contract


PUBLIC = dict(public())


def own(thing: Any) -> Iterator[tuple[str, Callable[..., Any]]]:
    """The functions and properties that a public thing defines, itself if it is one."""
    if inspect.isfunction(thing):
        yield thing.__name__, thing
        return
    for name, value in vars(thing).items():
        found = value.fget if isinstance(value, property) else getattr(value, "func", getattr(value, "__func__", value))
        if not name.startswith("_") and inspect.isfunction(found):
            yield name, found


def inherited(thing: Any) -> str:
    """Its docstring and those of its bases in our packages."""
    bases = [base for base in getattr(thing, "__mro__", (thing,)) if base.__module__.split(".")[0] in PACKAGES]
    return "\n\n".join(inspect.getdoc(base) or "" for base in bases)


@pytest.mark.parametrize("name", PUBLIC)
def test_everything_public_says_what_it_is(name: str) -> None:
    thing = PUBLIC[name]
    assert inspect.getdoc(thing), name
    silent = [one for one, function in own(thing) if not inspect.getdoc(function)]
    assert not silent


@pytest.mark.parametrize("name", PUBLIC)
def test_numbers_have_a_unit(name: str) -> None:
    """A clause that names a number, in its own docstring or in its class's, says a unit or that it is a ratio."""
    thing = PUBLIC[name]
    text = inherited(thing)
    floats = ("float", "float | None", "Array", "Array | None")
    named = [(field.name, text) for field in (fields(thing) if is_dataclass(thing) else ()) if field.type in floats]
    for _, function in own(thing):
        told = f"{inspect.getdoc(function)}. {text}"
        kinds = function.__annotations__.items()
        named += [(parameter, told) for parameter, kind in kinds if parameter != "return" and kind in floats]
    assert not [one for one, told in named if not one.startswith("_") and not has_unit(one, told)]


def has_unit(name: str, text: str) -> bool:
    """Whether a clause that says a word of the name, or its plural, says a unit too."""
    words = set(name.split("_"))
    if words & NUMBERS:
        return True
    clauses = [one for one in re.split(r"[.;] |\n\n", text) if any(re.search(rf"\b{word[:-1]}", one) for word in words)]
    return any(TOLD.search(one) for one in clauses)


@pytest.mark.parametrize("name", PUBLIC)
def test_arrays_have_a_shape(name: str) -> None:
    text = inherited(PUBLIC[name])
    missing = [
        one
        for one, function in own(PUBLIC[name])
        if any("Array" in str(kind) for kind in function.__annotations__.values())
        and not SHAPE.search(f"{inspect.getdoc(function)} {text}")
    ]
    assert not missing


@pytest.mark.parametrize("name", PUBLIC)
def test_failures_are_told(name: str) -> None:
    """Every named failure that a function raises itself."""
    missing = []
    for one, function in own(PUBLIC[name]):
        tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
        for node in ast.walk(tree):
            if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
                failure = ast.unparse(node.exc.func).rpartition(".")[2]
                if failure not in (inspect.getdoc(function) or "") + (inspect.getdoc(PUBLIC[name]) or ""):
                    missing.append(f"{one}: {failure}")
    assert not missing
