"""The manual as HTML that needs no network and no server: pages, a menu, and a search over all of them.

What searches is a list of sections in a script beside the pages: a browser loads that from a disk too.
"""

from __future__ import annotations

import argparse
import html
import json
import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from string import Template

import markdown

from fe_contact import __version__
from fe_contact.manual.written import commands_page, errata_page, keys_page
from lumped.schema.json_file import write_json

HERE = Path(__file__).parent
RECORD = "manual.json"
FIRST = "start"
# The menu: names of pages, those in Markdown beside this file or written of the code.
MENU: Mapping[str, Sequence[str]] = {
    "Start here": ("start", "experiment", "exponents", "choosing"),
    "Work": ("sweeps", "identify", "transfer", "pounding"),
    "Look up": ("scenes", "keys", "commands", "running", "theory", "large_strains", "error_bars", "dictionary"),
    "Know": ("limits", "errata", "adding"),
}
EXTENSIONS = ("tables", "fenced_code", "toc", "sane_lists")
LINK = re.compile(r'href="(\w+)\.md(#[\w-]*)?"')
SECTION = re.compile(r'<h([123]) id="([^"]*)">(.*?)</h\1>', re.DOTALL)
TAG = re.compile(r"<[^>]+>")


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
        """It in HTML; links to other pages lead to theirs."""
        made = markdown.markdown(self.text, extensions=[*EXTENSIONS])
        return (
            LINK.sub(r'href="\1.html\2"', made)
            .replace("<table>", '<div class="wide"><table>')
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
