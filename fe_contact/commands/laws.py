"""``fe-contact laws``: the lumped laws."""

from __future__ import annotations

import argparse

from fe_contact.commands import base

SUMMARY = "the lumped laws, one line each"


def arguments(parser: argparse.ArgumentParser) -> None:
    """No arguments."""


def execute(args: argparse.Namespace) -> int:
    """Print; 0."""
    from lumped import laws

    for name in laws.available():
        print(f"{name:20s} {(laws.get(name).__doc__ or '').splitlines()[0]}")
    return base.DONE
