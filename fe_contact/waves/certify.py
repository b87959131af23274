"""The error budget of an impact with inertia: the impact again with one setting varied at a time, by FE alone.

Mesh, penalty and time step are trusted with order one only: contact that begins and ends point by point leaves a
chatter which no order describes. The change between settings in the ratio 1 : 2 then bounds the error of the better one
by SAFETY times itself. The far field errs as the square of its distance, as without inertia: half as far, an echo comes
back within the contact.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np

from fe_contact.certify import CAUSES, SAFETY, Budget
from fe_contact.change import Change
from fe_contact.curve import Curve
from fe_contact.forms import Array
from fe_contact.march import March, Strike
from fe_contact.numerics import Numerics
from fe_contact.runs import TotalWork
from fe_contact.waves.impact import motion, record
from fe_contact.waves.moving import Moving
from fe_contact.waves.numerics import WaveNumerics
from lumped.errors import NotReached
from lumped.scene import Scene

VARIED = {"mesh": "elements_per_contact", "penalty": "penalty", "far_field": "far_radius"}
ORDER = {"mesh": 1, "penalty": 1, "time_step": 1, "far_field": 2}
LEAST = {"elements_per_contact": 1.0, "penalty": 1.0, "far_radius": 2.0}


def certify(
    scene: Scene, strike: Strike, numerics: WaveNumerics, moving: Callable[[Scene, WaveNumerics], Moving]
) -> Budget:
    """March with ``numerics`` and with each setting halved; raises where the march itself fails."""
    runs = _Runs(scene, strike, moving)
    march, value = runs.march(numerics)
    cheap = numerics.varied(steps=numerics.steps // 2)
    base = runs.curve(cheap)
    changes = {"time_step": (_change(value, base, ORDER["time_step"]),)}
    for cause, key in VARIED.items():
        half = max(getattr(cheap, key) / 2, LEAST[key])
        changes[cause] = (_change(base, runs.curve(cheap.varied(**{key: half})), ORDER[cause]),)
    return Budget(value, march, {cause: changes[cause] for cause in CAUSES}, runs.work())


class _Runs:
    """Marches of one scene with different settings, and a count of what they cost."""

    def __init__(self, scene: Scene, strike: Strike, moving: Callable[[Scene, WaveNumerics], Moving]) -> None:
        self._scene, self._strike, self._moving = scene, strike, moving
        self._marches: list[tuple[March, int]] = []

    def march(self, settings: Numerics) -> tuple[March, Curve]:
        """One run; raises where it fails."""
        assert isinstance(settings, WaveNumerics)
        body = self._moving(self._scene, settings)
        march = record(body, motion(body, self._scene, settings), self._scene)
        self._marches.append((march, body.body.size))
        return march, Curve.of(march, self._strike)

    def curve(self, settings: Numerics) -> Curve | None:
        """One run as a curve, None where it fails: its cause of error is then unknown."""
        try:
            return self.march(settings)[1]
        except NotReached:
            return None

    def work(self) -> TotalWork:
        """What all runs cost together: one factorisation a march, one back-substitution a step."""
        works = [march.work for march, _ in self._marches]
        return TotalWork(
            degrees_of_freedom=max(size for _, size in self._marches),
            factorizations=len(works),
            solves=sum(w.steps for w in works),
            marches=len(works),
            steps=sum(w.steps for w in works),
            contact_problems=sum(w.contact_problems for w in works),
            iterations=sum(w.iterations for w in works),
        )


class Moved(Change):
    """A change of the motion at equal times, not at equal shares of the contact.

    What chatters at the end of a contact moves the time at which it ends, and hardly the speed after it.
    """

    @cached_property
    def velocity(self) -> float:
        """Largest change of the velocity late in the contact, m/s."""
        return float(np.abs(self._late(self.first)[1] - self._late(self.second)[1]).max())

    @cached_property
    def impulse(self) -> float:
        """The same of the impulse, N s."""
        return float(np.abs(self._late(self.first)[0] - self._late(self.second)[0]).max())

    def _late(self, curve: Curve) -> tuple[Array, Array]:
        """Impulse, N s, and velocity, m/s; what has separated presses no more."""
        time = np.minimum(self.first.dense_time[self.first.late :], curve.duration)
        impulse = curve.read(time).impulse
        return impulse, curve.velocity(time, impulse)


def _change(first: Curve | None, second: Curve | None, order: int) -> Change | None:
    return None if first is None or second is None else Moved(first, second, SAFETY / (2**order - 1))
