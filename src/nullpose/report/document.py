"""A result as a document: a head, tables of rows, pairs of names and words, notes.

Every text is shown as it is given: what looks like markup is none. Only minus signs become hyphens, so that
numbers can be copied into files and commands.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

from nullpose.report.numbers import MINUS

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.text import Text

Row = Mapping[str, str]
View: TypeAlias = "RenderableType"
"""What rich can print; rich is imported only when something is printed."""

_LONGEST_WORD = 20  # characters; longer ones, such as names, are broken where there is no space


def document(*parts: View | None) -> View:
    """Set texts, tables and heads one below the other; None is left out."""
    from rich.console import Group

    return Group(*(_text(part) if isinstance(part, str) else part for part in parts if part is not None))


def _text(words: str, style: str = "") -> Text:
    from rich.text import Text

    return Text(words.replace(MINUS, "-"), style=style)


def head(name: str, label: str = "", value: str = "", lines: Sequence[str] = ()) -> View:
    """Write what stands above a result: the scenario, the result's label and value, and lines on it."""
    if not label:
        return _text(name or "scenario", "bold")
    below = _text("\n".join(("", *filter(None, lines), "")))
    first = [_text(f"{name or 'scenario'}\n", "bold"), _text(label, "bold blue"), _text(": ")]
    return _text("").join([*first, _text(value, "bold"), below])


def table(
    title: str, rows: Sequence[Row], *, bold: Collection[str] = (), left: Collection[str] = ()
) -> View | None:
    """Set rows as a table and an empty line, no number broken in a narrow terminal; None without rows.

    Args:
        title: stands above it; may be empty.
        rows: cells by heading, the first of which names the row; an empty one is a rule.
        bold: names of the rows that stand out.
        left: headings of columns of words; those of numbers are to the right.
    """
    if not any(rows):
        return None
    from rich import box
    from rich.table import Table

    is_headed = any(map(str.strip, rows[0]))
    view = Table(
        box=box.SIMPLE_HEAD if is_headed else None, show_header=is_headed, show_edge=False, pad_edge=False
    )
    for index, heading in enumerate(rows[0]):
        cells = [row[heading] for row in rows if row]
        is_words = index == 0 or heading in left
        words = [word for text in cells for word in re.findall(r"^ *\S+|\S+" if is_words else ".+", text)]
        longest = max(map(len, [*words, *heading.split()]), default=1)
        view.add_column(
            _text(heading),
            justify="left" if is_words else "right",
            overflow="fold",
            min_width=min(longest, _LONGEST_WORD) if is_words else longest,
        )
    for row in rows:
        if row:
            texts = list(map(_text, row.values()))
            view.add_row(*texts, style="bold" if texts[0].plain in bold else "")
        else:
            view.add_section()
    return document(_text(title, "bold") if title else None, view, "")


def pairs(title: str, rows: Iterable[tuple[str, str | None]]) -> View | None:
    """Set names with their words beside them; a name without words is left out."""
    return table(title, [{"": name, " ": words} for name, words in rows if words is not None], left=(" ",))


def cell(value: float | None, digits: str) -> str | None:
    """Format a number as a cell, as in ``.6g``; None, which is no cell, for no number."""
    return None if value is None else format(value, digits)


def rows(columns: Mapping[str, Sequence[str | None]]) -> list[Row]:
    """Turn columns into rows: a column without any cell is left out, elsewhere a missing cell is a dash."""
    filled = {heading: cells for heading, cells in columns.items() if any(cell is not None for cell in cells)}
    return [
        {heading: "-" if cell is None else cell for heading, cell in zip(filled, cells, strict=True)}
        for cells in zip(*filled.values(), strict=True)
    ]


def beside(columns: Mapping[str, Row]) -> list[Row]:
    """Set what is compared side by side: columns by heading, each with the same labels, become rows."""
    return [
        {"": label} | {name: cells[label] for name, cells in columns.items()}
        for label in next(iter(columns.values()), {})
    ]


def grouped(sentences: Iterable[tuple[str, str]]) -> list[str]:
    """Write each sentence once, with the names that it is true of; without, if it is true of all.

    Args:
        sentences: names and sentences; an empty one says nothing of its name.
    """
    labelled = list(sentences)
    everyone = {name for name, _ in labelled}
    names: dict[str, dict[str, None]] = {sentence: {} for _, sentence in labelled if sentence}
    for name, sentence in labelled:
        names.get(sentence, {})[name] = None
    return [
        sentence if len(of) == len(everyone) else f"{'; '.join(of)}: {sentence}"
        for sentence, of in names.items()
    ]
