"""The manual: built whole, without the network, with no link into nothing; and every example in it runs."""

from __future__ import annotations

import ast
import inspect
import json
import re
import shlex
import tomllib
from argparse import Namespace
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import NamedTuple

import pytest
from told import told_columns, untold

from fe_contact.cli import main, parser
from fe_contact.commands import COMMANDS, base
from fe_contact.commands.compare import law_names
from fe_contact.commands.transfer import asked_of
from fe_contact.manual.schemas import RESULT
from fe_contact.manual.site import HERE, MENU
from fe_contact.studies.stability.base import studies
from lumped import Scene, laws
from lumped.fit import opensees
from lumped.paper.claims import misprints
from lumped.shapes import SHAPES

FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
# How a command reads its scene, where that is not the usual way.
READERS = {"fit": base.read_scene_for_fit, "indent": base.read_indenter}
PAGES = [name for group in MENU.values() for name in group]


class Example(NamedTuple):
    page: str
    kind: str
    text: str

    @property
    def lines(self) -> list[list[str]]:
        """Of a shell, by words."""
        return [shlex.split(line) for line in self.text.replace("\\\n", " ").splitlines() if line.strip()]


def examples() -> Iterator[Example]:
    for path in sorted(HERE.glob("*.md")):
        for kind, text in FENCE.findall(path.read_text(encoding="utf-8")):
            yield Example(path.stem, kind, text)


# Pages with something to do, one of the cheapest first: a plain run does that one alone.
PAGES_TO_DO = sorted(
    {one.page for one in examples() if one.kind in ("sh", "python")}, key=lambda page: (page != "scenes", page)
)


# Dear: the tests of their commands say nearly the same, and others here that all they name is there.
DEAR = ("experiment", "transfer", "yielding")


class Collected(HTMLParser):
    """Anchors and links of a page, and what it loads."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.anchors: list[str] = []
        self.links: list[str] = []
        self.loads: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        known = {name: value or "" for name, value in attrs}
        self.anchors += [known["id"]] if "id" in known else []
        if tag == "a":
            self.links.append(known["href"])
        elif "src" in known or tag == "link":
            self.loads.append(known.get("src") or known["href"])


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    where = tmp_path_factory.mktemp("manual")
    assert main(["manual", "--out", str(where), "--quiet"]) == 0
    return where


@pytest.fixture(scope="module")
def collected(site: Path) -> dict[str, Collected]:
    return {path.name: Collected(path.read_text(encoding="utf-8")) for path in site.glob("*.html")}


def test_every_page_is_in_the_menu_once_and_built(site: Path) -> None:
    assert len(PAGES) == len({*PAGES})
    assert {path.stem for path in HERE.glob("*.md")} <= {*PAGES}
    assert {path.stem for path in site.glob("*.html")} == {*PAGES, "index"}


def test_the_manual_is_small() -> None:
    """Each picture loads at once on a slow line, and all pages are a small part of the package."""
    sizes = {path: path.stat().st_size for path in HERE.iterdir() if path.is_file()}
    assert max(size for path, size in sizes.items() if path.suffix == ".svg") <= 100_000
    assert sum(sizes.values()) <= 1_500_000


def test_no_link_leads_into_nothing_and_nothing_is_loaded_from_elsewhere(
    site: Path, collected: dict[str, Collected]
) -> None:
    for page, found in collected.items():
        assert all((site / name).is_file() for name in found.loads), page
        assert len(found.anchors) == len({*found.anchors}), page
        for link in found.links:
            file, _, anchor = link.partition("#")
            if not link.startswith("https://"):
                assert file in collected, (page, link)
                assert not anchor or anchor in collected[file].anchors, (page, link)


def test_what_may_be_wider_than_a_page_is_scrolled_by_keys_too(site: Path) -> None:
    for page in site.glob("*.html"):
        text = page.read_text(encoding="utf-8")
        assert "<pre>" not in text
        assert text.count("<table>") == text.count('<div class="wide" tabindex="0"><table>')


def test_every_section_can_be_found(site: Path, collected: dict[str, Collected]) -> None:
    text = (site / "sections.js").read_text(encoding="utf-8")
    sections = json.loads(text.removeprefix("const SECTIONS = ").removesuffix(";\n"))
    for section in sections:
        page, _, anchor = section["url"].partition("#")
        assert anchor in collected[page].anchors
    assert sum(len(one.anchors) for one in collected.values()) - 2 * len(PAGES) == len(sections)
    assert any("Ting 1966" in section["text"] for section in sections)


def test_what_is_written_of_the_code_names_all_of_it(site: Path) -> None:
    keys, commands, errata = (
        (site / f"{name}.html").read_text(encoding="utf-8") for name in ("keys", "commands", "errata")
    )
    assert all(f"<code>{name}</code>" in keys for name in RESULT)
    for shape in SHAPES.members.values():
        for table in shape.sets:
            assert all(key.meaning in keys for key in table.values())
    assert all(f">{name}</h2>" in commands for name in COMMANDS.names)
    assert errata.count("<tr>") == len(misprints()) + 1


def test_the_page_says_which_laws_opensees_has_and_as_what() -> None:
    """Row by row, each law's material; of the laws that remember there is none to name."""
    scene, told = Scene.load("steel-ball-sls"), dict[str, str]()
    page = (HERE / "experiment.md").read_text(encoding="utf-8")
    for row in page.partition("| `--law` | material |")[2].splitlines()[2:]:
        names, material = (re.findall(r"`(\w+)`", cell) for cell in row.strip("|").split("|"))
        told |= dict.fromkeys(names, "".join(material))
    own = {law.name: opensees.material(laws.get(law.name).of(scene), scene).name for law in opensees.LAWS}
    assert told == own | {law.name: "" for law in opensees.REMEMBERING}


def test_the_tables_of_studies_are_told() -> None:
    """Of every stability study the settings and the measures; of others what any test writes, see conftest.py."""
    for name, study in studies().items():
        columns = [*study.cases(True)[0], *study.chart.measures, "failure"]
        assert not untold(f"{name}.csv", columns), name
    tables = ("table1", "table1-datum", "table1-bonded", "exponents", "finite_spheres", "exponents_from_impacts")
    more = ("tradeoff", "scenes", "checks", "correspondence", "elements", "larger", "formulas")
    assert all(told_columns(f"{name}.csv") for name in (*tables, *more))


def test_every_example_is_one() -> None:
    """Its options and keys are there: a parser takes every command, a file has the tables of its kind."""
    found = [*examples()]
    for example in found:
        if example.kind == "sh":
            for program, *arguments in example.lines:
                assert program == "fe-contact"
                parser().parse_args(arguments)
        elif example.kind == "python":
            compile(example.text, example.page, "exec")
        elif example.kind == "toml":
            assert tomllib.loads(example.text)
        else:
            assert example.kind == "text", f"{example.page}: a block of no kind"
    assert {example.kind for example in found} == {"sh", "python", "toml", "text"}


@pytest.mark.parametrize("page", PAGES_TO_DO)
def test_every_line_names_what_there_is(page: str, empty: Path) -> None:
    """Scenes, the keys set in them, settings, laws; of a scene that a line writes, those of the one it begins with."""
    known = dict[str, str]()
    for example in examples():
        for _, *words in example.lines if (example.page, example.kind) == (page, "sh") else ():
            args = parser().parse_args(words)
            if args.command == "new":
                assert main(words) == 0
            if "scene" in args:
                args.scene = known.get(args.scene, args.scene)
                assert READERS.get(args.command, base.read_scene)(args)
            if getattr(args, "laws", None) not in (None, "", "all"):
                assert law_names(args.laws)
            if args.command == "fit" and args.law != "all":
                assert laws.get(args.law)
            if args.command == "transfer":
                for key, values in asked_of(args, Scene.load(args.scene)).over.items():
                    each = {**vars(args), "overrides": [*args.overrides, f"{key}={values[0]}"]}
                    assert base.read_scene(Namespace(**each))
            if getattr(args, "write", None):
                known[str(args.write)] = args.scene


@pytest.mark.parametrize("page", PAGES_TO_DO)
def test_every_call_is_one_of_what_there_is(page: str) -> None:
    """The imports of an example are made; of each call of ours the name is there and takes these arguments."""
    for example in examples():
        if (example.page, example.kind) == (page, "python"):
            tree, names = ast.parse(example.text), dict[str, object]()
            imports = [one for one in tree.body if isinstance(one, ast.Import | ast.ImportFrom)]
            exec(compile(ast.Module(imports, []), page, "exec"), names)
            for call in ast.walk(tree):
                if isinstance(call, ast.Call) and (name := ast.unparse(call.func)).partition(".")[0] in names:
                    called = eval(name, names)
                    if callable(called) and called.__module__.partition(".")[0] in ("fe_contact", "lumped"):
                        given = {one.arg: one.value for one in call.keywords if one.arg}
                        assert inspect.signature(called).bind(*call.args, **given)


@pytest.mark.family
@pytest.mark.parametrize(
    "page", [pytest.param(page, marks=[pytest.mark.full] if page in DEAR else []) for page in PAGES_TO_DO]
)
def test_what_the_manual_tells_to_do_can_be_done(page: str, empty: Path) -> None:
    """Block after block, in an empty folder."""
    for example in examples():
        if example.page == page:
            done(example)
    for table in empty.glob("fe-contact-out/*/*.csv"):
        header = table.read_text(encoding="utf-8").partition("\n")[0].split(",")
        assert told_columns(table.name), table.name
        assert not untold(table.name, header), table.name


def done(example: Example) -> None:
    if example.kind == "sh":
        for _, *arguments in example.lines:
            assert main(arguments) == 0, arguments
    elif example.kind == "python":
        exec(compile(example.text, example.page, "exec"), {"__name__": "manual"})
