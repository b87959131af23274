"""``fe-contact schema NAME``: the JSON Schema of a file that users write, for editors and other programs."""

from __future__ import annotations

import argparse
import json

from fe_contact.commands import base


def execute(args: argparse.Namespace) -> int:
    """Print; 0. Raises BadInput for a name that is none."""
    from fe_contact.manual.schemas import published

    print(json.dumps(published(args.name), indent=1))
    return base.DONE


MEMBER = base.Command(
    "the JSON Schema of a kind of file: editors complete and check scenes by it",
    (base.option("name", metavar="NAME", help="scene, sweep, ptmd, pound or result"),),
    execute,
    example="fe-contact schema scene",
    group=base.KEEPING,
)
