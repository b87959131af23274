"""The error budget: the impact again with one setting varied at a time, by finite elements alone.

Time steps in the ratio 1 : 2 : 4 give a value (extrapolated from the two finest) and its change from the pair before.
Mesh and penalty are varied on the coarsest of them, where a march is cheapest: what they change hardly depends on the
step, unless they are coarse themselves, or the mesh stays while the contact's edge crosses it. The far field of an
elastic body on a mesh that follows the contact takes no march, unless further contacts follow, each of which is judged
like the first from the same runs. A change between settings in the ratio 1 : 2 bounds the error by

    SAFETY / (2^order - 1) x change ,

with the lowest order that theory or the scheme promises, not the higher one that is usually seen (Roache's
grid convergence index, doi:10.1115/1.2910291). Elements of order one and two promise none: where a material is nearly
incompressible they lock, and two meshes of them err alike by far more than they differ. Elements of twice the order on
the same mesh err by less than half as much, so that twice the distance between both bounds the error.

Extrapolation leaves the order after the scheme's own, if the three step lengths show that order; where they do not,
order one is all that is trusted. What extrapolation does not cure but make larger, the jitter of a viscous contact's
force, shows when every other step is left out. It counts with the steps where it falls with them, as at the touch of a
dashpot; else mesh and rounding leave it.

The order to trust after extrapolation is one more than the scheme's own where nothing speaks against it. What adds up
over the contact loses an order to any relaxation. A dashpot's force is one of velocities, and so is that of a branch
which relaxes within two steps: its extrapolated error falls no faster than the scheme's. The order of all forces
is less by the share of the force that such branches and dashpots carry, and so is that of impulse and velocity.

A relaxation about as long as a step gives the scheme's order one coefficient for longer steps and another for
shorter ones, so that extrapolation gains no order. By chance it may even agree with itself where it is wrong: of what
the steps change before it, the share that such branches carry is kept as an error too.

The force of a viscous contact has a kink where its edge turns, anywhere in a step: that leaves an error of order two
with a coefficient of its own for every length of step. What a scheme of order one gains by extrapolation is lost in it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from fe_contact.budget.budget import SETTING, Causes
from fe_contact.budget.curve import FEWEST_ROWS, Curve, extrapolated
from fe_contact.budget.runs import Runs
from fe_contact.budget.several import Judged, Several
from fe_contact.budget.variation import SAFETY, UNORDERED, Softening, Variation, compliance_change, factor
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.errors import ContactTooBrief
from fe_contact.progress import Count, Progress, silent
from fe_contact.schemes.base import SCHEMES
from fe_contact.settings import AnyNumerics, Numerics
from fe_contact.steppers.flat_end import FlatEnd
from fe_contact.steppers.steps import Strike
from fe_contact.steppers.struck import Deformable, Struck
from lumped.result.result import largest_bar, meets
from lumped.scene.geometry import Geometry

MARCHES = 2.5  # steps of all marches of a contact over those of the finest one: half and a quarter, and three of these
UNSEEN = 2  # first steps of the coarsest run in which no order shows
LEAST_ORDER = {"penalty": 1, "far_field": 2}  # of convergence that is trusted without being seen, by cause
MESH_ORDER = {3: 1, 4: 2}  # by element order: the edge allows three in the force, locking takes from it
WITNESS = 2  # times the order have the elements that tell of those which lock
WITNESS_ELEMENTS = 4.0  # of them along the contact radius, at least
MESH_ORDER_ANYWHERE = 1.5  # where the edge falls anywhere in an element: the pressure has a root there
NEAR_ANYWHERE = 0.6  # of the largest depth: down to it the edge passes half an element, and a chance agreement shows
# what a mesh that stays changes weighs so much by a dashpot: its force jitters, which hides in what adds up
DAMPED_ANYWHERE = {"duration": 8.0, "restitution": 3.0, "impulse": 3.0, "peak_depth": 6.0}
# the same of exact enforcement, whose contact grows and shrinks by whole nodes
NODEWISE_ANYWHERE = {**DAMPED_ANYWHERE, "peak_depth": 2.0}
DAMPED_SINCE = 0.5  # share of the contact from which path and speed count there: the end alone may agree by chance
# of the steps' change in the share that branches about as fast as a step carry, by quantity, and of the force
KEPT = {"peak_depth": 0.4, "duration": 0.4, "impulse": 2.5, "restitution": 2.5}
KEPT_OF_FORCE = 0.1  # the same share of the force
LEAST_HALVED = 40  # steps below which halving them twice would leave too few to tell anything
# half of less tells nothing: a corrected penalty below a hundred errs to either side in turn
LEAST_HALVED_SETTING = {"elements_per_contact": 2.0, "penalty": 200.0, "far_radius": 5.0}
ROWS_ORDER = 3  # of the five that forces between the rows of a curve have, where half and a quarter of them show it
PEAKS = ("peak_force", "peak_time", "peak_depth")  # which lie between rows
FALLS = 0.7  # share of a jitter which half the step leaves, if the step is its cause
MOST_APART = 1.5  # durations by different steps that tell of one and the same end
ROUNDING = 1e-9  # of a solve of nearly incompressible bodies
AS_EXPECTED = (0.8, 1.35)  # shares of the expected ratio of changes that show the order, 1.7 to 2.4 where it is two
ABOUT = (0.6, 2.5)  # the same that show it about: extrapolation gains no order that could be relied on
ASYMPTOTIC = 1e-2  # of duration and first speed: so much the fewest steps may err where orders are to be believed
NEARLY = 0.8  # share of the expected ratio that the durations must show: they stand for themselves alone
ABOUT_A_STEP = (0.4, 9.0)  # step over relaxation time: outside, its weight in the step is within 1/8 of a power of it

Read = Callable[[int, Numerics], Curve | None]  # one contact of a run


@dataclass(frozen=True)
class Certified(Several):
    """The same with the ``surface`` of the finest run; its settings are placed where the contact turned out to be."""

    surface: Struck


def certify(
    strike: Strike,
    geometry: Geometry,
    numerics: Numerics,
    impacts: int = 1,
    progress: Progress = silent,
    fixed: bool = True,
) -> Certified:
    """March with ``numerics`` and with each setting varied; raises where the march itself fails, and
    ContactTooBrief.

    ``fixed``: whether as many steps are taken as ``numerics`` says, whatever the first coarse march finds.

    Up to so many ``impacts``: the budget is that of the first, those of the ``later`` ones stand in it. Where forces
    ripple and bars miss the tolerance, the runs are judged again as edges meet corners; the narrower bars stand.
    """
    message = f"{numerics.steps} steps, {numerics.elements_per_contact:g} elements along the contact radius"
    runs = Runs(strike, geometry, impacts, Count.of(progress, message, MARCHES * impacts * numerics.steps))
    few = numerics.steps // 4 if numerics.steps >= LEAST_HALVED else numerics.steps
    numerics = runs.placed(numerics, few, fixed)
    followed, surface = runs.follow(numerics), runs.surface(numerics)
    first = followed.contacts[0].march
    if len(first.time) < FEWEST_ROWS:
        raise ContactTooBrief(len(first.time) - 1, float(first.time[-1]))

    def found(read: Read) -> Certified:
        judged = [_judged(runs, read, number, numerics, impacts == 1) for number in range(len(followed.contacts))]
        return Certified.judged(followed, judged, runs.work(surface), numerics, surface=surface)

    plain = found(runs.curve)
    if not runs.ripples or all(meets(part, numerics.tolerance) for part in plain.parts):
        return plain
    return min((plain, found(runs.curve_at_corners)), key=lambda one: max(largest_bar(part) for part in one.parts))


def _judged(runs: Runs, read: Read, number: int, numerics: Numerics, alone: bool) -> Judged:
    """One contact of all runs, each ``read`` as a curve, where it is ``alone`` with the fewest marches."""
    curve = partial(read, number)
    surface = runs.surface(numerics)
    steps = _time_steps(curve, numerics, isinstance(surface, FlatEnd))
    steps = replace(steps, value=steps.value.with_peak_spread())
    if alone and isinstance(surface, FlatEnd):
        held = _by_stiffness(runs, steps.value, surface, numerics)
        return steps.value, held | {"time_step": (*steps.changes, *steps.jitter)}
    cheap = numerics.varied(steps=steps.cheap)
    damped = DAMPED_ANYWHERE if steps.value.strike.relaxation.viscosity > 0.0 else {}
    nodewise = ENFORCEMENTS.get(numerics.enforcement).nodewise
    weights = NODEWISE_ANYWHERE if nodewise else damped
    beside_flat = nodewise and runs.flat
    mesh, by_mesh = _by_mesh(curve, numerics, cheap, surface.follows_contact and not beside_flat, weights)
    pressed = _judging(numerics, cheap, "penalty")
    penalty, stiffer = other_setting(pressed, "penalty")
    swings = not steps.value.separated and steps.value.strike.gravity > 0.0  # between few steps, if it does so for long
    by_steps = swings or steps.jitter_falls
    rounded = (Softening(steps.value, ROUNDING),) if isinstance(surface, FlatEnd) else ()
    changes: dict[str, Causes] = {
        "mesh": (by_mesh, *rounded, *(() if by_steps else steps.jitter)),
        "penalty": (Variation.between(curve(pressed), curve(penalty), factor(LEAST_ORDER["penalty"], stiffer)),),
        "time_step": (*steps.changes, *(steps.jitter if by_steps else ())),
        "far_field": _far_field(runs, curve, steps.value, cheap, mesh, alone),
    }
    return steps.value, changes


def _by_mesh(
    curve: Callable[[Numerics], Curve | None],
    numerics: Numerics,
    cheap: Numerics,
    follows_contact: bool,
    weights: Mapping[str, float],
) -> tuple[Numerics, Variation | None]:
    """Settings of another mesh, and what it changes; ``weights`` of one that stays, where the force jitters."""
    meshed = _judging(numerics, cheap, "mesh", not follows_contact)
    mesh, trusted = other_mesh(meshed) if follows_contact else other_mesh(meshed, MESH_ORDER_ANYWHERE)
    change = partial(Variation.between, curve(meshed), curve(mesh), trusted)
    if follows_contact:
        return mesh, change()
    jittery = {"weights": weights, "since": DAMPED_SINCE} if weights else {}
    return mesh, change(unresolved=np.inf, near=NEAR_ANYWHERE, creeps=weights is DAMPED_ANYWHERE, **jittery)


def _judging(numerics: Numerics, cheap: Numerics, cause: str, stays: bool = False) -> Numerics:
    """Settings of which one is varied: with few steps, but where its half would tell nothing with all of them.

    A soft penalty is the softer the shorter the step, in which a dashpot is stiff; what a coarse mesh changes, few
    steps may hide, and what any mesh does that ``stays``: an edge passes few of its nodes between them.
    """
    key = SETTING[cause]
    coarse = getattr(numerics, key) < LEAST_HALVED_SETTING[key]
    return numerics.varied(steps=max(numerics.steps, cheap.steps)) if coarse or stays else cheap


def _by_stiffness(runs: Runs, value: Curve, end: FlatEnd, numerics: Numerics) -> dict[str, Causes]:
    """What the other causes change of the one stiffness under a flat end, without a march."""
    others = {"mesh": other_mesh(numerics, end.mesh_order)}
    for cause, order in LEAST_ORDER.items():
        settings, finer = other_setting(numerics, SETTING[cause])
        others[cause] = settings, factor(order, finer)
    found: dict[str, Causes] = {}
    for cause, (settings, trusted) in others.items():
        other = runs.surface(settings)
        assert isinstance(other, FlatEnd)
        share = trusted * abs(other.stiffness / end.stiffness - 1.0)
        found[cause] = (Softening(value, share + ROUNDING),)
    return found


def _far_field(
    runs: Runs, curve: Callable[[Numerics], Curve | None], value: Curve, cheap: Numerics, mesh: Numerics, alone: bool
) -> Causes:
    """By one press of either surface where an elastic one follows one contact; else by a march more, on the
    varied mesh: beside a small contact the far field changes what a surface remembers by more than it does the contact.

    Bodies that end have none.
    """
    order = LEAST_ORDER["far_field"]
    far, farther = other_setting(cheap, "far_radius")
    surface, varied = runs.surface(cheap), mesh.varied(far_radius=far.far_radius)
    if alone and surface.follows_contact and value.strike.relaxation.is_elastic and not farther:
        other = runs.surface(far)
        assert isinstance(surface, Deformable)
        assert isinstance(other, Deformable)
        return (Softening(value, factor(order, farther) * compliance_change(surface, other)),)
    if runs.surface(varied) is runs.surface(mesh):
        return ()
    return (Variation.between(curve(mesh), curve(varied), factor(order, farther)),)


@dataclass(frozen=True)
class _TimeSteps:
    """What the variation of the step length yields: value, what changes it, jitter, steps for other variations.

    ``jitter_falls``: with the step, which then is its cause.
    """

    value: Curve
    changes: Causes
    jitter: tuple[Variation, ...]
    cheap: int
    jitter_falls: bool = False


def _time_steps(curve: Callable[[Numerics], Curve | None], numerics: Numerics, flat: bool) -> _TimeSteps:
    """Halve the number of steps twice and extrapolate; double it twice where it is too small for that.

    Under a ``flat`` end the first steps count as much as any: its area presses at once.
    """
    order, fine = SCHEMES.get(numerics.scheme).order, curve(numerics)
    assert fine is not None
    if numerics.steps < LEAST_HALVED:
        double = curve(numerics.varied(steps=2 * numerics.steps))
        fourfold = curve(numerics.varied(steps=4 * numerics.steps))
        if double is None or fourfold is None or not _end_alike(fourfold, double):
            return _TimeSteps(fine, (None,), (), numerics.steps)
        best, before = extrapolated(fourfold, double, order), extrapolated(double, fine, order)
        jitter = Variation(best, before, SAFETY)
        return _TimeSteps(fine, (Variation(fine, best, SAFETY),), (jitter,), 4 * numerics.steps, True)
    half = curve(numerics.varied(steps=numerics.steps // 2))
    quarter = curve(numerics.varied(steps=numerics.steps // 4))
    if half is None or quarter is None or not _end_alike(fine, half, quarter):
        return _TimeSteps(fine, (None,), (), numerics.steps)
    value, before = extrapolated(fine, half, order), extrapolated(half, quarter, order)
    taken = fine.duration * np.diff(fine.x**2)[: numerics.steps]  # those beyond grow while a weight comes to rest
    shortest = float(taken[0]) if flat else numerics.contact_time / numerics.steps
    trusted = trust((fine, half, quarter), order, (shortest, float(taken.max())), flat)
    if flat and trusted.orders["force"] == 1:  # steps as long as a relaxation show no order: the finest run stands
        jitter = Variation(fine, fine.thinned(), 1.0)
        return _TimeSteps(fine, (Variation(fine, half, UNORDERED),), (jitter,), numerics.steps // 4, True)
    least = SAFETY / (2 ** trusted.orders["force"] - 1)
    weights = {name: SAFETY / (2**one - 1) / least for name, one in trusted.orders.items()}
    change = Variation(value, before, least, weights, quarter.duration * float(quarter.x[UNSEEN]) ** 2)
    shares = {name: share / KEPT_OF_FORCE for name, share in KEPT.items()}
    kept = Variation(fine, half, KEPT_OF_FORCE * trusted.kept, shares)
    jitter, finer, coarser = (Variation(one, one.thinned(), 1.0) for one in (value, fine, half))  # its own is largest
    jitter = replace(jitter, weights=_rows(jitter))
    falls = finer.history < FALLS * coarser.history
    changes = (change, kept) if trusted.kept else (change,)
    return _TimeSteps(value, changes, (jitter,), numerics.steps // 4, falls)


def _rows(jitter: Variation) -> dict[str, float]:
    """What a change to every other row weighs, by peak: where nothing jitters it is what lies between the rows.

    A quarter of the rows shows that: in a force that jitters the change does not grow with their distance.
    """
    if not jitter.first.separated:  # at a cut-off no later step evens it out
        return {"peak_force": UNORDERED}
    half, ordered = jitter.second, 2**ROWS_ORDER
    quarter = Variation(half, half.thinned(), 1.0)
    if quarter.history < ordered * jitter.history:
        return {}
    shown = [name for name in PEAKS if quarter.errors[name] >= ordered * jitter.errors[name]]
    return dict.fromkeys(shown, SAFETY / (ordered - 1))


def _end_alike(*curves: Curve) -> bool:
    """Whether none separates or all do, and at one time: too long a step misses a graze under gravity, not the next."""
    durations = [curve.duration for curve in curves]
    return len({curve.separated for curve in curves}) == 1 and max(durations) <= MOST_APART * min(durations)


def other_setting(numerics: AnyNumerics, key: str, least: float | None = None) -> tuple[AnyNumerics, bool]:
    """One setting halved; where half of it would tell nothing, at least doubled, until it would, and True.

    ``least`` that may be halved, None: as without waves.
    """
    value, least = getattr(numerics, key), LEAST_HALVED_SETTING[key] if least is None else least
    finer = value < least
    changed: Any = {key: max(2 * value, least) if finer else value / 2}
    return replace(numerics, **changed), finer


def other_mesh(numerics: AnyNumerics, most: float = np.inf, nodes: float | None = None) -> tuple[AnyNumerics, float]:
    """Settings of the mesh that tells of this one, and error over change, by an order of ``most`` at most.

    Where half as fine a mesh would tell nothing it is at least twice as fine: of fewer ``nodes`` along the contact
    radius than so many, None: of fewer elements than without waves.
    """
    order = numerics.order
    if order not in MESH_ORDER:
        least = WITNESS_ELEMENTS if nodes is None else nodes / (WITNESS * order)
        elements = max(numerics.elements_per_contact, least)
        return numerics.varied(order=WITNESS * order, elements_per_contact=elements), UNORDERED
    other, finer = other_setting(numerics, "elements_per_contact", None if nodes is None else nodes / order)
    return other, factor(min(MESH_ORDER[order], most), finer)


@dataclass(frozen=True)
class Trust:
    """Orders of the extrapolated force and of the quantities that deserve less trust; ``kept``: share of the finest
    steps' own change that extrapolation may leave.
    """

    orders: dict[str, float]
    kept: float


def trust(curves: tuple[Curve, Curve, Curve], order: int, steps: tuple[float, float], flat: bool) -> Trust:
    """What three runs show, and what the relaxation lets be expected.

    Parameters
    ----------
    curves : with steps in the ratio 4 : 2 : 1.
    order : the scheme's own.
    steps : the shortest and the longest that count, s.
    flat : whether the area presses at once, so that all steps feel a relaxation, else the few that are as long.
    """
    relaxation = curves[0].strike.relaxation
    force: float = _trusted_order(*curves, order)
    if order == 1 and not flat and not relaxation.is_elastic:
        force = order
    duration, restitution = _order_of_duration(*curves, order), _order_of_restitution(*curves, order)
    shortest, longest = np.divide.outer(steps, relaxation.times)
    within_step = bool(np.any((longest > ABOUT_A_STEP[0]) & (shortest < ABOUT_A_STEP[1])))
    fast, dashpots = _shares(curves[0], 2.0 * longest > ABOUT_A_STEP[0])
    if within_step:
        summed = order - dashpots if force > order else 1
        force = 1 if flat else min(force, order)
    else:
        summed = force if relaxation.is_elastic else min(force, order - dashpots - fast)
    force = min(force, order + 1 - dashpots - fast)
    given = min(summed, restitution)  # the impulse is what the velocity changes by
    orders = {"impulse": given, "restitution": given, "peak_depth": summed, "duration": min(force, duration)}
    return Trust({"force": force} | orders, fast if within_step else 0.0)


def _trusted_order(fine: Curve, half: Curve, quarter: Curve, order: int) -> int:
    """Order left after extrapolation: one more than the scheme's if three step lengths show the scheme's own.

    The velocity is asked, since the force of a viscous contact may jitter by more than the steps change it. Where two
    orders cancel each other its changes may differ in sign.
    """
    least = Variation(fine, half, 1.0).signed_velocity or np.finfo(float).tiny
    seen = Variation(half, quarter, 1.0).signed_velocity / least
    share = seen / 2**order
    if AS_EXPECTED[0] <= share <= AS_EXPECTED[1]:
        return order + 1
    return order if ABOUT[0] <= share <= ABOUT[1] else 1


def _order_of_duration(fine: Curve, half: Curve, quarter: Curve, order: int) -> int:
    """Order to trust of the duration: one more than it shows; where the fewest steps err by a per cent, no more."""
    first, second, third = (curve.quantities["duration"] for curve in (fine, half, quarter))
    if first is None or second is None or third is None:
        return order + 1
    return _shown(first, second, third, order) + (abs(third - second) <= ASYMPTOTIC * first)


def _order_of_restitution(fine: Curve, half: Curve, quarter: Curve, order: int) -> int:
    """The same of the restitution, which is the root of an energy: of a striker that a weight hardly lets go, few steps
    say little.
    """
    first, second, third = (curve.quantities["restitution"] for curve in (fine, half, quarter))
    if first is None or second is None or third is None or abs(third - second) <= ASYMPTOTIC:
        return order + 1
    return _shown(first, second, third, order)


def _shown(first: float, second: float, third: float, order: int) -> int:
    """The order where three values, with steps in the ratio 1 : 2 : 4, show nearly as much or more, else the first."""
    return order if abs(third - second) >= NEARLY * 2**order * abs(second - first) else 1


def _shares(curve: Curve, fast: npt.NDArray[np.bool_]) -> tuple[float, float]:
    """Shares of the force, each over the contact, that ``fast`` branches (k,) carry, and that dashpots do."""
    relaxation = curve.strike.relaxation
    moduli, times = np.array(relaxation.moduli), np.array(relaxation.times)
    viscous = np.array([float(moduli[fast] @ times[fast]), relaxation.viscosity])
    elastic = (relaxation.equilibrium + float(moduli[~fast].sum())) * curve.duration
    first, second = viscous / (viscous.sum() + elastic) if viscous.any() else viscous
    return float(first), float(second)
