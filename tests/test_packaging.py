"""What reaches a user: metadata, the README's commands, the wheel."""

from __future__ import annotations

import os
import re
import runpy
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path
from typing import Any

import pytest

from meshes.errors import APT_LINE

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("lumped", "meshes", "fe_contact")
README = (ROOT / "README.md").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


MANUAL = {path.stem: path.read_text(encoding="utf-8") for path in (ROOT / "fe_contact" / "manual").glob("*.md")}


def blocks(language: str, text: str = README) -> list[str]:
    """Code blocks of one language, in order."""
    fenced = re.compile(rf"^```{language}\n(.*?)\n```$", re.DOTALL | re.MULTILINE)
    return fenced.findall(text)


RUN_COMMAND, TEST_COMMAND = blocks("sh")


def apt_packages(command: str) -> set[str]:
    """What the `apt-get install` of a command line installs."""
    arguments = re.search(r"apt-get install ([^&]*)", command)
    assert arguments, f"no apt-get install in {command!r}"
    return {word for word in arguments[1].split() if not word.startswith("-")}


def files(folder: str) -> set[str]:
    """Every file below a folder of the checkout, caches apart."""
    found = (path for path in (ROOT / folder).rglob("*") if path.is_file())
    return {path.relative_to(ROOT).as_posix() for path in found if "__pycache__" not in path.parts}


def python(*arguments: str, **options: Any) -> str:
    """Standard output of a Python process that must succeed."""
    return output(sys.executable, *arguments, **options)


def output(*command: str, **options: Any) -> str:
    """Standard output of a process that must succeed."""
    run: subprocess.CompletedProcess[str]
    run = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    assert run.returncode == 0, run.stderr
    return run.stdout.strip()


def test_each_readme_command_is_one_line() -> None:
    assert "\n" not in RUN_COMMAND + TEST_COMMAND


def test_ci_runs_exactly_the_test_command() -> None:
    script = ROOT / ".ci" / "run"
    assert script.read_text(encoding="utf-8").splitlines().count(TEST_COMMAND) == 1
    assert os.access(script, os.X_OK)


def test_both_commands_install_the_same_system_packages() -> None:
    assert apt_packages(RUN_COMMAND) == apt_packages(TEST_COMMAND)


def test_the_cure_for_a_missing_library_is_what_the_readme_installs() -> None:
    assert apt_packages(APT_LINE) == apt_packages(RUN_COMMAND) - {"python3-venv"}


def test_the_readme_shows_the_costs_that_were_recorded() -> None:
    benchmark = runpy.run_path(str(ROOT / "tests" / "benchmark.py"))
    ratios, _ = benchmark["recorded"]()
    assert benchmark["TABLE"].findall(README) == [benchmark["table"](ratios)]


def test_the_readme_has_no_gaps() -> None:
    assert "@@" not in README


@pytest.mark.parametrize("page", ["README", "adding"])
def test_only_what_exists_is_named(page: str) -> None:
    text = README if page == "README" else MANUAL[page]
    quoted = re.findall(
        r"`((?:data|lumped|meshes|fe_contact|tests)/[\w/]*(?:/|\b(?!NAME)\w+\.\w+))(?:NAME\.py)?`", text
    )
    quoted += re.findall(r"`([A-Z]+\.\w+)`", README)
    assert quoted
    assert not [place for place in quoted if not (ROOT / place).exists()]


def test_example_scenes_are_packaged_ones() -> None:
    examples = [tomllib.loads(text) for text in blocks("toml") + blocks("toml", MANUAL["scenes"])]
    assert len(examples) == 2
    for example in examples:
        packaged = ROOT / "data" / "scenes" / f"{example['name']}.toml"
        assert tomllib.loads(packaged.read_text(encoding="utf-8")) == example


def test_the_readme_example_runs(tmp_path: Path) -> None:
    (example,) = blocks("python")
    assert python("-c", example, cwd=tmp_path)


def test_one_version_everywhere() -> None:
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert re.search(rf"^version: {re.escape(PROJECT['version'])}$", citation, re.MULTILINE)
    assert PROJECT["version"] in changelog


def test_each_dependency_says_why() -> None:
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    for requirement in PROJECT["dependencies"]:
        assert re.search(rf'^ *"{re.escape(requirement)}", +# \w', text, re.MULTILINE), requirement


def test_no_test_folder_is_a_package() -> None:
    """tests/lumped/__init__.py would stand in the place of lumped."""
    assert not list((ROOT / "tests").rglob("__init__.py"))


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel of this checkout, built without the network."""
    folder = tmp_path_factory.mktemp("wheel")
    python("-m", "hatchling", "build", "-t", "wheel", "-d", str(folder), cwd=ROOT)
    (built,) = folder.glob("*.whl")
    return built


def test_the_wheel_holds_all_source_and_data_and_nothing_else(wheel: Path) -> None:
    source = {path for package in PACKAGES for path in files(package)}
    data = {path.replace("data/", "fe_contact/_data/", 1) for path in files("data")}
    held = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    assert data
    assert held == source | data
    assert {f"{package}/py.typed" for package in PACKAGES} <= held


def test_the_installed_wheel_finds_its_data(wheel: Path, tmp_path: Path) -> None:
    """Unpacked anywhere, away from the checkout."""
    zipfile.ZipFile(wheel).extractall(tmp_path)
    probe = "import lumped.schema.files; print(lumped.schema.files.data_folder())"
    found = python("-P", "-c", probe, cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(tmp_path)})
    assert Path(found) == (tmp_path / "fe_contact" / "_data").resolve()


def test_the_command_is_installed_and_is_the_module() -> None:
    installed = output(str(Path(sys.executable).with_name("fe-contact")), "--help")
    assert "compare" in installed
    assert installed == python("-m", "fe_contact", "--help")
