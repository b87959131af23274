"""``fe-contact indent SCENE --depths d1,d2,...``: slow indentation, with error bars."""

from __future__ import annotations

import argparse

from fe_contact.commands import base
from fe_contact.settings import tolerance_of
from lumped.errors import BadInput, Fault, NotReached, nearest, shown
from lumped.indentation import Indentation
from lumped.scene.indenter import Indenter
from lumped.schema import Table

EXACT = ("mdr", "ting", "correspondence")  # at rest all are the exact load curve, the first the half-space's alone


def execute(args: argparse.Namespace) -> int:
    """Press, write, report; 0 or 3."""
    from fe_contact.methods import settings

    indenter, table = base.read_indenter(args)
    given = settings(table, None, indenter.source)
    depths = _depths(args.depths, indenter)
    where = base.folder(args, "indent", indenter.name)
    found = _indented(args, indenter, depths, given)
    content, told = base.publish(where, found.write_files)
    title, *lines = found.summary().split("\n  ")
    return base.report(args, found, content, [*lines, told], title, indenter.model)


def _depths(text: str, indenter: Indenter) -> tuple[float, ...]:
    """The depths asked for, m. Raises BadInput with every fault, where one of them is no number."""
    depths, faults = list[float](), list[Fault]()
    for one in text.split(","):
        try:
            depths.append(base.number(one, "--depths"))
        except BadInput as bad:
            faults += bad.faults
    if faults:
        raise BadInput([*faults, *indenter.depth_faults(depths)])
    return tuple(depths)


def _indented(args: argparse.Namespace, indenter: Indenter, depths: tuple[float, ...], given: Table) -> Indentation:
    """By finite elements or by a closed form; raises BadInput for any other method."""
    from fe_contact.indentation import indent as by_elements

    progress = base.progress_of(args)
    if args.method == "fe":
        return by_elements(indenter, depths, given, args.instant, progress)
    names = ("fe", "cheapest", "hertz", *EXACT)
    if args.method not in names:
        reason = f"{shown(args.method)}: accepted {', '.join(names)}{nearest(args.method, names)}"
        raise BadInput(Fault("--method", "", reason))
    from lumped.indentation import indent as closed_form

    tolerance = tolerance_of(given)
    if args.method == "cheapest" and (indenter.model.finite or indenter.model.plasticity):
        return by_elements(indenter, depths, given, args.instant, progress)
    if args.method != "cheapest":
        return closed_form(indenter, depths, args.method, args.instant, tolerance)
    try:
        return closed_form(indenter, depths, EXACT[indenter.target.has_length], args.instant, tolerance)
    except NotReached:  # the load curve ends before
        return by_elements(indenter, depths, given, args.instant, progress)


MEMBER = base.Command(
    "slow indentation to given depths: indentation.csv and result.json, with error bars",
    (
        *base.SCENE,
        *base.OUTPUT,
        base.option("--depths", required=True, metavar="d1,d2,...", help="depths in m"),
        base.option("--method", default="fe", metavar="M", help="fe (default), cheapest, hertz, or an exact law"),
        base.option("--instant", action="store_true", help="the material against a sudden indentation"),
    ),
    execute,
    example="fe-contact indent polymer-sphere --depths 1e-5,2e-5,5e-5",
    group=base.START,
)
