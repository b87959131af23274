"""The manual as HTML that needs no network and no server: pages, a menu, and a search over all of them.

What searches is a list of sections in a script beside the pages: a browser loads that from a disk too. Some pages are
written of the code itself: every key, every command, the paper's errata.
"""

from __future__ import annotations

import argparse
import html
import json
import math
import re
import shutil
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from string import Template

import markdown

from fe_contact import __version__, settings
from fe_contact.manual.schemas import ENTRY, RESULT, names_of_files
from fe_contact.studies.sweep import cases
from lumped.materials import Material
from lumped.materials.networks import NETWORKS
from lumped.paper.claims import misprints
from lumped.pounding import case_file as pounding
from lumped.pounding.frames import Gap, ShearFrame
from lumped.ptmd import case_file as damper
from lumped.ptmd.free_vibration import TIME_KEYS
from lumped.ptmd.system import Oscillator
from lumped.result.result import RULED_ABSOLUTE, RULED_RELATIVE, UNITS
from lumped.scene.tables import LAWS, STRIKER_KEYS, TARGET_KEYS, Model, Motion
from lumped.schema.json_file import write_json
from lumped.schema.keys import Choice, Key, Sets, keys_of, optional
from lumped.shapes import SHAPES
from lumped.targets import TARGETS

HERE = Path(__file__).parent
RECORD = "manual.json"
FIRST = "start"
# The menu: names of pages, those in Markdown beside this file or written of the code.
MENU: Mapping[str, Sequence[str]] = {
    "Start here": ("start", "experiment", "exponents", "choosing"),
    "Work": ("yielding", "large_strains", "sweeps", "identify", "transfer", "pounding", "others"),
    "Look up": ("scenes", "keys", "commands", "tables", "running", "theory", "error_bars", "dictionary"),
    "Know": ("limits", "errata", "adding"),
}
EXTENSIONS = ("tables", "fenced_code", "toc", "sane_lists")
LINK = re.compile(r'href="(\w+)\.md(#[\w-]*)?"')
SECTION = re.compile(r'<h([123]) id="([^"]*)">(.*?)</h\1>', re.DOTALL)
TAG = re.compile(r"<[^>]+>")
Keys = Mapping[str, Key]
QUANTITIES = {  # of result.json, in words
    "peak_force": "the largest force",
    "peak_time": "when, from first touch",
    "peak_depth": "the largest depth",
    "duration": "from first touch to the first return of the force to zero after the peak",
    "restitution": "the (relative) speed then, over that at touch",
    "impulse": "integral of the force over time",
    "history_l2": "error of the whole force history in its norm over time; its value is 0",
}


@dataclass(frozen=True)
class Page:
    """A page called `name`, in Markdown."""

    name: str
    text: str

    @property
    def title(self) -> str:
        """Its first heading."""
        return self.text.partition("\n")[0].lstrip("# ").strip()

    @property
    def body(self) -> str:
        """It in HTML; links to other pages lead to theirs; what may be wider than the page is scrolled by keys too."""
        made = markdown.markdown(self.text, extensions=[*EXTENSIONS])
        return (
            LINK.sub(r'href="\1.html\2"', made)
            .replace("<pre>", '<pre tabindex="0">')
            .replace("<table>", '<div class="wide" tabindex="0"><table>')
            .replace("</table>", "</table></div>")
        )


def pages(parsers: Mapping[str, argparse.ArgumentParser]) -> list[Page]:
    """All of them, in the menu's order."""
    written = {"keys": keys_page, "commands": lambda: commands_page(parsers), "errata": errata_page}
    names = [name for group in MENU.values() for name in group]
    return [
        Page(name, written[name]() if name in written else (HERE / f"{name}.md").read_text("utf-8")) for name in names
    ]


def write_site(parsers: Mapping[str, argparse.ArgumentParser], where: Path) -> None:
    """Write every page, what they show, and what searches them, into a folder."""
    found = pages(parsers)
    frame = Template((HERE / "page.html").read_text("utf-8"))
    titles = {page.name: page.title for page in found}
    sections = list[dict[str, str]]()
    for page in found:
        body = page.body
        sections += _sections(page, body)
        menu = _menu(titles, page.name)
        text = frame.substitute(title=html.escape(page.title), menu=menu, body=body, version=__version__)
        (where / f"{page.name}.html").write_text(text, "utf-8")
    (where / "index.html").write_text(f'<meta http-equiv="refresh" content="0; url={FIRST}.html">\n', "utf-8")
    (where / "sections.js").write_text(f"const SECTIONS = {json.dumps(sections, ensure_ascii=False)};\n", "utf-8")
    for name in ("style.css", "search.js", *(path.name for path in sorted(HERE.glob("*.svg")))):
        shutil.copyfile(HERE / name, where / name)
    write_json(where / RECORD, {"schema": "fe-contact/manual/1", "pages": titles})


def _menu(titles: Mapping[str, str], current: str) -> str:
    """Links to all pages in their groups."""
    parts = []
    for group, names in MENU.items():
        links = [_link(name, titles[name], name == current) for name in names]
        parts.append(f"<h2>{group}</h2>\n<ul>{''.join(links)}</ul>")
    return "\n".join(parts)


def _link(name: str, title: str, current: bool) -> str:
    here = ' aria-current="page"' if current else ""
    return f'<li><a href="{name}.html"{here}>{html.escape(title)}</a></li>'


def _sections(page: Page, body: str) -> Iterator[dict[str, str]]:
    """What can be found: every heading of a page with the text up to the next."""
    starts = [*SECTION.finditer(body)]
    for begin, end in zip(starts, [*(one.start() for one in starts[1:]), len(body)], strict=True):
        text = " ".join(html.unescape(TAG.sub(" ", body[begin.end() : end])).split())
        heading = html.unescape(TAG.sub("", begin[3]))
        yield {"url": f"{page.name}.html#{begin[2]}", "page": page.title, "heading": heading, "text": text}


# written of the code


def keys_page() -> str:
    """Every key of the files that users write and of result.json."""
    parts = [
        "# Every key",
        "A scene is a TOML file in SI units, angles in degrees. `fe-contact new` writes one with a comment on every"
        " key, `fe-contact schema scene` the JSON Schema by which editors complete it. Optional is what is not"
        " required; without a default there is then none, or the plan chooses.",
        "## Scene file",
        *_section("[striker], beside those of its shape", [{"shape": _names(SHAPES.names), **STRIKER_KEYS}]),
        *(part for name, one in SHAPES.members.items() for part in _section(f'striker.shape = "{name}"', one.sets)),
        *_section("[target], beside those of its shape", [{"shape": _names(TARGETS.names), **TARGET_KEYS}]),
        *(part for name, one in TARGETS.members.items() for part in _section(f'target.shape = "{name}"', one.sets)),
        *_section("[target.material] or [striker.material], beside those of its law", [keys_of(Material)]),
        *(part for name, one in NETWORKS.members.items() for part in _section(f'material.law = "{name}"', one.sets)),
        *_section("[model]", [keys_of(Model)]),
        *_section("[motion]", [keys_of(Motion)]),
        *_section("[numerics]: what is left out is planned", [optional(settings.KEYS)]),
        *(part for name, one in LAWS.members.items() for part in _section(f'[law] name = "{name}"', one.sets)),
        "## Sweep file",
        "See [Sweeps](sweeps.md).",
        *_section("top level", [cases.KEYS]),
        *_section("[draws]", [cases.DRAW_KEYS]),
        "## File of a pounding damper",
        *_section("[structure], [damper]", [keys_of(Oscillator)]),
        *_section("[ring], beside its [ring.material]", [{**damper.SIZE_KEYS, **law} for law in damper.LAW_KEYS]),
        *_section("[motion], released or with a start", [damper.RELEASE_KEYS, {**damper.START_KEYS, **TIME_KEYS}]),
        "## File of pounding frames",
        "See [Structures that pound](pounding.md).",
        *_section("[structure.left], [structure.right]", [keys_of(ShearFrame)]),
        *_section("[gap.NAME]", [keys_of(Gap)]),
        *(part for kind, keys in pounding.GROUNDS.items() for part in _section(f'[ground] kind = "{kind}"', [keys])),
        *_section("[motion] of pounding frames", [pounding.MOTION_KEYS]),
        "## result.json",
        f"Its JSON Schema is `{names_of_files()['result']}` (`fe-contact schema result`); what is undefined is `null`.",
        _table(("key", "holds"), ((f"`{name}`", says) for name, (_, says) in RESULT.items())),
        "### quantities",
        "The tolerance rules some of them relatively, some absolutely, and the time of the peak not at all.",
        _table(
            ("quantity", "is", "unit", "ruled"), ([f"`{n}`", QUANTITIES[n], u, _ruled(n)] for n, u in UNITS.items())
        ),
        "### an entry of model_ledger",
        _table(("key", "holds"), ((f"`{name}`", says) for name, (_, says) in ENTRY.items())),
    ]
    return "\n\n".join(parts) + "\n"


def commands_page(parsers: Mapping[str, argparse.ArgumentParser]) -> str:
    """What every command does and takes, as its own --help says."""
    parts = [
        "# Every command",
        "`fe-contact NAME --help` says the same. Exit codes: 0 done, 1 a defect of ours, 2 bad input, 3 the tolerance"
        " was not reached or a solve did not converge, 130 interrupted. Shells complete commands and options after"
        " `pip install shtab` and `shtab --shell=bash --prog fe-contact fe_contact.cli.parser`, whose output goes where"
        " the shell's completions are.",
    ]
    for name, parser in parsers.items():
        says, parser.description = (parser.description or "").replace("%%", "%"), None
        parts += [f"## {name}", f"{says[:1].upper()}{says[1:]}.", f"```text\n{parser.format_help().strip()}\n```"]
    return "\n\n".join(parts) + "\n"


def errata_page() -> str:
    """What the source paper prints and what is right."""
    rows = ((one.place, one.printed, one.correct, one.proof, one.kind) for one in misprints())
    parts = [
        "# Errata of the paper",
        "Xue, Zhang, He, Zou and Zhang, *An Updated Analytical Structural Pounding Force Model Based on Viscoelasticity"
        " of Materials*, Shock and Vibration 2016, prints some things that cannot be. `fe-contact paper` recomputes the"
        " numbers that this list rests on (`misprints.csv`) and judges every claim (`claims.csv`).",
        _table(("where", "printed", "right", "because", "kind"), rows),
    ]
    return "\n\n".join(parts) + "\n"


def _section(title: str, sets: Sets | Iterable[Keys]) -> Iterator[str]:
    """A table of keys; of several ways to give them, one after the other. Without a key: none."""
    for number, keys in enumerate(sets):
        yield f"### {title.replace('[', chr(92) + '[')}" if not number else "or"
        if keys:
            rows = ([f"`{name}`", key.meaning, key.kind.accepted, _default(key)] for name, key in keys.items())
            yield _table(("key", "means", "accepted", "default"), rows)
        else:
            yield "No keys of its own."


def _default(key: Key) -> str:
    """What stands where the key is left out."""
    if key.required:
        return "required"
    unset = key.default in (None, ()) or key.default == math.inf
    return "" if unset else f"`{str(key.default).lower() if isinstance(key.default, bool) else key.default}`"


def _names(names: tuple[str, ...]) -> Key:
    return Key(Choice(names), "which kind")


def _ruled(name: str) -> str:
    return "relatively" if name in RULED_RELATIVE else "absolutely" if name in RULED_ABSOLUTE else "no"


def _table(header: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A table in Markdown; bars within cells stay in them."""
    lines = [[*header], *([cell.replace("|", r"\|").replace("*", r"\*") for cell in row] for row in rows)]
    lines.insert(1, ["---"] * len(lines[0]))
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)
