"""``fe-contact identify CURVE.csv ... --scene SCENE --free KEY,...``: numbers of a scene from measured histories."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from fe_contact.commands import base
from fe_contact.methods import FE, simulate
from fe_contact.progress import Progress
from lumped.errors import BadInput, Fault, NotReached, addressed
from lumped.schema.files import SCENES, parse_assignment, toml_text

if TYPE_CHECKING:
    from lumped.identify import Identified, Interval
    from lumped.identify.search import Reference
    from lumped.result.history import History
    from lumped.result.score import Curve
    from lumped.scene.scene import Scene

# CURVE.csv:striker.velocity=0.3,striker.mass=0.1; a path may hold colons of its own
OWN = re.compile(r"(?P<path>.*?):(?P<own>[A-Za-z_][^:=]*=.*)")
WRITE, CORNER, LOW_PASS = "--write", "--corner", "--low-pass"
METHODS = ("ting", FE)
LEAST_DRAWS, MOST_DRAWS = 100, 1_000_000  # the ends of a band need some; work


def execute(args: argparse.Namespace) -> int:
    """Read, judge, identify, write, report; 0, or 3 where no impact came near the curves, or a key was not found."""
    from fe_contact.studies.identify_chart import plot_identified
    from lumped.identify import RECORD, identify
    from lumped.scene.scene import Scene

    overrides, own = base.overrides_of(args), _curves(args.curves)
    name = Path(SCENES.resolved(args.scene)).stem
    where = base.folder(args, "identify", name)
    _check_written(args.write)
    corner = None if args.corner is None else base.number(args.corner, CORNER)
    low_pass = None if args.low_pass is None else base.number(args.low_pass, LOW_PASS)
    sample = 0 if args.sample is None else _draws(args.sample)
    curves, warnings = _read(own, lambda keys: Scene.load(args.scene, overrides | keys))
    free = [key.strip() for key in args.free.split(",") if key.strip()]
    progress = base.progress_of(args)
    progress(f"identifies {len(free)} keys from {len(curves)} curves")
    reference = _reference(args, progress)
    try:
        with addressed("", {"corner": CORNER, "low_pass": LOW_PASS}):
            found = identify(curves, args.scene, free, own, overrides, corner, args.each, sample, reference, low_pass)
    except NotReached:
        for warning in warnings:  # of curves that look odd: they may be why
            base.complain(warning)
        raise
    content, told = base.publish(where, found.write_files, partial(plot_identified, found), record=RECORD)
    lines = [*summary(found), told]
    if args.write is not None:
        _write_scene(args.write, found)
        trusted = "" if found.adequate else ", which are not to be trusted"
        lines.append(f"the scene with these values{trusted}: {args.write}")
    base.say(args, content, lines, f"{name}: identified from {len(curves)} curve{'s' if len(curves) > 1 else ''}")
    for warning in (*warnings, *found.warnings):
        base.complain(warning)
    return base.NOT_REACHED if found.beyond else base.DONE


def _curves(texts: list[str]) -> dict[str, dict[str, object]]:
    """By its path, what each curve has of its own. Raises BadInput for one that is given twice."""
    found = [_curve_of(text) for text in texts]
    paths = [path for path, _ in found]
    if twice := sorted({path for path in paths if paths.count(path) > 1}):
        raise BadInput(Fault(path, "", "given twice; accepted: every curve once") for path in twice)
    return dict(found)


def _curve_of(text: str) -> tuple[str, dict[str, object]]:
    """A curve's path, and the keys that its impact has of its own. Raises BadInput."""
    split = OWN.fullmatch(text)
    if split is None or Path(text).is_file():
        return text, {}
    return split["path"], dict(parse_assignment(part) for part in split["own"].split(",") if part.strip())


def _read(
    own: dict[str, dict[str, object]], scene_of: Callable[[dict[str, object]], Scene]
) -> tuple[dict[str, Curve], list[str]]:
    """Curves by their paths, and warnings; ``scene_of`` the keys that an impact has of its own. Raises BadInput with
    the faults of all curves.
    """
    from lumped.result.curve_file import read_curve
    from lumped.result.gate import check_curve

    curves, warnings, faults = dict[str, "Curve"](), list[str](), list[Fault]()
    for path, keys in own.items():
        scene = scene_of(keys)
        try:
            curves[path] = read_curve(Path(path))
            warnings += check_curve(curves[path], scene, path, touch_at_zero=False)
        except BadInput as bad:
            faults += bad.faults
    if faults:
        raise BadInput(faults)
    return curves, warnings


def _draws(text: str) -> int:
    """How many draws of the posterior. Raises BadInput."""
    value = base.number(text, "--sample")
    if not LEAST_DRAWS <= value <= MOST_DRAWS or value != int(value):
        raise BadInput(Fault("--sample", "", f"{value:g}: accepted a whole number from {LEAST_DRAWS} to {MOST_DRAWS}"))
    return int(value)


def _reference(args: argparse.Namespace, progress: Progress) -> Reference | None:
    """What corrects Ting's law: finite elements, or None. Raises BadInput."""
    if args.method not in METHODS:
        raise BadInput(Fault("--method", "", f"{args.method}: accepted {', '.join(METHODS)}"))
    _, given = base.read_scene(args)
    if args.method != FE:
        return None

    def reference(scene: Scene) -> History:
        found = simulate(scene, FE, given, progress=progress)
        if not found.converged:
            raise NotReached(f"finite elements: {found.message}")
        return found.history

    return reference


def summary(found: Identified) -> list[str]:
    """Every parameter with its interval, and how far the law explains the curves; one a line."""
    width = max(map(len, found.parameters))
    lines = [f"{name:{width}s} {shown(one, name in found.unneeded)}" for name, one in found.parameters.items()]
    lines += list(_of_reference(found))
    if found.posterior is not None:
        posterior = found.posterior
        lines.append(f"sample: {len(posterior.values)} draws, as good as {posterior.effective:.0f} independent ones")
    for name, alone in found.each.items():
        told = {key: shown(one, key in alone.unneeded) for key, one in alone.parameters.items()}
        lines += [f"{name} alone: {key.rpartition('.')[2]} {one}" for key, one in told.items()]
    noises = ", ".join(f"{100.0 * curve.deviation / curve.peak:.2g} %" for curve in found.curves)
    touches = ", ".join(f"{curve.touch:.6g}" for curve in found.curves)
    return [*lines, f"touch at {touches} s, noise {noises} of the peak", found.verdict]


def _of_reference(found: Identified) -> Iterator[str]:
    """How far finite elements moved every parameter, and how far their own bars could."""
    if found.by_reference is None:
        return
    for name, one in found.by_reference.parameters.items():
        moved = f"{one.by_law:.6g} by Ting's law, moved by {100.0 * (one.value / one.by_law - 1.0):+.2g} %"
        yield f"{name.rpartition('.')[2]}: {moved}, finite elements' bars by {100.0 * one.bar / abs(one.value):.2g} %"
    runs, error = found.by_reference.runs, 100.0 * found.by_reference.error
    yield f"{runs} runs of finite elements, {error:.2g} % of the peak from Ting's law"


def shown(one: Interval, unneeded: bool = False) -> str:
    """A value with its interval; no value where any other fits as well, or none fits best."""
    if one.low is None and one.high is None:
        return f"not told by the curves ({100.0 * one.level:g} %)"
    low, high = ("open" if end is None else f"{end:.{max(one.digits, 5)}g}" for end in (one.low, one.high))
    if unneeded:
        return f"none (up to {high}, {100.0 * one.level:g} %) {one.unit}".rstrip()
    return f"{one.value:.{max(one.digits, 6)}g} ({low} to {high}, {100.0 * one.level:g} %) {one.unit}".rstrip()


def _check_written(path: Path | None) -> None:
    """Raise BadInput, before any work, for a scene file that cannot be written."""
    if path is not None and (path.is_dir() or not path.absolute().parent.is_dir() or path.suffix != ".toml"):
        raise BadInput(Fault(WRITE, str(path), "accepted: a file that ends with .toml, in a folder that is there"))


def _write_scene(path: Path, found: Identified) -> None:
    """The scene file with the values found, called as the file is, and what speaks against them. Raises BadInput."""
    verdict = () if found.adequate else (f"not to be trusted: {found.verdict}",)
    remarks = "".join(f"# {one}\n" for one in (*verdict, *found.warnings))
    try:
        path.write_text(remarks + toml_text({**found.table, "name": path.stem}), encoding="utf-8")
    except OSError as failure:
        raise BadInput(Fault(WRITE, str(path), f"cannot be written: {failure.strerror}")) from failure


MEMBER = base.Command(
    "numbers of a scene, as its material, from measured histories, with 90 % intervals",
    (
        base.option("curves", nargs="+", metavar="CURVE.csv[:KEY=VALUE,...]", help="measured force, with its own keys"),
        base.option("--scene", required=True, help="scene (file or packaged name) whose values are the first guess"),
        base.option(
            "--free", required=True, metavar="KEY,...", help="keys to find, as target.material.E0, beside touch"
        ),
        base.option("--each", action="store_true", help="every curve alone, too"),
        base.option(CORNER, metavar="HZ", help="of the instrument's low pass, where no silence tells the noise's"),
        base.option(LOW_PASS, metavar="HZ", help="the same of a low pass that the force has passed too"),
        base.option(WRITE, type=Path, metavar="FILE.toml", help="write the scene with the values found"),
        base.option("--sample", metavar="N", help="draws of the posterior, with bands of the force"),
        base.option("--method", default="ting", help="ting (default), or fe: corrected by finite elements"),
        base.option("--tolerance", metavar="T", help="of the finite elements; default 1e-3"),
        base.override(),
        *base.OUTPUT,
    ),
    execute,
    example="fe-contact identify curve.csv --scene polymer-sphere --free target.material.E1",
    group=base.LAWS,
)
