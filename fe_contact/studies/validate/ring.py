"""Rings pressed and struck, against the paper's (27)-(32)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import partial

from fe_contact.studies.rings import RingCurve, RingStruck, cases, missed, rings, struck, verdict, write_rings
from fe_contact.studies.validate import base
from fe_contact.studies.validate.base import Column

DEPTHS = {"holds": "at all depths", "holds at one depth": "at one depth alone", "wrong": "at no depth"}  # by verdict
FIGURES = (
    base.Figure("ring", "Force over the paper's row, and the local exponent, over depth", ("ring.csv",)),
    base.Figure("fig12", "Figure 12 again: the paper's ring struck", ("fig12.csv", "ring_impacts.csv")),
)
LISTINGS = (
    base.Listing(
        "ring_impacts.csv",
        "The paper's ring struck: by finite elements, and how far its (30)-(32) are off",
        (
            Column("ring", "ring"),
            Column("velocity_m_per_s", "velocity, m/s"),
            Column("verdict", "(30)-(32)"),
            Column("peak_depth", "peak depth, m", "peak_depth_error"),
            Column("peak_depth_row_deviation", "depth by (30)-(32) over it, less 1", "peak_depth_row_deviation_error"),
            Column("duration", "duration, s", "duration_error"),
            Column("duration_row_deviation", "duration by them over it, less 1", "duration_row_deviation_error"),
            Column("restitution", "restitution", "restitution_error"),
            Column("restitution_row_deviation", "restitution by them, less it", "restitution_row_deviation_error"),
        ),
    ),
    base.Listing(
        "ring.csv",
        "Rings pressed",
        (
            Column("ring", "ring"),
            Column("depth_m", "depth, m"),
            Column("strain", "strain"),
            Column("force_N", "force, N", "force_error_N"),
            Column("row_force_N", "by (27)-(29), N"),
            Column("row_deviation", "(27)-(29) over it, less 1"),
            Column("exponent", "exponent", "exponent_error"),
        ),
    ),
)


def make(asked: base.Request) -> base.Made:
    """Press, strike, judge."""
    curves = rings(cases(), asked.where, asked.progress, asked.jobs)
    impacts = struck(cases(), asked.where, asked.progress)
    from fe_contact.studies.rings_chart import plot_rings

    judged = [(curve.case.name, verdict(curve)) for curve in curves]
    said = [f"{name}: the paper's force (27)-(29) {one.word}: {one.sentence}" for name, one in judged]
    said += [f"{one.ring} at {1e3 * one.velocity:.3g} mm/s: (30)-(32) {one.verdict}" for one in impacts]
    section = base.Section((headline(curves, impacts),), tuple(said), FIGURES, LISTINGS, missed=missed(curves, impacts))
    return base.Made(section, tuple(partial(write, curves, impacts=impacts) for write in (write_rings, plot_rings)))


def headline(curves: Sequence[RingCurve], impacts: Sequence[RingStruck]) -> base.Headline:
    """For how many rings and impacts the paper's formulas hold."""
    words = Counter(verdict(curve).word for curve in curves)
    pressed = ", ".join(f"{where} for {words[word]}" for word, where in DEPTHS.items())
    held = sum(one.holds for one in impacts)
    said = f"Of {len(curves)} rings pressed slowly, the paper's force over depth (27)-(29) holds {pressed}"
    word = base.HOLDS if held == len(impacts) and set(words) == {"holds"} else base.DIFFERS
    return base.Headline(word, f"{said}; its impact by (30)-(32) holds in {held} of {len(impacts)} impacts on them.")


MEMBER = base.ReportPart(
    rank=40,
    title="Rings",
    question="Does a rod in a ring push back as the paper's formulas say?",
    command="fe-contact ring",
    make=make,
    seconds=20,
)
