"""``fe-contact laws``: the lumped laws."""

from __future__ import annotations

import argparse

from fe_contact.commands import base


def execute(args: argparse.Namespace) -> int:
    """Print; 0."""
    from lumped import laws

    known = {name: laws.get(name).summary for name in laws.available()}
    base.say(args, known, [f"{name:20s} {says}" for name, says in known.items()])
    return base.DONE


MEMBER = base.Command(
    "the lumped laws, one line each",
    (base.JSON,),
    execute,
    group=base.LAWS,
)
