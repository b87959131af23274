"""What is said needs no second reading: sizes in per cent, the option that helps, no unit where there is none."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from fe_contact.cli import main, parser
from fe_contact.commands import COMMANDS
from fe_contact.commands.base import GROUPS
from fe_contact.studies.compare.study import _reason
from lumped import BadInput, FeContactError, LedgerEntry, Quantity, Scene, laws, simulate
from lumped.result.model_ledger import Peak, model_ledger
from lumped.schema.files import SCENES

PEAK = Peak(0.1613, 1.4e-4, 9.2e-4, 0.02)


def entry(effect: str, **keys: object) -> LedgerEntry:
    dotted = {key.replace("__", "."): value for key, value in keys.items()}
    (found,) = [one for one in model_ledger(Scene.load("polymer-sphere", dotted), PEAK) if one.effect == effect]
    return found


def test_an_effect_says_its_size_and_the_option_that_includes_it() -> None:
    falls = entry("gravity", model__direction="down")
    said = "gravity is left out; it may change the peak force by 685 %; to include it: --set model.gravity=9.81"
    assert falls.told_of("peak force") == said
    assert (
        falls.line(1e-3) == "gravity (neglected): 685 %, above the tolerance; to include it: --set model.gravity=9.81"
    )


@pytest.mark.parametrize(
    "command",
    [
        "run steel-ball-plastic --method ting",
        "indent steel-ball-plastic --method mdr --depths 1e-5",
        "run polymer-sphere-waves --method mdr",
        "run steel-ball --method hertz",
    ],
)
def test_what_a_law_leaves_out_of_the_scene_is_not_asked_of_the_scene(
    command: str, empty: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Plasticity, waves, the true profile: the key that selects them is set already."""
    assert main([*command.split(), "--tolerance", "1e-5"]) == 0
    assert capsys.readouterr().err.endswith("; to include it, as the scene asks: --method fe\n")


@pytest.mark.parametrize(("modulus", "said"), [("9", True), ("9e3", False)])
def test_a_modulus_that_was_meant_in_gigapascal_is_doubted(
    modulus: str, said: bool, empty: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of a run and of an indentation; a gel is none."""
    own = ["steel-ball", "--set", f"target.material.E={modulus}", "--set", "striker.velocity=1e-5", "--method", "hertz"]
    for command in (["run", *own], ["indent", *own, "--depths", "1e-6"]):
        assert main(command) == 0
        assert ("are the values in Pa (9 GPa = 9e9)?" in capsys.readouterr().err) == said


@pytest.mark.parametrize(
    ("change", "doubt"),
    [
        ("striker.radius=6", "a whole ball of this radius would be lighter than air; are radius in m and mass in kg?"),
        ("target.material.E1=1.8", "the modulus relaxes to 1.8 Pa, less than any solid's; are the values in Pa"),
        ("target.material.E1=1.8e6", ""),
    ],
)
def test_a_size_in_millimetres_and_one_spring_in_megapascal_are_doubted(
    change: str, doubt: str, empty: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", "polymer-sphere", "--method", "ting", "--set", change]) == 0
    said = capsys.readouterr().err
    assert doubt in said
    assert ("; are " in said) == bool(doubt)


@pytest.mark.parametrize("effect", ["gravity", "target inertia", "constant nu against constant bulk modulus"])
def test_the_option_that_is_named_selects_the_larger_model(effect: str) -> None:
    """As it stands in the sentence it is set, and then the effect is no longer left out."""
    before = entry(effect, model__direction="down")
    key, _, value = before.cure.partition("--set ")[2].partition("=")
    values: dict[str, object] = {"true": True, "9.81": 9.81}
    after = entry(effect, **{"model__direction": "down", key: values.get(value, value)})
    assert after.treated != before.treated


def test_a_parabola_names_the_true_profile() -> None:
    assert entry("parabola against true profile", model__profile="parabola").cure.endswith("model.profile=exact")


def test_what_has_no_unit_has_none() -> None:
    assert str(Quantity(0.81132, 1.6e-4, "1")) == "0.81132 +- 1.6e-04"
    assert str(Quantity(0.0, 2e-4, "1")) == "+- 2.0e-04"
    assert str(Quantity(0.0, 2e-4, "N")) == "0 +- 2.0e-04 N"
    assert str(Quantity(None, None, "s")) == "undefined: no separation"


@pytest.mark.parametrize(("law", "said"), [("hertz", "half-space"), ("rod_waves", "rod"), ("bar_waves", "prism")])
def test_a_law_says_what_it_is_not_for(law: str, said: str) -> None:
    scene = Scene.load("polymer-layer")
    with pytest.raises(FeContactError) as refused:
        simulate(laws.get(law).of(scene), scene)
    assert _reason(law, refused.value).startswith("not for this ")
    assert said in _reason(law, refused.value)


@pytest.mark.parametrize("given", [{}, {"law.k": 2e5}])
@pytest.mark.parametrize("law", ["kelvin", "hunt_crossley", "hertzdamp", "impact_bilinear"])
def test_a_law_of_the_half_space_says_how_it_is_asked_elsewhere(law: str, given: dict[str, object]) -> None:
    """Stiffness and damping of its own, by the keys that the refusal names."""
    with pytest.raises(BadInput, match=f"{law} is not for this layer, but for the half-space, or with its own") as said:
        Scene.load("polymer-layer", {"law.name": law, **given})
    named = dict.fromkeys(re.findall(r"--set (law\.[ke])=", str(said.value)), 0.8)
    assert list(named) == ["law.k", "law.e"]
    own = Scene.load("polymer-layer", {"law.name": law, **named, "law.k": 2e5})
    assert simulate(laws.get(law).of(own), own).converged


def test_scenes_say_what_each_is_for(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["scenes"]) == 0
    said = capsys.readouterr().out.splitlines()
    assert len(said) == len(SCENES.names)
    for name, line in zip(SCENES.names, said, strict=True):
        first = SCENES.path(name).read_text(encoding="utf-8").splitlines()[0]
        sentence = first.lstrip("# ").partition(". ")[0].rstrip(".")
        assert sentence in line
        assert len(sentence) > 30, name


def test_help_has_every_command_once_in_a_group_and_names_the_paper(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    text = parser().format_help()
    for name in COMMANDS.names:
        assert sum(line.startswith(f"  {name} ") for line in text.splitlines()) == 1, name
    assert "10.1155/2016/2596923" in text
    assert all(group in text for group in GROUPS)


def test_every_example_is_one() -> None:
    """The parsers take it: its options, and their number of values."""
    examples = [command.example for command in COMMANDS.members.values() if command.example] + [*GROUPS.values()]
    for example in examples:
        program, *arguments = shlex.split(example.partition(" > ")[0])
        assert program == "fe-contact"
        parser().parse_args(arguments)
    assert {command.group for command in COMMANDS.members.values()} == {*GROUPS}
