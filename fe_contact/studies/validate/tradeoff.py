"""What accuracy costs, in counted work: times are the machine's, and in no file of the report."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path

from fe_contact.studies.files import write_study
from fe_contact.studies.tradeoff.study import SCHEMA, Tradeoff, line_of, tradeoff
from fe_contact.studies.tradeoff.verdict import brief, covered, finite_elements, known
from fe_contact.studies.validate import base
from fe_contact.studies.validate.base import columns
from lumped.scene.scene import Scene

SCENE = "polymer-sphere"
FIGURE = base.Figure("work", "Error of finite elements over counted work, setting by setting", ("tradeoff.csv",))
LISTING = base.Listing(
    "tradeoff.csv",
    "Every method and setting",
    (
        *columns("method", "tolerance", "elements", "order", "elements_per_contact", "steps", "enforcement"),
        *columns("error", "bar", "operations", "leaves_out", "failure"),
    ),
)


def make(asked: base.Request) -> base.Made:
    """Every method and setting on one scene."""
    found = tradeoff(Scene.load(SCENE), {}, asked.quick, asked.where, asked.progress)
    from fe_contact.studies.tradeoff.chart import plot_work

    said = sentences(found)
    section = base.Section((), tuple(said), (FIGURE,), (LISTING,))
    return base.Made(section, (partial(_write, found, said), partial(plot_work, found, said)))


def _write(found: Tradeoff, said: list[str], where: Path) -> None:
    lines = [{key: cell for key, cell in line_of(one).items() if key != "cpu_s"} for one in found.points]
    content: Mapping[str, object] = {"schema": SCHEMA, "scene": SCENE, "verdict": said, "points": lines}
    write_study(where, "tradeoff", content, {"tradeoff": lines})


def sentences(found: Tradeoff) -> list[str]:
    """Of every default how much work it does beside the least that is as good; what errors are measured from."""
    tried = finite_elements(found.points)
    said = []
    for one in (point for point in tried if point.default_for is not None):
        as_good = [point for point in tried if (point.bar or 1.0) <= (one.default_for or 0.0) >= point.error]
        least = min((point.work["operations"] for point in as_good), default=one.work["operations"])
        times = one.work["operations"] / min(least, one.work["operations"])
        said.append(
            f"default for {one.default_for:g}: error {brief(one.error)}, bar {brief(one.bar or 0.0)}, "
            f"{times:.2f} times the least work whose bar meets the tolerance"
        )
    return [*said, known(found.points), covered(tried, found.points)]


MEMBER = base.ReportPart(
    rank=90,
    title="What accuracy costs",
    question="How much work does an error bar take, and are the defaults near the front?",
    command="fe-contact validate --sections tradeoff",
    make=make,
    seconds=54,
    quick="most settings",
)
