"""`new`: every scene that it writes is one, says what each key accepts, and runs."""

from __future__ import annotations

import io
import sys
import tomllib
from collections.abc import Callable
from itertools import cycle, product
from pathlib import Path

import pytest

from fe_contact.cli import main
from fe_contact.commands.new import MATERIALS, commented, first
from fe_contact.reference import check
from lumped import Scene, laws, simulate
from lumped.errors import BadInput
from lumped.materials.networks import NETWORKS
from lumped.schema.files import SCENES, parsed
from lumped.shapes import SHAPES
from lumped.targets import TARGETS


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def written(striker: str, target: str, material: str) -> str:
    return commented("mine", first(striker, target, material))


def uncommented(text: str) -> str:
    """The file with every default set."""
    lines = (line.removeprefix("# ") if " = " in line and "..." not in line else line for line in text.splitlines())
    return "\n".join(line.removeprefix("# ") if line.startswith("# [") else line for line in lines)


def refused(striker: str, target: str, material: str) -> tuple[str, ...]:
    """The keys for which the reader refuses what is written."""
    try:
        Scene.from_dict(tomllib.loads(written(striker, target, material)))
    except BadInput as bad:
        return tuple(fault.key for fault in bad.faults)
    return ()


def test_every_pair_that_is_packaged_can_be_begun_and_others_are_refused_for_their_shapes() -> None:
    scenes = [parsed(SCENES.path(name)) for name in SCENES.names]
    packaged = {(one["striker"].get("shape"), one.get("target", {}).get("shape")) for one in scenes}
    found = {pair: refused(*pair, "elastic") for pair in product(SHAPES.names, TARGETS.names)}
    begun = [pair for pair, keys in found.items() if not keys]
    assert packaged - {(None, None)} <= {*begun}
    assert all("shape" in key for keys in found.values() for key in keys)
    for pair, material in zip(begun, cycle(MATERIALS), strict=False):
        assert "rod" in pair or not refused(*pair, material)  # a rod's waves are those of an elastic one
    assert {*NETWORKS.names} - {*MATERIALS} == {"measured"}


@pytest.mark.parametrize("material", [name for name in MATERIALS if name != "kelvin_voigt"])
def test_a_rod_ends_so_that_its_material_can_be_followed(material: str) -> None:
    """An absorbing end lets out elastic waves only; a dashpot in parallel has no wave speed at any end."""
    for striker in ("sphere", "punch"):
        check(Scene.from_dict(tomllib.loads(written(striker, "rod", material))), {})


def test_a_default_written_behind_a_sign_is_the_default() -> None:
    for striker, target in (("sphere", "half_space"), ("prism", "plane"), ("cylinder", "ring")):
        text = written(striker, target, "sls")
        plain, whole = (Scene.from_dict(tomllib.loads(one)) for one in (text, uncommented(text)))
        assert plain.to_dict() == whole.to_dict()
        assert uncommented(text) != text


@pytest.mark.parametrize("material", MATERIALS)
def test_what_is_written_runs(material: str) -> None:
    scene = Scene.from_dict(tomllib.loads(written("cone", "half_space", material)))
    assert simulate(laws.ting.of(scene), scene, 1e-2).converged


def test_a_terminal_is_asked_for_what_is_not_given(
    empty: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A wrong answer is asked again; an empty one keeps what stands there."""
    answers = ["cone", "moon", "layer", "elastic", "500", "12.5", *[""] * 20]
    monkeypatch.setattr(sys, "stdin", Terminal("\n".join(answers)))
    monkeypatch.setattr(sys, "stderr", Terminal())
    assert main(["new", "--out", "mine.toml"]) == 0
    assert "one of " in sys.stderr.getvalue()
    scene = Scene.load("mine.toml")
    assert (scene.geometry.shape.name, scene.target.name) == ("cone", "layer")
    assert scene.geometry.shape.to_dict()["angle"] == 12.5
    assert "fe-contact run mine.toml" in capsys.readouterr().out


def test_nothing_is_overwritten_and_nothing_wrong_is_written(empty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "--quiet", "--out", "a.toml"]) == 0
    before = Path("a.toml").read_text(encoding="utf-8")
    for arguments, named in (
        (["--out", "a.toml"], "a.toml"),
        (["--striker", "spere"], "did you mean sphere"),
        (["--material", "measured"], "--material"),
        (["--set", "striker.radius=-1", "--out", "b.toml"], "striker.radius"),
        (["--target", "ring", "--out", "b.toml"], "struck by a cylinder"),
        (["--set", "stricker.radius=1", "--out", "b.toml"], "stricker"),
    ):
        capsys.readouterr()
        assert main(["new", "--quiet", *arguments]) == 2, arguments
        assert named in capsys.readouterr().err
    assert Path("a.toml").read_text(encoding="utf-8") == before
    assert [path.name for path in empty.iterdir()] == ["a.toml"]


def test_all_kinds_that_are_none_are_named(refused: Callable[..., list[str]]) -> None:
    said = refused("new", "--striker", "foo", "--target", "bar", "--material", "baz")
    assert [line.partition(" is not known")[0] for line in said] == [
        "--striker: 'foo'",
        "--target: 'bar'",
        "--material: 'baz'",
    ]
