"""A free ball struck by a ball, both with waves: they fly apart with what stays in each of them."""

from __future__ import annotations

from dataclasses import replace

from fe_contact.budget.plan import Plan
from fe_contact.settings import Given, WaveNumerics
from fe_contact.waves.balls import Ball, flying, plan_in_flight
from fe_contact.waves.moving import Flying, UnitBody
from fe_contact.waves.targets.base import WaveTarget, check_balls
from lumped.laws import correspondence
from lumped.scene.scene import Scene
from lumped.targets.sphere import SphereTarget


def plan(scene: Scene, given: Given) -> Plan:
    """Choose what ``given`` (checked settings) leaves open; two half-spaces without inertia place mesh and steps.

    Raises NotReached where even that does not come to an end.
    """
    target, largest = scene.target, max(ball.radius for ball in _balls(scene))
    assert isinstance(target, SphereTarget)
    without = replace(scene, target=replace(target, support=None), model=replace(scene.model, inertia=False))
    return plan_in_flight(scene, given, correspondence.estimate(without), largest)


def moving(scene: Scene, numerics: WaveNumerics) -> Flying:
    """Two balls about their common centre of mass; the smaller one, whose surface ends first, has the points."""
    balls = _balls(scene)
    points = min(balls, key=lambda ball: ball.radius).points(numerics)
    sides = [ball.side(numerics, points[0]) for ball in balls]
    return flying(scene, numerics, sides, points, [scene.reduced_mass / ball.mass for ball in balls])


def _balls(scene: Scene) -> list[Ball]:
    target, mass = scene.target, scene.target_mass
    assert isinstance(target, SphereTarget)
    assert mass is not None
    return [Ball.striking(scene), Ball(target.radius, scene.geometry.material, mass)]


def units(scene: Scene, numerics: WaveNumerics) -> list[UnitBody]:
    """Both balls."""
    return [ball.unit(numerics) for ball in _balls(scene)]


MEMBER = WaveTarget.meshed(check_balls, plan, units, moving)
