"""``fe-contact transfer SCENE``: laws calibrated at one state and used at others, judged by a reference with bars."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial
from math import inf
from typing import TYPE_CHECKING

from fe_contact.commands import base
from fe_contact.commands.compare import law_names
from lumped.errors import BadInput, Fault, shown
from lumped.scene.scene import Scene
from lumped.schema.keys import Count

if TYPE_CHECKING:
    from fe_contact.studies.transfer.study import Asked

STATES = Count(2, 100)  # work: of one key; a reference each
START = "accepted: KEY=VALUE"
RANGE = "accepted: KEY=low..high:n, as striker.velocity=0.01..0.1:5, low below high and above zero, n from 2 to 100"


def execute(args: argparse.Namespace) -> int:
    """Calibrate, predict, judge, write, a sentence a law; 0 or 3."""
    from fe_contact.methods import settings
    from fe_contact.studies.transfer.chart import plot_transfer
    from fe_contact.studies.transfer.study import transfer

    scene, table = base.read_scene(args)
    asked, overrides = asked_of(args, scene), base.overrides_of(args)
    given = settings(table, None, scene.source)
    run = base.StudyRun.of(args, "transfer", scene.name)
    found = transfer(lambda keys: Scene.load(args.scene, {**overrides, **keys}), given, asked, run.progress)
    title = f"{scene.name}: laws calibrated at {found.at}, against {found.reference.method}"
    return run.finish("transfer.json", found.sentences, found.write, partial(plot_transfer, found), title, found.missed)


def asked_of(args: argparse.Namespace, scene: Scene) -> Asked:
    """What the options ask for. Raises BadInput."""
    from fe_contact.methods import refusal
    from fe_contact.studies.transfer.study import Asked

    if args.method is not None and (reason := refusal(args.method)):
        raise BadInput(Fault("--method", "", reason))
    start = {key: base.number(value, "--from") for key, value in base.pairs(args.start, "--from", START)}
    over = {key: values_of(key, text) for key, text in base.pairs(args.over, "--over", RANGE)}
    laws = () if args.laws == "all" else law_names(args.laws)
    return Asked(laws, start, over, args.calibrate, base.number(args.within, "--within"), args.method)


def values_of(key: str, text: str) -> tuple[float, ...]:
    """`low..high:n` as n values in equal ratios. Raises BadInput."""
    ends, colon, count = text.partition(":")
    low, dots, high = ends.partition("..")
    try:
        first, last, number = float(low), float(high), STATES.read(int(count))
    except ValueError:
        first, last, number = inf, 0.0, 0
    if not (colon and dots and 0.0 < first < last < inf):
        raise BadInput(Fault("--over", key, f"{shown(text)}: {RANGE}"))
    ratio = (last / first) ** (1.0 / (number - 1))
    return (*(first * ratio**i for i in range(number - 1)), last)


def _several(name: str, **rest: str) -> Callable[[argparse.ArgumentParser], object]:
    return base.option(name, nargs="+", action="extend", default=[], **rest)


MEMBER = base.Command(
    "laws calibrated at one state and used at others: where each holds, and to what",
    (
        *base.SCENE,
        *base.OUTPUT,
        base.option("--laws", default="all", metavar="all|a,b,...", help="lumped laws; default: all"),
        _several("--from", dest="start", metavar="KEY=VALUE", help="state of calibration; default: the scene's"),
        _several("--over", metavar="KEY=low..high:n", help="states; default: velocity, a third to three times"),
        base.option("--calibrate", default="least_squares", metavar="HOW", help="least_squares, restitution, modulus"),
        base.option("--within", default="0.05", metavar="T", help="tolerance of the verdict `within`; default 0.05"),
        base.option("--method", metavar="M", help="of the reference; default: fe, or the law that the scene names"),
    ),
    execute,
    example="fe-contact transfer polymer-sphere --laws kelvin,hunt_crossley",
    group=base.LAWS,
)
