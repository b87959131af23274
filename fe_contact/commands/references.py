"""``fe-contact references [--check | --update]``: the published histories again, and what changed by how much."""

from __future__ import annotations

import argparse
from pathlib import Path

from fe_contact.commands import base
from lumped.errors import BadInput, Fault
from lumped.result.folder import publish


def execute(args: argparse.Namespace) -> int:
    """Answer the scenes again and compare, or write what is published; 0, or 3 where --check finds what differs."""
    return _renew(args) if args.export is None else _export(args)


def _export(args: argparse.Namespace) -> int:
    """Write what is published for other tools; 0. Nothing is answered again."""
    from fe_contact.studies.references import RECORD, checked, checked_format, published, write_for_others

    if args.check or args.update:
        raise BadInput(Fault("--export", "", "writes what is published; accepted: without --check and --update"))
    form, where = checked_format(args.format), Path(args.export)
    base.check_writable(where, "--export")
    references = published(checked(_names(args)))
    progress = base.progress_of(args)
    content = publish(where, lambda folder: write_for_others(references, form, folder, progress), RECORD)
    base.say(args, content, [f"{len(references)} scene{'s' * (len(references) > 1)} written to {where}"])
    return base.DONE


def _names(args: argparse.Namespace) -> tuple[str, ...]:
    return tuple(args.scenes.split(",")) if args.scenes else ()


def _renew(args: argparse.Namespace) -> int:
    from fe_contact.studies.references import RECORD, checked, folder, renewed, write_published, write_references

    names = checked(_names(args))
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
        base.option("--export", metavar="DIR", help="write what is published into a folder, for other tools"),
        base.option("--format", default="csv", metavar="F", help="of --export: csv (default), json, parquet, opensees"),
        base.option("--update", action="store_true", help="renew what is published in the packaged data"),
    ),
    execute,
    example="fe-contact references --check --scenes polymer-sphere",
)
