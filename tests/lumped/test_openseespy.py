"""OpenSees' own impact with the exported lines, against the law's; only with --opensees."""

from __future__ import annotations

import contextlib
from dataclasses import replace
from typing import Any

import numpy as np
import openseespy.opensees as ops
import pytest

from lumped import Scene, laws, simulate
from lumped.fit import opensees
from lumped.scene.tables import LawChoice

BODY = Scene(None, mass=0.001, velocity=1.0)
STEPS = 20_000
CASES: dict[str, dict[str, Any]] = {
    "linear_spring": {"k": 1e5},
    "kelvin": {"k": 1e5, "xi": 0.2, "exit": "depth"},
    "mahmoud": {"k": 1e5, "xi": 0.2},
    "hertz": {"k": 1e7},
    "jankowski": {"k": 1e7, "xi": 0.3},
    "hertzdamp": {"k": 1e7, "xi": 0.4},
    "hunt_crossley": {"k": 1e7, "chi": 0.4},
    "khatiwada": {"k": 1e7, "c": 4e6},
    "impact_bilinear": {"k1": 2e5, "k2": 5e4, "yield_depth": 2e-5},
}


def force_of(command: str, mass: float, velocity: float, end_time: float) -> np.ndarray:
    """The force on a mass that flies into the material, N, after each of STEPS steps of the explicit Newmark scheme."""
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    for node in (1, 2):
        ops.node(node, 0.0)
    ops.fix(1, 1)
    ops.mass(2, mass)
    exec(command, {"ops": ops})
    ops.element("zeroLength", 1, 1, 2, "-mat", 1, "-dir", 1)
    ops.setNodeVel(2, 1, -velocity, "-commit")
    for setting in (("constraints", "Plain"), ("numberer", "Plain"), ("system", "Diagonal"), ("algorithm", "Linear")):
        getattr(ops, setting[0])(setting[1])
    ops.integrator("NewmarkExplicit", 0.5)
    ops.analysis("Transient")
    forces = []
    for _ in range(STEPS):
        assert ops.analyze(1, end_time / STEPS) == 0
        forces.append(-ops.eleResponse(1, "material", 1, "stress")[0])
    return np.array(forces)


@pytest.mark.parametrize("name", CASES)
def test_the_exported_material_gives_the_history(name: str) -> None:
    scene = replace(BODY, law=LawChoice(name, CASES[name]))
    law = laws.get(name).of(scene)
    history = simulate(law, scene, 1e-8).history
    end_time = 0.995 * float(history.time[-1])
    with contextlib.redirect_stderr(None):
        force = force_of(opensees.lines(law, scene, language="python"), scene.mass, scene.velocity, end_time)
    ours = history.force_at(end_time / STEPS * np.arange(1, STEPS + 1))
    assert np.linalg.norm(force - ours) < 1e-4 * np.linalg.norm(ours)


@pytest.mark.parametrize("name", ["ting", "correspondence"])
def test_the_stand_in_of_a_law_that_remembers_gives_its_own_history(name: str) -> None:
    """At the velocity where it was fitted and at others: what OpenSees runs is what the table is about."""
    scene = replace(Scene.load("polymer-sphere"), law=LawChoice("kelvin", {"gap": 0.0}))
    law = laws.get(name).of(scene)
    found = opensees.stand_in(law, scene)
    fitted = laws.get(found.law).of(found.scene)
    command = opensees.lines(fitted, found.scene, language="python")
    assert opensees.lines(law, scene, language="python").splitlines()[-1] == command.splitlines()[-1]
    for share in opensees.SHARES[::2]:
        history = simulate(fitted, replace(found.scene, velocity=share * scene.velocity), 1e-8).history
        end_time = 0.995 * float(history.time[-1])
        with contextlib.redirect_stderr(None):
            force = force_of(command, scene.mass, share * scene.velocity, end_time)
        ours = history.force_at(end_time / STEPS * np.arange(1, STEPS + 1))
        assert np.linalg.norm(force - ours) < 1e-4 * np.linalg.norm(ours)
