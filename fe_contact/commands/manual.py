"""``fe-contact manual [--out DIR]``: the manual as HTML, to be read and searched without a network."""

from __future__ import annotations

import argparse
import sys
import webbrowser
from functools import partial
from pathlib import Path

from fe_contact.commands import COMMANDS, base
from lumped.result.folder import publish


def execute(args: argparse.Namespace) -> int:
    """Write the pages, open the first where somebody looks; 0."""
    from fe_contact.manual.site import FIRST, RECORD, write_site

    where = args.out or Path("fe-contact-out") / "manual"
    base.check_writable(where)
    parsers = {name: command.parser(f"fe-contact {name}") for name, command in COMMANDS.members.items()}
    content = publish(where, partial(write_site, parsers), RECORD)
    first = where.absolute() / f"{FIRST}.html"
    base.say(args, content, [f"the manual: {first.as_uri()}"])
    if not (args.no_open or args.quiet or args.json) and sys.stdout.isatty():
        webbrowser.open(first.as_uri())
    return base.DONE


MEMBER = base.Command(
    "the manual as HTML, searchable without a network; opens it on a terminal",
    (
        base.option("--out", type=Path, metavar="DIR", help="folder for the pages; default fe-contact-out/manual"),
        base.option("--no-open", action="store_true", help="write it only"),
        base.option("--quiet", action="store_true", help="the same"),
        base.JSON,
    ),
    execute,
    group=base.START,
)
