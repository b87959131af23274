"""Marches of one strike with different settings, each run once, and a count of what they cost."""

from __future__ import annotations

import math
from functools import partial
from typing import Generic

from fe_contact.assembly.forms import Array
from fe_contact.budget.budget import TotalWork
from fe_contact.budget.curve import Curve
from fe_contact.budget.plan import crowded, share_of_peak
from fe_contact.budget.variation import calmest, calmest_at_corners
from fe_contact.march.impact import march
from fe_contact.march.impacts import Followed, SurfaceBouncer, follow
from fe_contact.progress import Counted, uncounted
from fe_contact.settings import RANGES, AnyNumerics, Numerics
from fe_contact.steppers.flat_end import FlatEnd
from fe_contact.steppers.steps import Strike, Work
from fe_contact.steppers.struck import Deformable, Struck
from fe_contact.targets.base import struck
from lumped.errors import NotReached
from lumped.scene.geometry import Geometry

PILOT_STEPS = 24  # of a march that only places the steps of others
PLACED = 0.05  # share by which a contact may last longer, or less, than was expected
PLACINGS = 4  # marches of few steps that look for its end, where an estimate is out by an order


def operations(work: TotalWork, finest: Struck) -> float:
    """Leading terms of the arithmetic behind the counted work, as if all of it were on the finest mesh.

    N unknowns in the plane cost N^(3/2) a factorisation and N log2 N a back-substitution (George 1973,
    doi:10.1137/0710032); n surface unknowns n^3/3 a Newton iteration, which factorises them with sparse springs.
    """
    unknowns = float(work.degrees_of_freedom)
    inside = work.factorizations * unknowns**1.5 + work.solves * unknowns * math.log2(unknowns)
    zone = finest.operator.trace.shape[1] if isinstance(finest, Deformable) else 0
    return float(inside + work.iterations * zone**3 / 3)


class AnyRuns(Generic[AnyNumerics]):
    """Runs of one strike with different settings, their contacts as curves; each kind says how one is followed."""

    def __init__(self) -> None:
        self._curves: dict[AnyNumerics, tuple[Curve, ...]] = {}

    def follow(self, settings: AnyNumerics) -> Followed:
        """One run, whose curves are known then; raises where it fails."""
        raise NotImplementedError

    def curve(self, number: int, settings: AnyNumerics) -> Curve | None:
        """One contact of a run as a curve, None where it fails or has fewer: its cause of error is then unknown.

        Settings asked for again are not run again: the fewest steps serve every other variation as base.
        """
        if settings not in self._curves:
            try:
                self.follow(settings)
            except NotReached:
                self._curves[settings] = ()
        curves = self._curves[settings]
        return curves[number] if number < len(curves) else None


class Runs(AnyRuns[Numerics]):
    """Marches of a strike and of up to so many ``impacts`` in a row, with different settings, steps ``counted``."""

    def __init__(self, strike: Strike, geometry: Geometry, impacts: int, counted: Counted = uncounted) -> None:
        super().__init__()
        self._counted = counted
        self._strike, self._geometry, self._impacts = strike, geometry, impacts
        self._works: list[Work] = []
        self._radii: dict[int, list[Array]] = {}
        self._surfaces = set[Struck]()
        self._places: dict[int, dict[str, float]] = {}
        self._rippled: dict[Numerics, tuple[Curve, ...]] = {}
        self._at_corners: dict[tuple[int, Numerics], Curve] = {}

    @property
    def ripples(self) -> bool:
        """Whether forces ripple as the edge of a contact crosses elements, so that :meth:`curve_at_corners` tells."""
        return bool(self._rippled)

    def curve_at_corners(self, number: int, settings: Numerics) -> Curve | None:
        """The same as :meth:`curve`, read where the edge meets corners, or evened."""
        if self.curve(number, settings) is None:
            return None
        if (number, settings) not in self._at_corners:
            surface, rippled = self.surface(settings), self._rippled[settings][number]
            assert isinstance(surface, Deformable)
            corners = surface.corners(settings.contact_radius)
            self._at_corners[number, settings] = calmest_at_corners(rippled, corners)
        return self._at_corners[number, settings]

    @property
    def flat(self) -> bool:
        """Whether the striker has a flat end, beside whose rim contacts end, not at it."""
        shape = self._geometry.shape
        return shape.flat_radius > 0.0 and shape.fixed_radius is None

    def placed(self, settings: Numerics, few: int, fixed: bool = True) -> Numerics:
        """The settings for a contact as long, and as wide, as a march of ``few`` steps finds it; unless they are
        ``fixed``, with as many steps as the force takes that peaks as early as found there.

        Where it fails, or does not separate, what was expected stands.
        """
        expected = settings.peak_share
        for _ in range(PLACINGS):
            found = self.curve(0, settings.varied(steps=few))
            if found is None or not found.separated or abs(found.duration / settings.contact_time - 1.0) <= PLACED:
                break
            share = share_of_peak(found.quantities["peak_time"] or 0.0, found.duration)
            settings = settings.varied(contact_time=found.duration, peak_share=share)
        flat = any(isinstance(one, FlatEnd) for one in self._surfaces)  # a force may peak early and again later there
        if fixed or flat:
            return settings
        more = crowded(settings.peak_share) / crowded(expected)
        return settings.varied(steps=min(4 * math.ceil(more * settings.steps / 4), RANGES["steps"][1]))

    def follow(self, settings: Numerics) -> Followed:
        """One run, its contact radii expected to be those of the first with as many steps; raises where it fails."""
        surface, expected = self.surface(settings), self._radii.get(settings.steps, [])
        placed = partial(self._placed, settings, surface)
        bouncer = SurfaceBouncer(surface, placed, expected, self._counted)
        followed = follow(bouncer, self._strike, self._impacts)
        marches = [contact.march for contact in followed.contacts]
        self._works += [one.work for one in marches]
        self._radii.setdefault(settings.steps, [one.radius for one in marches])
        curves = tuple(Curve.of(contact.march, contact.strike) for contact in followed.contacts)
        if not (surface.follows_contact or isinstance(surface, FlatEnd) or self._strike.relaxation.is_elastic):
            self._rippled[settings], curves = curves, tuple(calmest(curve) for curve in curves)
        self._curves[settings] = curves
        return followed

    def surface(self, settings: Numerics) -> Struck:
        """What contact sees of the struck body."""
        self._counted(0.0)  # a word before what may take long
        surface = struck(self._geometry, settings)
        self._surfaces.add(surface)
        return surface

    def work(self, finest: Struck) -> TotalWork:
        """What all runs cost together."""
        surfaces = self._surfaces
        factorizations, solves = sum(one.factorizations for one in surfaces), sum(one.solves for one in surfaces)
        return TotalWork.of(self._works, finest.degrees_of_freedom, factorizations, solves)

    def _placed(self, settings: Numerics, surface: Struck, number: int, begun: Strike) -> Numerics:
        """Settings for one of the contacts: of a later one a march of few steps tells the finest run where to lie."""
        if number == 0:
            return settings
        if number not in self._places:
            self._places[number] = self._piloted(settings, surface, begun)
        return settings.varied(**self._places[number])

    def _piloted(self, settings: Numerics, surface: Struck, begun: Strike) -> dict[str, float]:
        """Contact time, s, at first as if slower ones lasted longer as elastic ones do, and when its force peaks."""
        elastic = partial(self._geometry.shape.hertz_impact, 1.0, 1.0)
        slower = elastic(begun.velocity).duration / elastic(self._strike.velocity).duration
        guess = {"contact_time": min(settings.contact_time * slower, begun.end_time)}
        try:
            pilot = march(begun, surface, settings.varied(steps=PILOT_STEPS, **guess))
        except NotReached:
            return guess
        peak_time = Curve.of(pilot, begun).quantities["peak_time"] or 0.0
        contact_time = float(pilot.time[-1]) if pilot.separated else max(2.0 * peak_time, guess["contact_time"])
        return {"contact_time": contact_time, "peak_share": share_of_peak(peak_time, contact_time)}
