"""The columns that the manual's page of tables tells of each of them."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache

from fe_contact.manual.site import HERE


def untold(table: str, header: Iterable[str]) -> list[str]:
    """The columns of a table, by the name of its file, which the page does not name in the sections of that."""
    return [column for column in header if not any(one.fullmatch(column) for one in told_columns(table))]


@cache
def told_columns(table: str) -> tuple[re.Pattern[str], ...]:
    """Those named in the sections that name the table, none of another one; capitals stand for a user's own names."""
    sections = (HERE / "tables.md").read_text(encoding="utf-8").split("\n## ")
    of_it = [text for text in sections if any(one.fullmatch(table) for one in _patterns(r"[\w-]+\.csv", text))]
    return tuple(one for text in of_it for one in _patterns(r"\w+", text))


def _patterns(words: str, text: str) -> list[re.Pattern[str]]:
    return [re.compile(re.sub("LAW|STOREY|GAP", r"\\w+", word)) for word in re.findall(f"`({words})`", text)]
