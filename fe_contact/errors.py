"""Named failures of the finite-element floor, each with its cure."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from lumped.errors import BadInput, Fault, NotReached
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene
from lumped.schema.keys import Number, keys_of
from meshes.errors import GmshMissing, MeshError, MeshTooFine

FINENESS = "numerics.tolerance, numerics.elements_per_contact"


@contextmanager
def faults_of(scene: Scene | Indenter) -> Iterator[None]:
    """Inside, faults name the scene's file and its keys, whatever part or mesh refused a number. Raises BadInput."""
    with scene.addressed():
        try:
            yield
        except GmshMissing:  # no number's fault
            raise
        except MeshTooFine as refused:
            raise BadInput(Fault(scene.source, FINENESS, f"{refused}; cure: a larger tolerance")) from refused
        except MeshError as refused:
            raise BadInput(Fault(scene.source, _lengths(scene), str(refused))) from refused


def _lengths(scene: Scene | Indenter) -> str:
    """The keys of the body that is meshed; and the option that says how far it is pressed."""
    part, body = scene.target.owner, scene.target if scene.target.deformable else scene.shape
    numbers = (
        () if body is None else [name for name, key in keys_of(type(body)).items() if isinstance(key.kind, Number)]
    )
    asked = ["--depths"] if isinstance(scene, Indenter) else []
    return ", ".join([*asked, *(f"{part}.{key}" for key in numbers)]) or part


class ContactNotSettled(NotReached):
    """A contact problem did not converge, or its edge left the mesh at every scale; ``enforced``: what helps it."""

    def __init__(self, time: float, enforced: str) -> None:
        super().__init__(f"contact not found at t = {time:.6g} s", f"a higher numerics.steps, or {enforced}")


class FlowNotSettled(NotReached):
    """The plastic flow of a step was not found."""

    def __init__(self, time: float) -> None:
        cure = "raise numerics.steps, or a larger target.material.hardening_modulus"
        super().__init__(f"plastic flow not found at t = {time:.6g} s", cure)


class ContactLost(NotReached):
    """The step would end after separation: a march of small strains retries with a shorter one."""

    def __init__(self, time: float) -> None:
        super().__init__(f"no contact after t = {time:.6g} s", "raise numerics.steps")


class MemoryTooSmall(NotReached):
    """The contact grew beyond the radii on which the surface remembers, or off the fine mesh.

    An impact is planned again for a wider contact; where that does not help, it is too hard for what it strikes.
    """

    def __init__(self, radius: float) -> None:
        self.radius = radius
        cure = "a lower striker.velocity or striker.mass, or a stiffer material"
        super().__init__(f"contact radius {radius:.6g} m exceeds the planned one", cure)


class RatioNotKnown(NotReached):
    """A step so long, or so short, that the body was not condensed for the ratio of its shear to its bulk modulus."""

    def __init__(self, ratio: float, low: float, high: float) -> None:
        known = f"the body is known from {low:.3g} to {high:.3g}"
        short, long = ("another motion.end_time, or fewer", "an earlier motion.end_time, or more")
        cure = f"{short if ratio > high else long} numerics.steps"
        super().__init__(f"a step in which the shear modulus is {ratio:.3g} of the bulk modulus; {known}", cure)


class TooManySteps(NotReached):
    """The march used up its steps before the contact ended."""

    def __init__(self, steps: int, time: float) -> None:
        super().__init__(f"{steps} steps reached only t = {time:.6g} s", "an earlier motion.end_time")


class ContactTooBrief(NotReached):
    """The contact ended within so few steps that nothing can be read of it."""

    def __init__(self, steps: int, time: float) -> None:
        cure = "--method ting where it answers, more numerics.steps, or less viscosity"
        super().__init__(f"the contact was over after {steps} steps, at t = {time:.3g} s, sooner than expected", cure)


class IndentationNotSettled(NotReached):
    """The contact problem at one depth did not settle."""

    def __init__(self, depth: float, cure: str = "a lower numerics.penalty") -> None:
        super().__init__(f"contact at depth {depth:.3g} m did not settle", cure)


class ContactTooWide(NotReached):
    """The contact at one depth left the part of the mesh that is fine enough for it."""

    def __init__(self, depth: float) -> None:
        super().__init__(f"contact at depth {depth:.3g} m leaves the fine mesh", "smaller depths")


class BodyTooThin(NotReached):
    """The body is so thin beside the contacts to expect that no mesh of it can be afforded."""

    def __init__(self, width: float, thickness: float, most: float) -> None:
        reason = f"a fine mesh {width:.2g} m wide on a body {thickness:g} m thick"
        super().__init__(f"{reason}: accepted up to {most:g} times as wide", "smaller depths, or a thicker body")


class BodyTooFine(NotReached):
    """The elements asked for are so many that no answer can be afforded, in memory or in time."""

    def __init__(self, reason: str, accepted: str) -> None:
        keys = "lower numerics.elements_per_contact, numerics.order or numerics.far_radius, a larger tolerance"
        super().__init__(f"{reason}: {accepted}", f"{keys}, or a body thicker beside its contact")


class SolidTooLarge(NotReached):
    """A body in three dimensions whose factors would take too much memory."""

    def __init__(self, entries: int, most: int) -> None:
        reason = f"a body of {entries:.2g} matrix entries in three dimensions: accepted up to {most:.2g}"
        super().__init__(reason, "a shorter striker, or a body thicker beside its contact")


class WavesTooDear(NotReached):
    """An impact with waves that would take many minutes or gigabytes."""

    def __init__(self, cost: str, accepted: str) -> None:
        cure = "a larger tolerance, lower numerics.elements_per_contact or numerics.steps, fewer motion.impacts"
        super().__init__(f"{cost}: accepted up to {accepted}", cure)


class RodTooLong(NotReached):
    """The contact is so short beside the rod that no mesh of it can be afforded."""

    def __init__(self, transit: float, elements: int, most: int) -> None:
        reason = f"a rod that waves cross in {transit:.3g} s needs {elements} elements for so short a contact"
        cure = "a shorter one with an absorbing end, if no echo returns within the contact"
        super().__init__(f"{reason}: accepted up to {most}", cure)


class MotionUnbounded(NotReached):
    """A time integrator lost its stability."""

    def __init__(self, time: float) -> None:
        cure = "raise numerics.steps, or another numerics.scheme: staged, generalised_alpha"
        super().__init__(f"the motion grows without bound at t = {time:.6g} s", cure)


class WorkerLost(NotReached):
    """A process that measured rows of a study died."""

    def __init__(self) -> None:
        reason = "a process of the study was killed, as systems do for want of memory"
        super().__init__(
            reason, "free some, then the same command again (sweep: with --resume); rows measured are kept"
        )


class ExtraMissing(BadInput):
    """An option needs a package that is not installed; ``extra`` is the option's name, and that of what installs it."""

    def __init__(self, package: str, extra: str) -> None:
        super().__init__(Fault(f"--{extra}", "", f"{package} is missing; cure: pip install 'fe-contact[{extra}]'"))


@contextmanager
def import_of(extra: str) -> Iterator[None]:
    """Inside, a package is imported that only the option ``extra`` needs; raises ExtraMissing."""
    try:
        yield
    except ImportError as failure:
        raise ExtraMissing((failure.name or extra).partition(".")[0], extra) from None
