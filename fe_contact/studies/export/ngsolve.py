"""NGSolve: a Python script that meshes, solves and, for an impact, marches in time. Weak form and steps stand in it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from string import Template
from typing import ClassVar

import numpy as np

from fe_contact.studies.export.base import ImpactCase, PressedCylinder, StaticCase
from lumped.schema import Table

FAR = 400.0  # contact radii, where an infinite body ends: meshes of netgen that reach further fail, or err
INFINITE = (
    "",
    "The infinite body is cut off, which errs as one over the distance: run this as it is, and with 0.5 behind its",
    "name; twice the first force less the second one is that of the infinite body.",
)
PROFILE_POINTS, PROFILE_REACH = 2001, 1.6  # of the profile's table, and how far it goes, in contact radii


@dataclass(frozen=True)
class NGSolve:
    """See the module."""

    suffix: ClassVar[str] = ".py"
    how: ClassVar[str] = "pip install ngsolve, then python {file}"
    elements: ClassVar[int] = 12

    def static(self, case: StaticCase, elements: int) -> str:
        """As the contract says."""
        given = {"YOUNG": case.young, "DEPTH": case.depth, "ELEMENTS": elements}
        return _filled("static", case.body, case.name, case.said, given)

    def impact(self, case: ImpactCase, elements: int) -> str:
        """As the contract says."""
        young = case.young
        given = {
            "EQUILIBRIUM": young.equilibrium, "MODULI": list(young.moduli), "TIMES": list(young.times),
            "VISCOSITY": young.viscosity, "MASS": case.mass, "VELOCITY": case.velocity, "DURATION": case.duration,
            "ELEMENTS": elements,
        }  # fmt: skip
        return _filled("impact", case.body, case.name, case.said, given)


def _filled(kind: str, body: PressedCylinder, name: str, said: tuple[str, ...], numbers: Table) -> str:
    """The common part and the one of this kind, with the case's numbers."""
    body = body.cut_off(FAR)
    distance = np.linspace(0.0, PROFILE_REACH * body.edge, PROFILE_POINTS)
    heights = ", ".join(f"{float(height):.12g}" for height in body.height(distance))
    given: Table = numbers | {
        "NU": body.nu, "EDGE": body.edge, "RADIUS": body.radius, "THICKNESS": body.thickness, "HELD": body.held,
        "BONDED": body.bonded, "REACH": PROFILE_REACH,
    }  # fmt: skip
    table = "\n".join(f"{key} = {value!r}" for key, value in given.items())
    text = "".join(
        (Path(__file__).parent / f"ngsolve_{part}.txt").read_text(encoding="utf-8") for part in ("body", kind)
    )
    lines = (*said, *(INFINITE if body.held else ()))
    return Template(text).substitute(NAME=name, SAID="\n".join(lines), NUMBERS=table, HEIGHTS=heights)


MEMBER = NGSolve()
