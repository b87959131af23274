"""What strikes a rigid plane with waves of its own: a block, a bar of line elements, or a ball, meshed whole.

A ball is in free flight before and after, its own waves stay in it.
"""

from __future__ import annotations

from fe_contact.budget.plan import SPRINGS, Plan
from fe_contact.settings import Given, WaveNumerics
from fe_contact.waves.balls import Ball, flying, plan_in_flight
from fe_contact.waves.moving import Flying
from fe_contact.waves.targets._block import BLOCK
from fe_contact.waves.targets.base import WaveTarget, check_balls
from lumped.laws import mdr
from lumped.scene.scene import Scene
from lumped.shapes._block import Block


def plan(scene: Scene, given: Given) -> Plan:
    """Choose what ``given`` (checked settings) leaves open for a ball; the far end is that of the ball.

    Raises NotReached where even the row of springs does not come to an end.
    """
    return plan_in_flight(scene, given, mdr.estimate(scene, SPRINGS), Ball.striking(scene).radius)


def moving(scene: Scene, numerics: WaveNumerics) -> Flying:
    """The ball of a scene whose target is rigid; it has the points."""
    ball = Ball.striking(scene)
    points = ball.points(numerics)
    return flying(scene, numerics, [ball.side(numerics, points[0])], points, (1.0,))


BALL = WaveTarget.meshed(check_balls, plan, lambda scene, numerics: [Ball.striking(scene).unit(numerics)], moving)


def _of(scene: Scene) -> WaveTarget:
    return BLOCK if isinstance(scene.geometry.shape, Block) else BALL


MEMBER = WaveTarget(
    check=lambda scene: _of(scene).check(scene),
    plan=lambda scene, given: _of(scene).plan(scene, given),
    cost=lambda scene, numerics: _of(scene).cost(scene, numerics),
    way=lambda scene, chosen, progress: _of(scene).way(scene, chosen, progress),
)
