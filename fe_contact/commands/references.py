"""``fe-contact references [--check | --update]``: the published histories again, and what changed by how much."""

from __future__ import annotations

import argparse

from fe_contact.commands import base
from lumped.errors import BadInput, Fault
from lumped.result.folder import publish


def execute(args: argparse.Namespace) -> int:
    """Answer the scenes again and compare; 0, or 3 where --check finds one that both bars do not cover."""
    from fe_contact.studies.references import RECORD, checked, folder, renewed, write_published, write_references

    names = checked(args.scenes.split(",") if args.scenes else ())
    if args.update and args.scenes:
        raise BadInput(Fault("--update", "", "renews all scenes together; accepted: without --scenes"))
    run = base.StudyRun.of(args, "references", "histories")
    renewals = list(renewed(names, folder(), run.progress))
    content = publish(run.where, lambda where: write_references(renewals, where), RECORD)
    if args.update:
        publish(folder(), lambda where: write_published(renewals, where), RECORD)
    where = f"{run.where} and {folder()}" if args.update else f"{run.where}"
    base.say(args, content, [*(one.line for one in renewals), f"written to {where}"])
    differing = [one.scene for one in renewals if not one.agrees]
    if args.check and differing:
        base.complain(f"not as published, or not published: {', '.join(differing)}")
        return base.NOT_REACHED
    return base.DONE


MEMBER = base.Command(
    "the published histories: answered again, and what changed, over both error bars",
    (
        *base.OUTPUT,
        base.option("--scenes", metavar="a,b,...", help="packaged scenes; default: all"),
        base.option("--check", action="store_true", help="exit 3 where one lies outside of both error bars"),
        base.option("--update", action="store_true", help="renew what is published in the packaged data"),
    ),
    execute,
    example="fe-contact references --check --scenes polymer-sphere",
)
