"""``fe-contact laws``: the lumped laws."""

from __future__ import annotations

import argparse
import json

from fe_contact.commands import base


def arguments(parser: argparse.ArgumentParser) -> None:
    """[--json]."""
    base.json_argument(parser)


def execute(args: argparse.Namespace) -> int:
    """Print; 0."""
    from lumped import laws

    known = {name: laws.get(name).summary for name in laws.available()}
    print(json.dumps(known) if args.json else "\n".join(f"{name:20s} {says}" for name, says in known.items()))
    return base.DONE


MEMBER = base.Command("the lumped laws, one line each", arguments, execute)
