"""A deformable ball in flight at first touch: towards a rigid plane, or towards a target with waves of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fe_contact.forms import Array
from fe_contact.waves import half_space_body
from fe_contact.waves.ball_body import Ball
from fe_contact.waves.half_space_body import BEYOND
from fe_contact.waves.moving import Flying, Moving
from fe_contact.waves.numerics import WaveNumerics
from fe_contact.waves.sides import Side, together
from lumped.scene import Scene
from lumped.shapes import Sphere


def on_plane(scene: Scene, numerics: WaveNumerics) -> Moving:
    """The ball of a scene whose target is rigid; it has the points."""
    ball = ball_of(scene)
    places, weights = ball.points(numerics)
    return _moving(scene, numerics, [ball.side(numerics, places)], places, weights, endless=False)


def on_half_space(scene: Scene, numerics: WaveNumerics) -> Moving:
    """The ball of a scene and the half-space, which has the points."""
    struck = half_space_body.moving(replace(scene, striker_material=None), numerics)
    places, sides = struck.places, [ball_of(scene).side(numerics, struck.places), Side.struck(struck.body)]
    return _moving(scene, numerics, sides, places, struck.body.pressing.weights, struck.endless)


def ball_of(scene: Scene) -> Ball:
    """The striker of a scene that has a material."""
    shape, material = scene.geometry.shape, scene.geometry.striking
    assert isinstance(shape, Sphere)
    assert material is not None
    return Ball(shape.radius, material, scene.mass)


def _moving(
    scene: Scene, numerics: WaveNumerics, sides: Sequence[Side], places: Array, weights: Array, endless: bool
) -> Flying:
    """The first side flies towards the others, which rest."""
    heights = np.minimum(scene.profile.height(places), BEYOND * numerics.contact_radius)
    body = together(sides, scene.gravity, weights, -heights)
    flying = sides[0]
    rest = np.zeros(body.size - flying.size)
    axial = np.append(flying.axial, rest)
    return Flying(
        body,
        scene.velocity,
        places,
        endless,
        axial=axial,
        across=np.append(1.0 - flying.axial, rest),
        mean=np.append(flying.mean, rest),
    )
