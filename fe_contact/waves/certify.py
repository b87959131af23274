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

from fe_contact.certify import SAFETY, Budget
from fe_contact.change import Change
from fe_contact.curve import Curve
from fe_contact.forms import Array
from fe_contact.march import March, Strike
from fe_contact.runs import TotalWork
from fe_contact.waves.impact import motion, record
from fe_contact.waves.moving import Moving
from fe_contact.waves.numerics import WaveNumerics
from fe_contact.waves.reading import curve_of, reading
from fe_contact.waves.steps import graded
from lumped.errors import NotReached
from lumped.scene import Scene

VARIED = {"mesh": "elements_per_contact", "penalty": "penalty", "far_field": "far_radius"}
ORDER = {"mesh": 1, "penalty": 1, "time_step": 1, "far_field": 2}
LEAST = {"elements_per_contact": 1.0, "penalty": 1.0, "far_radius": 2.0}


class Runs:
    """Marches of one scene with different settings, each run once, and a count of what they cost.

    ``cheap``: steps of those in which another setting is varied, whose effect does not depend on the step.
    """

    def __init__(
        self, scene: Scene, strike: Strike, moving: Callable[[Scene, WaveNumerics], Moving], cheap: int
    ) -> None:
        self._scene, self.strike, self._moving, self.cheap = scene, strike, moving, cheap
        self._curves: dict[WaveNumerics, Curve | None] = {}
        self._marches: dict[WaveNumerics, tuple[March, int]] = {}

    def march(self, settings: WaveNumerics) -> tuple[March, Curve]:
        """One run; raises where it fails."""
        if settings not in self._marches:
            body = self._moving(self._scene, settings)
            march = record(body, motion(body, self._scene, settings), self._scene)
            self._marches[settings] = march, body.body.size
            self._curves[settings] = curve_of(march, self.strike, settings)
        march, curve = self._marches[settings][0], self._curves[settings]
        assert curve is not None
        return march, curve

    def curve(self, settings: WaveNumerics) -> Curve | None:
        """One run as a curve, None where it fails: its cause of error is then unknown."""
        if settings not in self._curves:
            try:
                return self.march(settings)[1]
            except NotReached:
                self._curves[settings] = None
        return self._curves[settings]

    def work(self) -> TotalWork:
        """What all runs cost together: a factorisation for every length of step, one back-substitution a step."""
        works = [march.work for march, _ in self._marches.values()]
        return TotalWork(
            degrees_of_freedom=max(size for _, size in self._marches.values()),
            factorizations=sum(_lengths(march, settings) for settings, (march, _) in self._marches.items()),
            solves=sum(w.steps for w in works),
            marches=len(works),
            steps=sum(w.steps for w in works),
            contact_problems=sum(w.contact_problems for w in works),
            iterations=sum(w.iterations for w in works),
        )


def _lengths(march: March, settings: WaveNumerics) -> int:
    """How many lengths of step a march took."""
    end = float(march.time[-1])
    return 1 + sum(at < end for at in graded(settings)[1])


def certify(runs: Runs, numerics: WaveNumerics) -> Budget:
    """March with ``numerics`` and with each setting halved; raises where the march itself fails."""
    march, value = runs.march(numerics)
    cheap = numerics.varied(steps=runs.cheap)
    base, mesh = cheap, _halved(cheap, "mesh")
    changes = {
        "mesh": (_changed(runs, base, mesh, "mesh"), reading(march, runs.strike, numerics)),
        "penalty": (_changed(runs, base, _halved(cheap, "penalty"), "penalty"),),
        "time_step": (_changed(runs, numerics, numerics.varied(steps=numerics.steps // 2), "time_step"),),
        "far_field": (_changed(runs, mesh, _halved(mesh, "far_field"), "far_field"),),  # of what is far, coarse is fine
    }
    return Budget(value, march, changes, runs.work())


def _halved(settings: WaveNumerics, cause: str) -> WaveNumerics:
    key = VARIED[cause]
    return settings.varied(**{key: max(getattr(settings, key) / 2, LEAST[key])})


def _changed(runs: Runs, first: WaveNumerics, second: WaveNumerics, cause: str) -> Change | None:
    """Change between settings in the ratio 1 : 2, as an error of the first; None where either failed."""
    one, other = runs.curve(first), runs.curve(second)
    return None if one is None or other is None else Moved(one, other, SAFETY / (2 ** ORDER[cause] - 1))


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
