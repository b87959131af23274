"""Larger models: what the ledger estimates of an effect, beside the change that the larger model makes when it is run.

An estimate is a formula, made before anything is solved; whether it is large enough, only the larger model says.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from fe_contact.methods import settings
from fe_contact.studies import journal
from fe_contact.studies.files import Line, write_study
from fe_contact.studies.larger_models import MeasuredEffect, measure
from fe_contact.studies.validate import base
from fe_contact.studies.validate.base import Column, columns
from lumped.scene.scene import Scene
from lumped.scene.tables import load

SCHEMA = "fe-contact/validate-larger/1"
KEPT = "larger.jsonl"
FEW = ("polymer-plate", "polymer-prism", "rod-in-ring")  # one of a kind, each within seconds
SCENES = (*FEW, "paper-concrete", "polymer-layer", "polymer-layer-sliding", "steel-ball-sls")
MOST = 2  # look: places that a sentence names
Effects = Mapping[str, tuple[MeasuredEffect, ...]]  # by their scenes


def make(asked: base.Request) -> base.Made:
    """Every effect above the tolerance of some scenes, by the next larger model; rows are kept scene by scene."""
    calls = {name: partial(effects_of, name) for name in (FEW if asked.quick else SCENES)}
    found = journal.rows(asked.where / KEPT, calls, asked.progress, asked.jobs)
    section = base.Section((headline(found),), tuple(sentences(found)), (), (LISTING,))
    return base.Made(section, (partial(write, found),))


def effects_of(name: str) -> tuple[MeasuredEffect, ...]:
    """The effects of a packaged scene at its default tolerance. Raises BadInput, NotReached."""
    scene, table = load(Scene, name)
    return measure(scene, settings(table, None, scene.source))


def ratio(effect: MeasuredEffect) -> float | None:
    """What is measured over what is estimated; None where one of both is not known."""
    if effect.change is None or not effect.estimate:
        return None
    return abs(effect.change) / abs(effect.estimate)


def exceeds(effect: MeasuredEffect) -> bool:
    """Whether the change is certainly larger than its estimate."""
    return ratio(effect) is not None and abs(effect.change or 0.0) - (effect.error or 0.0) > abs(effect.estimate or 0.0)


def headline(found: Effects) -> base.Headline:
    """Whether the larger models change the peak force by no more than the ledger says."""
    ratios = [size for every in found.values() for one in every if (size := ratio(one)) is not None]
    if not ratios:
        return base.Headline(base.OPEN, "No larger model was run whose effect the ledger estimates.")
    beyond = [f"{scene}, {one.effect}" for scene, every in found.items() for one in every if exceeds(one)]
    said = (
        f"Larger models were run for {len(ratios)} effects: they change the peak force by {min(ratios):.2g} to "
        f"{max(ratios):.2g} times what the ledger says; by more: {base.named(beyond, MOST) or 'none'}."
    )
    return base.Headline(base.DIFFERS if beyond else base.HOLDS, said)


def sentences(found: Effects) -> list[str]:
    """Which effects no model here answers, and why."""
    return [
        f"{scene}: {one.effect} is not measured: {one.reason}"
        for scene, every in found.items()
        for one in every
        if one.reason
    ]


def _line(scene: str, one: MeasuredEffect) -> Line:
    """A row of larger.csv."""
    return {
        "scene": scene,
        "effect": one.effect,
        "key": one.setting,
        "estimate": one.estimate,
        "change": one.change,
        "change_error": one.error,
        "change_over_estimate": ratio(one),
        "reason": one.reason or None,
    }


def write(found: Effects, where: Path) -> None:
    """Write ``larger.csv`` and ``larger.json``."""
    lines: Sequence[Line] = [_line(scene, one) for scene, every in found.items() for one in every]
    header = ("scene", "effect", "key", "estimate", "change", "change_error", "change_over_estimate", "reason")
    write_study(where, "larger", {"schema": SCHEMA, "larger": lines}, {"larger": lines}, {"larger": header})


LISTING = base.Listing(
    "larger.csv",
    "Effects above the tolerance, estimated and measured, over the peak force",
    (
        *columns("scene", "effect"),
        Column("key", "selected by"),
        Column("estimate", "estimated"),
        Column("change", "measured", "change_error"),
        Column("change_over_estimate", "over estimate"),
    ),
)
MEMBER = base.ReportPart(
    rank=15,
    title="Larger models",
    question="Where a scene needs a larger model, does that model change the force as much as the ledger says?",
    command="fe-contact validate --sections larger",
    make=make,
    seconds=37,
    quick="most scenes",
)
