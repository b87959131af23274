"""Scenes told in other metres, seconds and kilogrammes: nothing in the suite is a length, a time or a mass of its own.

Units by powers of two change no digit but where a mesh or a tolerance that is absolute would be hidden.
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest

import fe_contact
from lumped import Quantity, Result, Scene

FILES = Path(__file__).resolve().parents[2] / "data" / "scenes"
METRE, SECOND, KILOGRAMME = 4.0, 0.25, 8.0  # how many of ours one of theirs is; a square root of metres is exact
# Exponents of metre, second, kilogramme by key; what is not here is a pure number or a word.
LENGTHS = (
    "radius", "thickness", "length", "height", "inner_radius", "outer_radius", "section_radius", "mean_radius", "gap",
    "datum_depth",
)  # fmt: skip
PASCALS = ("E", "E0", "E1", "E2", "E_inf", "K")
UNITS: dict[str, tuple[float, float, float]] = {
    **dict.fromkeys(LENGTHS, (1.0, 0.0, 0.0)),
    **dict.fromkeys(PASCALS, (-1.0, -2.0, 1.0)),
    **dict.fromkeys(("R2", "tau", "end_time"), (0.0, 1.0, 0.0)),
    "area": (2.0, 0.0, 0.0),
    "velocity": (1.0, -1.0, 0.0),
    "gravity": (1.0, -2.0, 0.0),
    "mass": (0.0, 0.0, 1.0),
    "density": (-3.0, 0.0, 1.0),
    "C1": (-1.0, -1.0, 1.0),
}
OF_QUANTITIES = {
    "peak_force": (1.0, -2.0, 1.0),
    "peak_time": (0.0, 1.0, 0.0),
    "peak_depth": (1.0, 0.0, 0.0),
    "duration": (0.0, 1.0, 0.0),
    "impulse": (1.0, -1.0, 1.0),
    "restitution": (0.0, 0.0, 0.0),
}
ALIKE = 1e-9  # of values: rounding of sizes that are no powers of two, through a mesh's digits
SCENES = (
    "polymer-sphere", "polymer-cone", "polymer-layer", "polymer-washer", "polymer-plate", "polymer-prism", "steel-ball",
    "steel-ball-sls", "two-spheres", "polymer-punch",
)  # fmt: skip
LONG = (
    "polymer-o-ring", "polymer-half-plane", "polymer-layer-line", "rod-in-ring", "two-finite-spheres", "bar",
    "steel-ball-waves", "rod", "paper-ring-finite",
)  # fmt: skip
OWN = {"bar": 0.1, "paper-ring-finite": 0.1}  # of a history that jumps, as its file has it; of large strains, dear
LAWS = ("ting", "correspondence", "mdr")


def factor(exponents: tuple[float, float, float]) -> float:
    """How many of ours a unit of theirs is."""
    length, time, mass = exponents
    return float(METRE**length * SECOND**time * KILOGRAMME**mass)


def in_other_units(table: dict[str, Any]) -> dict[str, Any]:
    """The table of a scene with every number turned."""
    return {key: turned(key, value) for key, value in table.items()}


def turned(key: str, value: Any) -> Any:
    """A value or a table of them."""
    if isinstance(value, dict):
        return in_other_units(value)
    if isinstance(value, float) and key in UNITS:
        return value * factor(UNITS[key])
    return value


def both(name: str) -> tuple[Scene, Scene]:
    """A packaged scene as it is and in the other units."""
    table = tomllib.loads((FILES / f"{name}.toml").read_text(encoding="utf-8"))
    return Scene.load(name), Scene.from_dict(in_other_units(table))


def differences(ours: Result, theirs: Result, bars: float) -> list[str]:
    """Quantities that are not the same value, or whose bars differ by more than a share ``bars``."""
    return [
        f"{name}: {mine} and {other} in our units"
        for name, exponents in OF_QUANTITIES.items()
        for mine, other in [(ours.quantities[name], theirs.quantities[name])]
        if not _same(mine, other, factor(exponents), bars)
    ]


def _same(mine: Quantity, other: Quantity, unit: float, bars: float) -> bool:
    if mine.value is None or other.value is None or mine.error is None or other.error is None:
        return mine.value is other.value and mine.error is other.error
    value = abs(other.value / unit - mine.value) <= ALIKE * abs(mine.value)
    return value and abs(other.error / unit - mine.error) <= bars * mine.error + ALIKE * abs(mine.value)


@pytest.mark.family
@pytest.mark.parametrize("name", [*SCENES, *(pytest.param(name, marks=pytest.mark.tenth) for name in LONG)])
def test_finite_elements_know_no_unit(name: str) -> None:
    ours, theirs = (fe_contact.run(scene, OWN.get(name, 1e-2)) for scene in both(name))
    assert ours.converged == theirs.converged
    assert ours.work == theirs.work
    assert not differences(ours, theirs, bars=1e-4)


@pytest.mark.parametrize("method", LAWS)
@pytest.mark.parametrize("name", SCENES[:2])
def test_laws_know_no_unit(name: str, method: str) -> None:
    ours, theirs = (fe_contact.run(scene, 1e-3, method=method) for scene in both(name))
    assert not differences(ours, theirs, bars=0.5)
