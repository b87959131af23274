"""Deformable balls in flight at first touch: towards a rigid plane, a half-space with waves, or one another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.assembly.trace import hats
from fe_contact.settings import WaveNumerics
from fe_contact.waves import half_space_body
from fe_contact.waves.ball_body import Ball
from fe_contact.waves.half_space_body import BEYOND
from fe_contact.waves.moving import Flying
from fe_contact.waves.sides import WaveSide, together
from lumped.scene.scene import Scene
from lumped.shapes import Sphere
from lumped.targets.sphere import SphereTarget as Struck


def on_plane(scene: Scene, numerics: WaveNumerics) -> Flying:
    """The ball of a scene whose target is rigid; it has the points."""
    ball = ball_of(scene)
    places, weights = ball.points(numerics)
    return _moving(scene, numerics, [ball.side(numerics, places)], places, weights, (1.0,))


def on_half_space(scene: Scene, numerics: WaveNumerics) -> Flying:
    """The ball of a scene and the half-space, which has the points."""
    struck = half_space_body.moving(replace(scene, striker_material=None), numerics)
    sides = [ball_of(scene).side(numerics, struck.places), WaveSide.struck(struck.body)]
    weights = struck.body.pressing.weights
    return _moving(scene, numerics, sides, struck.places, weights, (1.0, 0.0), endless=struck.endless)


def on_ball(scene: Scene, numerics: WaveNumerics) -> Flying:
    """Two balls about their common centre of mass; the smaller one, whose surface ends first, has the points."""
    target, mass = scene.target, scene.target_mass
    assert isinstance(target, Struck)
    assert mass is not None
    balls = [ball_of(scene), Ball(target.radius, scene.geometry.material, mass)]
    places, weights = min(balls, key=lambda ball: ball.radius).points(numerics)
    sides = [ball.side(numerics, places) for ball in balls]
    shares = [scene.reduced_mass / ball.mass for ball in balls]
    return _moving(scene, numerics, sides, places, weights, shares)


def ball_of(scene: Scene) -> Ball:
    """The striker of a scene that has a material."""
    shape, material = scene.geometry.shape, scene.geometry.striking
    assert isinstance(shape, Sphere)
    assert material is not None
    return Ball(shape.radius, material, scene.mass)


def _moving(
    scene: Scene,
    numerics: WaveNumerics,
    sides: Sequence[WaveSide],
    places: Array,
    weights: Array,
    shares: Sequence[float],
    endless: bool = False,
) -> Flying:
    """The sides, the striker first, each with its share of the speed towards the others."""
    heights = np.minimum(-scene.target.overlap(scene.profile, places, 0.0), BEYOND * numerics.contact_radius)
    carriers = hats(places.size, numerics.order) if len(sides) > 1 else None
    start = [share * side.axial for share, side in zip(shares, sides, strict=True)]
    return Flying(
        together(sides, scene.gravity, weights, -heights, carriers),
        scene.velocity,
        places,
        endless,
        yielding=sides[0].size,
        start=np.concatenate(start),
        approach=np.concatenate([side.mean for side in sides]),
    )
