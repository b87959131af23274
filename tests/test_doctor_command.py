"""`doctor`: what does not work is named with its cure, and one broken part hides no other."""

from __future__ import annotations

import builtins
import importlib.metadata
import json
from pathlib import Path
from typing import Any

import pytest

from fe_contact.cli import main
from fe_contact.commands import doctor
from lumped.result.result import provenance
from meshes.errors import APT_LINE


@pytest.fixture
def without_the_impact(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "CHECKS", {name: one for name, one in doctor.CHECKS.items() if name != "impact"})


def found(capsys: pytest.CaptureFixture[str]) -> dict[str, dict[str, Any]]:
    return {one["check"]: one for one in json.loads(capsys.readouterr().out)["checks"]}


@pytest.mark.tenth
def test_this_installation_works(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor", "--json"]) == 0
    assert all(one["well"] for one in found(capsys).values())


@pytest.mark.usefixtures("without_the_impact")
def test_broken_parts_are_all_named_with_their_cures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    real, version = builtins.__import__, importlib.metadata.version

    def no_gmsh(name: str, *rest: Any, **more: Any) -> Any:
        if name == "gmsh":
            raise OSError("libGLU.so.1: cannot open shared object file")
        return real(name, *rest, **more)

    def no_jinja2_and_an_old_scipy(name: str) -> str:
        if name == "jinja2":
            raise importlib.metadata.PackageNotFoundError(name)
        return "1.9.3rc1" if name == "scipy" else version(name)

    (tmp_path / "file").touch()
    monkeypatch.setattr(builtins, "__import__", no_gmsh)
    monkeypatch.setattr(importlib.metadata, "version", no_jinja2_and_an_old_scipy)
    monkeypatch.setenv("FE_CONTACT_CACHE", str(tmp_path / "file"))
    assert main(["doctor", "--json"]) == 1
    checks = found(capsys)
    assert not any(one["well"] for one in checks.values())
    assert APT_LINE in checks["meshes"]["says"]
    assert "jinja2 is missing" in checks["packages"]["says"]
    assert "scipy is 1.9.3rc1, older than 1.16" in checks["packages"]["says"]
    assert "FE_CONTACT_CACHE" in checks["cache"]["says"]


def test_the_version_names_what_numbers_depend_on(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(["--version"])
    assert stop.value.code == 0
    said = capsys.readouterr().out
    for package in ("fe-contact", "numpy", "scipy", "scikit-fem", "meshio", "gmsh"):
        version = importlib.metadata.version(package)
        assert f"{package} {version}" in said
        assert provenance()[package] == version, "as every result says too"
