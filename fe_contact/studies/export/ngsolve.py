"""NGSolve: a Python script that meshes, solves and, for an impact, marches in time. Weak form and steps stand in it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from string import Template
from typing import ClassVar

import numpy as np

from fe_contact.studies.export.base import ImpactCase, StaticCase

PROFILE_POINTS = 2001  # of the profile's table
ELEMENTS = 6  # of order three, a contact radius
STEPS = 40  # of a contact


@dataclass(frozen=True)
class NGSolve:
    """See the module."""

    suffix: ClassVar[str] = ".py"
    how: ClassVar[str] = "pip install ngsolve, then python {file}"

    def static(self, case: StaticCase) -> str:
        """As the contract says."""
        return _filled("static", case, YOUNG=case.young, DEPTH=case.depth)

    def impact(self, case: ImpactCase) -> str:
        """As the contract says."""
        young = case.young
        return _filled(
            "impact", case, EQUILIBRIUM=young.equilibrium, MODULI=list(young.moduli), TIMES=list(young.times),
            VISCOSITY=young.viscosity, MASS=case.mass, VELOCITY=case.velocity, DURATION=case.duration,
            STEPS=STEPS * case.refined,
        )  # fmt: skip


def _filled(kind: str, case: StaticCase | ImpactCase, **numbers: object) -> str:
    """The common part and the one of this kind, with the case's numbers."""
    body = case.body
    heights = body.height(np.linspace(0.0, body.reach, PROFILE_POINTS))
    across, up = body.lattice(ELEMENTS, case.refined)
    given = numbers | {
        "NU": body.nu, "EDGE": body.edge, "REACH": body.reach, "HELD": body.held, "BONDED": body.bonded,
    }  # fmt: skip
    lists = {"ACROSS": across, "UP": up, "HEIGHTS": heights}
    parts = (Path(__file__).parent / f"ngsolve_{name}.txt" for name in ("body", kind))
    return Template("".join(part.read_text(encoding="utf-8") for part in parts)).substitute(
        {name: ", ".join(f"{float(value):.12g}" for value in values) for name, values in lists.items()},
        NAME=case.name,
        SAID="\n".join(case.said),
        NUMBERS="\n".join(f"{key} = {value!r}" for key, value in given.items()),
    )


MEMBER = NGSolve()
