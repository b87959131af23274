"""``fe-contact cache``: what of known geometries is on disk, and where; ``--clear`` removes it."""

from __future__ import annotations

import argparse

from fe_contact.commands import base


def execute(args: argparse.Namespace) -> int:
    """Clear where that is asked, print what is there; 0."""
    from fe_contact.assembly.disk_cache import clear, entries, folder, most_bytes

    where, most = folder(), most_bytes()
    if where is not None and args.clear:
        clear(where)
    files = [] if where is None else entries(where)
    taken = sum(size for _, size, _ in files)
    found = {"folder": where and str(where), "entries": len(files), "bytes": taken, "most_bytes": most}
    said = "off" if where is None else f"{len(files)} entries, {taken / 2**20:.1f} of {most / 2**20:g} MB in {where}"
    base.say(args, found, [said])
    return base.DONE


MEMBER = base.Command(
    "known geometries on disk: where, how many, how much of what they may take",
    (base.JSON, base.option("--clear", action="store_true", help="remove them all")),
    execute,
    group=base.KEEPING,
)
