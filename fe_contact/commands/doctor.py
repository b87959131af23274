"""``fe-contact doctor``: whether this installation works; what is wrong, and its cure."""

from __future__ import annotations

import argparse
import platform
import re
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from fe_contact import __version__
from fe_contact.commands import base
from lumped.errors import FeContactError
from meshes.errors import MeshError

BROKEN = 1  # exit code: something of the installation is
PACKAGES = ("numpy", "scipy", "scikit-fem", "meshio", "gmsh")  # what a number may depend on
PROBE = "polymer-sphere"  # a second of finite elements, with a mesh and memory
REINSTALL = "cure: python -m pip install --force-reinstall fe-contact"


@dataclass(frozen=True)
class Finding:
    """What one check says, and whether all is well."""

    check: str
    well: bool
    says: str

    @property
    def line(self) -> str:
        """For a person."""
        return f"{'ok  ' if self.well else 'FAIL'} {self.check:9s} {self.says}"


def execute(args: argparse.Namespace) -> int:
    """Try every part, say what was found; 0, or 1 where something does not work."""
    findings = [_tried(name, check) for name, check in CHECKS.items()]
    content = {"well": all(one.well for one in findings), "checks": [vars(one) for one in findings]}
    base.say(args, content, [one.line for one in findings], version_line())
    return base.DONE if content["well"] else BROKEN


def version_line() -> str:
    """The suite and what its numbers may depend on, with versions."""
    known = ", ".join(f"{name} {said}" for name, said in versions().items())
    return f"fe-contact {__version__} (Python {platform.python_version()}, {known})"


def versions() -> Mapping[str, str]:
    """Of the packages that numbers may depend on."""
    from importlib.metadata import PackageNotFoundError, version

    found = {}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "missing"
    return found


class Broken(FeContactError):
    """Something of the installation does not work; the message holds the cure."""

    exit_code = BROKEN


def packages() -> str:
    """All that this suite requires is there, and new enough. Raises Broken with every one that is not."""
    said = {name: _unsuited(name, least) for name, least in _required().items()}
    wrong = [f"{name} {why}" for name, why in said.items() if why]
    if wrong:
        raise Broken(f"{', '.join(wrong)}; {REINSTALL}")
    return "all there, none too old"


def _required() -> dict[str, str]:
    """Least versions by names, as pyproject.toml says; where only the source is there, what numbers may depend on."""
    from importlib.metadata import PackageNotFoundError, requires

    try:
        lines = requires("fe-contact") or []
    except PackageNotFoundError:
        return dict.fromkeys(PACKAGES, "0")
    return dict(line.split(">=") for line in lines if ";" not in line)


def _unsuited(name: str, least: str) -> str:
    """What is wrong with an installed package; empty where nothing is."""
    from importlib.metadata import PackageNotFoundError, version

    try:
        found = version(name)
    except PackageNotFoundError:
        return "is missing"
    return f"is {found}, older than {least}" if _numbers(found) < _numbers(least) else ""


def _numbers(version: str) -> list[int]:
    """Those at its beginning: [3, 10, 8] of 3.10.8rc1."""
    return [int(number) for number in re.sub(r"[^\d.].*", "", version).split(".") if number]


def mesher() -> str:
    """gmsh opens with the libraries of this system. Raises GmshMissing with the line that installs them."""
    from meshes.session import session

    with session("doctor") as gmsh:
        return f"gmsh {gmsh.option.getString('General.Version')} opens"


def impact() -> str:
    """A packaged impact, meshed anew, lies within both bars of what is published, and is drawn. Raises Broken."""
    from fe_contact.assembly.disk_cache import without_disk
    from fe_contact.studies.history_chart import plot_history
    from fe_contact.studies.references import folder, renewed

    begun = time.monotonic()
    with without_disk(), TemporaryDirectory() as place:
        (found,) = renewed([PROBE], folder())
        if found.result is None or not found.agrees or found.is_new:
            raise Broken(f"{found.line}; {REINSTALL}")
        plot_history(found.result, Path(place))
    return f"{found.line}; solved and drawn in {time.monotonic() - begun:.1f} s"


def known_geometries() -> str:
    """The cache folder can be written, or is not used. Raises Broken."""
    from fe_contact.assembly.disk_cache import PLACE, folder, most_bytes

    where = folder()
    if where is None:
        return "off: every geometry is meshed anew"
    if reason := base.unwritable(where):
        raise Broken(f"{where}: {reason}; cure: {PLACE}=FOLDER, another one, or {PLACE}=off")
    return f"{where} can be written, up to {most_bytes() / 2**20:g} MB"


CHECKS: Mapping[str, Callable[[], str]] = {
    "packages": packages,
    "meshes": mesher,
    "impact": impact,
    "cache": known_geometries,
}


def _tried(name: str, check: Callable[[], str]) -> Finding:
    try:
        return Finding(name, True, check())
    except ModuleNotFoundError as failure:
        return Finding(name, False, f"{failure.name} is not installed; {REINSTALL}")
    except (FeContactError, MeshError, ImportError, OSError) as failure:
        return Finding(name, False, str(failure))


MEMBER = base.Command(
    "whether this installation works, and the cure where it does not",
    (base.JSON,),
    execute,
    group=base.START,
)
