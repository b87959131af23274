"""Export to OpenSees: names, order, signs and units of the arguments, and what is refused."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lumped import BadInput, Scene, laws, simulate
from lumped.fit import fit, opensees
from lumped.scene.tables import LawChoice
from lumped.solvers.point.bodies import Stage

BODY = Scene(None, mass=0.002, velocity=1.5)


def exported(name: str, scene: Scene = BODY, **values: Any) -> opensees.UniaxialMaterial:
    chosen = replace(scene, law=LawChoice(name, values))
    return opensees.material(laws.get(name).of(chosen), chosen)


@pytest.mark.parametrize(
    ("name", "values", "material", "arguments"),
    [
        ("linear_spring", {"k": 1e5}, "ViscoelasticGap", {"K": 1e5, "C": 0.0}),
        ("kelvin", {"k": 1e5, "c": 3.0}, "ViscoelasticGap", {"K": 1e5, "C": 3.0}),
        ("jankowski", {"k": 1e7, "xi": 0.3}, "JankowskiImpact", {"Kh": 1e7, "xi": 0.3, "Meff": 0.002, "n": 1.5}),
        ("mahmoud", {"k": 1e5, "xi": 0.3}, "JankowskiImpact", {"Kh": 1e5, "xi": 0.3, "Meff": 0.002, "n": 1.0}),
        ("hertz", {"k": 1e7, "alpha": 2.0}, "Hertzdamp", {"Kh": 1e7, "xiNorm": 0.0, "n": 2.0}),
        ("hertzdamp", {"k": 1e7, "xi": 0.4}, "Hertzdamp", {"Kh": 1e7, "xiNorm": 0.4, "n": 1.5}),
        ("hunt_crossley", {"k": 1e7, "chi": 0.4}, "Hertzdamp", {"Kh": 1e7, "xiNorm": 0.6, "n": 1.5}),
        ("khatiwada", {"k": 1e7, "c": 4e6}, "Hertzdamp", {"Kh": 1e7, "xiNorm": 0.6, "n": 1.5}),
        (
            "impact_bilinear",
            {"k1": 2e5, "k2": 5e4, "yield_depth": 2e-5},
            "ImpactMaterial",
            {"K1": 2e5, "K2": 5e4, "Delta_y": -2e-5},
        ),
    ],
)
def test_arguments_are_those_of_the_material(
    name: str, values: dict[str, float], material: str, arguments: dict[str, float]
) -> None:
    found = exported(name, gap=0.01, **values)
    assert found.name == material
    assert dict(found.arguments) == pytest.approx({**arguments, "gap": -0.01})


def test_the_mass_is_that_of_the_two_bodies() -> None:
    found = exported("jankowski", replace(BODY, target_mass=0.002), k=1e7, xi=0.3)
    assert found.arguments["Meff"] == pytest.approx(0.001)
    assert found.arguments["xi"] == pytest.approx(0.3)


def test_a_law_without_a_gap_gets_one_that_opensees_accepts() -> None:
    assert exported("hertz", k=1e7).arguments["gap"] == -opensees.LEAST_GAP


def hughes(found: opensees.UniaxialMaterial, depth: float, rate: float, speed: float) -> float:
    """The force that the source of OpenSees computes from its arguments."""
    a = found.arguments
    if found.name == "ViscoelasticGap":
        return a["K"] * depth + a["C"] * rate
    if found.name == "Hertzdamp":
        return (a["Kh"] + a["xiNorm"] * a["Kh"] / speed * rate) * depth ** a["n"]
    damper = 2.0 * a["xi"] * np.sqrt(a["Kh"] * depth ** (a["n"] - 1.0) * a["Meff"]) * rate
    return float(a["Kh"] * depth ** a["n"] + (damper if rate > 0.0 else 0.0))


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("kelvin", {"k": 1e5, "xi": 0.3}),
        ("jankowski", {"k": 1e7, "xi": 0.3, "alpha": 1.8}),
        ("mahmoud", {"k": 1e5, "xi": 0.3}),
        ("hertzdamp", {"k": 1e7, "xi": 0.4}),
        ("hunt_crossley", {"k": 1e7, "chi": 0.4, "alpha": 1.2}),
        ("khatiwada", {"k": 1e7, "c": 4e6}),
    ],
)
def test_the_material_has_the_force_of_the_law(name: str, values: dict[str, float]) -> None:
    scene = replace(BODY, law=LawChoice(name, values))
    law = laws.get(name).of(scene)
    found = opensees.material(law, scene)
    for depth, rate in ((1e-5, 1.2), (5e-5, 0.3), (3e-5, -0.8)):
        force = float(law.force(depth, rate, Stage(rate > 0.0, 6e-5, scene.velocity)))
        assert hughes(found, depth, rate, scene.velocity) == pytest.approx(force, rel=1e-12)


def test_lines_are_comments_and_one_command() -> None:
    scene = replace(BODY, law=LawChoice("jankowski", {"k": 1.25e7, "xi": 0.3, "gap": 0.01}))
    law = laws.get("jankowski").of(scene)
    *said, command = opensees.lines(law, scene, tag=7).splitlines()
    assert command == "uniaxialMaterial JankowskiImpact 7 12500000 0.3 0.002 -0.01 1.5"
    assert all(line.startswith("# ") for line in said)
    assert "tangent" in said[-1]
    python = opensees.lines(law, scene, tag=7, language="python").splitlines()[-1]
    assert python == 'ops.uniaxialMaterial("JankowskiImpact", 7, 12500000, 0.3, 0.002, -0.01, 1.5)'


def iterations(scene: Scene, law: str, step: float, most: int = 40) -> int:
    """The most that Newton's method takes in a step of the trapezoidal rule until the mass flies back; `most`: none.

    With the tangent that its sources have: the law's stiffness with the wrong sign, and none of its damping.
    """
    contact, mass = laws.get(law).of(scene), scene.reduced_mass
    depth, rate, push, worst = 0.0, scene.velocity, 0.0, 0
    while rate > 0.0 or depth > 0.0:
        new, past = depth, 4.0 * depth / step**2 + 4.0 * rate / step - push / mass
        for count in range(1, most + 1):
            worst = max(worst, count)
            speed = 2.0 * (new - depth) / step - rate
            stage = Stage(speed > 0.0, new, scene.velocity)
            force = float(contact.force(new, speed, stage)) if new > 0.0 else 0.0
            stiffness = contact.alpha * contact.k * max(new, 0.0) ** (contact.alpha - 1.0)
            change = (mass * (past - 4.0 * new / step**2) - force) / (4.0 * mass / step**2 - stiffness)
            new += change
            if abs(change) < 1e-9 * scene.velocity * step:
                break
        if worst == most:
            return most
        depth, rate, push = new, 2.0 * (new - depth) / step - rate, force
    return worst


@pytest.mark.parametrize("velocity", [0.1, 5.0])
@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("jankowski", {"k": 1e7, "xi": 0.2}),
        ("mahmoud", {"k": 1e5, "xi": 0.2}),
        ("hertz", {"k": 1e7, "alpha": 2.0}),
        ("hertzdamp", {"k": 1e7, "xi": 0.3}),
    ],
)
def test_newtons_method_converges_in_the_steps_that_are_told(
    name: str, values: dict[str, Any], velocity: float
) -> None:
    scene = replace(BODY, velocity=velocity, law=LawChoice(name, values))
    told = re.search(r"take steps below (\S+) s at", " ".join(exported(name, scene, **values).differences))
    assert told is not None
    assert iterations(scene, name, float(told[1])) <= 20
    assert iterations(scene, name, 4.0 * float(told[1])) == 40


def test_tension_at_the_end_is_told_where_the_law_has_none() -> None:
    assert any("pulls" in text for text in exported("kelvin", k=1e5, xi=0.2).differences)
    assert not any("pulls" in text for text in exported("kelvin", k=1e5, xi=0.2, exit="depth").differences)


def test_a_law_without_a_material_names_those_that_have_one() -> None:
    with pytest.raises(BadInput, match=r"tsuji has no OpenSees material; .*jankowski.*kelvin"):
        exported("tsuji", k=1e7, alpha_t=0.3)
    scene = replace(BODY, law=LawChoice("hertz", {"k": 1e7}))
    with pytest.raises(BadInput, match=re.escape("'apdl' is not accepted; accepted: tcl, python")):
        opensees.lines(laws.get("hertz").of(scene), scene, language="apdl")


def printed_peak(values: list[str], mass: float, velocity: float) -> tuple[float, float, float]:
    """Peak force, duration and restitution of an impact on Hertzdamp's line, integrated anew."""
    stiffness, damping, _, power = map(float, values)

    def force(y: np.ndarray) -> float:
        return float(stiffness * (1.0 + damping * y[1] / velocity) * max(y[0], 0.0) ** power)

    out = lambda t, y: y[0] + (0.0 if t else 1.0)  # noqa: E731 - read in place
    out.terminal, out.direction = True, -1  # type: ignore[attr-defined]
    run = solve_ivp(
        lambda t, y: [y[1], -force(y) / mass], (0.0, 1.0), [0.0, velocity], "DOP853", events=out, rtol=1e-11,
        atol=1e-15, dense_output=True,
    )  # fmt: skip
    end = float(run.t[-1])
    forces = [force(run.sol(time)) for time in np.linspace(0.0, end, 4001)]
    return max(forces), end, -float(run.y[1, -1]) / velocity


@pytest.mark.tenth
def test_a_law_that_remembers_has_a_stand_in_and_its_departures(monkeypatch: pytest.MonkeyPatch) -> None:
    """The line, integrated anew at every velocity against the exact impact, errs by what the table beside it says."""
    monkeypatch.setattr(opensees, "STAND_INS", {"hertzdamp": opensees.STAND_INS["hertzdamp"]})
    monkeypatch.setattr(opensees, "SHARES", opensees.SHARES[::2])
    scene = replace(Scene.load("polymer-sphere"), law=LawChoice("kelvin", {"gap": 0.004}))
    *said, command = opensees.lines(laws.get("ting").of(scene), scene).splitlines()
    name, tag, *values = command.split()[1:]
    assert (name, tag, values[2]) == ("Hertzdamp", "1", "-0.004")
    table = [line[1:].replace(" %", "").split() for line in said if re.match(r"# +\d", line)]
    assert len(table) == len(opensees.SHARES)
    for velocity, *cells in (map(float, row) for row in table):
        exact = simulate(laws.get("ting").of(scene), replace(scene, velocity=velocity), 1e-7).quantities
        peak, duration, restitution = printed_peak(values, scene.mass, velocity)
        for cell, ours, quantity in ((cells[0], peak, "peak_force"), (cells[2], duration, "duration")):
            assert cell == pytest.approx(100.0 * (ours / (exact[quantity].value or 0.0) - 1.0), abs=0.006)
        assert cells[3] == pytest.approx(restitution - (exact["restitution"].value or 0.0), abs=6e-4)


@pytest.mark.tenth
def test_an_elastic_impact_is_stood_in_for_by_its_own_spring() -> None:
    """Hertz's, at every velocity; and no law of OpenSees that is fitted alone comes nearer."""
    scene = Scene.load("steel-ball")
    law = laws.get("correspondence").of(scene)
    found = opensees.stand_in(law, scene)
    assert found.normalized_error < 1e-4
    assert found.values["alpha"] == pytest.approx(1.5, abs=1e-3)
    told = opensees.departures(law, scene, found)
    assert all(abs(value or 0.0) < 1e-3 for values in told.values() for value in values.values())
    history = simulate(law, scene).history
    assert all(found.normalized_error <= fit(history, name, scene).normalized_error for name in ("kelvin", "hertz"))
