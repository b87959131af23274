"""The error budget of an impact with inertia: the impact again with one setting varied at a time, by FE alone.

Mesh, penalty and time step are trusted with order one only: contact that begins and ends point by point leaves a
chatter which no order describes. The change between settings in the ratio 1 : 2 then bounds the error of the better one
by 1.25 times itself. The far field errs as the square of its distance, as without inertia: half as far, an echo comes
back within the contact.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property, partial

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.certify import MESH_ORDER, WITNESS, Budget, Causes, Several, factor, other_setting
from fe_contact.budget.change import UNORDERED, Change
from fe_contact.budget.curve import Curve
from fe_contact.budget.runs import TotalWork
from fe_contact.progress import Counted, uncounted
from fe_contact.steppers.march import March, Strike
from fe_contact.waves.bounces import Bounces, follow
from fe_contact.waves.moving import Moving
from fe_contact.waves.numerics import WaveNumerics
from fe_contact.waves.reading import curve_of, reading
from fe_contact.waves.steps import graded
from lumped.errors import NotReached
from lumped.scene.scene import Scene

ORDER = {"mesh": 1, "penalty": 1, "time_step": 1, "far_field": 2}
# along the contact radius: half of fewer may err alike by chance, and are hardly larger in the bulk
LEAST_NODES = 24.0


class WaveRuns:
    """Marches of one scene with different settings, each run once, and a count of what they cost.

    ``cheap``: steps of those in which another setting is varied, whose effect does not depend on the step.
    """

    def __init__(
        self, scene: Scene, strike: Strike, moving: Callable[[Scene, WaveNumerics], Moving], cheap: int
    ) -> None:
        self._scene, self._strike, self._moving, self.cheap = scene, strike, moving, cheap
        self._curves: dict[WaveNumerics, tuple[Curve, ...]] = {}
        self._runs: dict[WaveNumerics, tuple[Bounces, int]] = {}
        self.counted: Counted = uncounted  # told of every step, as the share of one on the largest body so far
        self._largest = 1

    def _count(self, unknowns: int, steps: float) -> None:
        self._largest = max(self._largest, unknowns)
        self.counted(steps * unknowns / self._largest)

    def follow(self, settings: WaveNumerics) -> Bounces:
        """One run; raises where it fails."""
        if settings not in self._runs:
            body = self._moving(self._scene, settings)
            counted = partial(self._count, body.body.size)
            followed = follow(body, self._scene, self._strike, settings, counted)
            self._runs[settings] = followed, body.body.size
            self._curves[settings] = tuple(curve_of(one.march, one.strike, settings) for one in followed.contacts)
        return self._runs[settings][0]

    def curve(self, number: int, settings: WaveNumerics) -> Curve | None:
        """A contact of one run, None where that fails or has fewer: its cause of error is then unknown."""
        if settings not in self._curves:
            try:
                self.follow(settings)
            except NotReached:
                self._curves[settings] = ()
        curves = self._curves[settings]
        return curves[number] if number < len(curves) else None

    @property
    def spent(self) -> float:
        """Unknowns times steps of all runs so far."""
        runs = self._runs.values()
        return float(sum(size * (run.steps + sum(one.march.work.steps for one in run.contacts)) for run, size in runs))

    def work(self) -> TotalWork:
        """What all runs cost together: a factorisation for every length of step, one back-substitution a step."""
        marches = [(one.march, settings) for settings, (run, _) in self._runs.items() for one in run.contacts]
        works, flights = [march.work for march, _ in marches], [run for run, _ in self._runs.values()]
        steps = sum(w.steps for w in works) + sum(run.steps for run in flights)
        return TotalWork(
            degrees_of_freedom=max(size for _, size in self._runs.values()),
            factorizations=sum(_lengths(*one) for one in marches) + sum(run.factorizations for run in flights),
            solves=steps,
            marches=len(works),
            steps=steps,
            contact_problems=sum(w.contact_problems for w in works),
            iterations=sum(w.iterations for w in works),
        )


def _lengths(march: March, settings: WaveNumerics) -> int:
    """How many lengths of step a march took."""
    end = float(march.time[-1])
    return 1 + sum(at < end for at in graded(settings)[1])


def certify(runs: WaveRuns, numerics: WaveNumerics) -> Several:
    """March with ``numerics`` and with each setting varied; raises where the march itself fails.

    The budget is that of the first contact, those of the ``later`` ones, judged from the same runs, stand in it.
    """
    followed = runs.follow(numerics)
    changes = [_judged(runs, number, numerics) for number in range(len(followed.contacts))]
    row = [
        Budget(curve_of(one.march, one.strike, numerics), one.march, change, runs.work())
        for one, change in zip(followed.contacts, changes, strict=True)
    ]
    return Several(row[0].curve, row[0].march, row[0].changes, row[0].work, followed, tuple(row[1:]))


def _judged(runs: WaveRuns, number: int, numerics: WaveNumerics) -> Mapping[str, Causes]:
    """What the settings change of one contact."""
    contact = runs.follow(numerics).contacts[number]
    cheap, changed = numerics.varied(steps=runs.cheap), partial(_changed, partial(runs.curve, number))
    (mesh, by_mesh), half = other_mesh(cheap), numerics.varied(steps=numerics.steps // 2)
    penalty, stiffer = other_setting(cheap, "penalty")
    coarse = min(cheap, mesh, key=_nodes)  # of what is far, coarse is fine
    far, farther = other_setting(coarse, "far_radius")
    return {
        "mesh": (changed(cheap, mesh, by_mesh), reading(contact.march, contact.strike, numerics)),
        "penalty": (changed(cheap, penalty, factor(ORDER["penalty"], stiffer)),),
        "time_step": (changed(numerics, half, factor(ORDER["time_step"], False)),),
        "far_field": (changed(coarse, far, factor(ORDER["far_field"], farther)),),
    }


def other_mesh(settings: WaveNumerics) -> tuple[WaveNumerics, float]:
    """Settings of the mesh that tell of this one, half as fine or at least twice, and error over change."""
    if settings.order not in MESH_ORDER:
        order = WITNESS * settings.order
        elements = max(settings.elements_per_contact, LEAST_NODES / order)
        return settings.varied(order=order, elements_per_contact=elements), UNORDERED
    elements, finer = settings.elements_per_contact, _nodes(settings) < LEAST_NODES
    other = max(2 * elements, LEAST_NODES / settings.order) if finer else elements / 2
    return settings.varied(elements_per_contact=other), factor(ORDER["mesh"], finer)


def _nodes(settings: WaveNumerics) -> float:
    """Along the contact radius."""
    return settings.elements_per_contact * settings.order


def _changed(
    curve: Callable[[WaveNumerics], Curve | None], first: WaveNumerics, second: WaveNumerics, trusted: float
) -> Change | None:
    """Change between settings, ``trusted`` so many times as the error of the first; None where either failed."""
    one, other = curve(first), curve(second)
    return None if one is None or other is None else Moved(one, other, trusted)


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
