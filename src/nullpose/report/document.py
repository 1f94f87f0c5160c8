"""A result as a document: a head, tables of rows, pairs of names and words, notes.

Every text is shown as it is given: what looks like markup is none.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from rich.console import RenderableType

Row = Mapping[str, str]
View: TypeAlias = "RenderableType"
"""What rich can print; rich is imported only when something is printed."""

_LOOK: dict[str, Any] = {"title_justify": "left", "title_style": "bold", "pad_edge": False}


def document(*parts: View | None) -> View:
    """Return parts one below the other, those that are nothing left out.

    Args:
        parts: texts, tables and heads.
    """
    from rich.console import Group
    from rich.text import Text

    return Group(*(Text(part) if isinstance(part, str) else part for part in parts if part is not None))


def head(name: str, label: str = "", value: str = "", lines: Sequence[str] = ()) -> View:
    """Return what stands above a result: the scenario, what was asked for, the value, and lines on it.

    Args:
        name: of the scenario; may be empty.
        label: of the result.
        value: in words.
        lines: below it; empty ones are left out.
    """
    from rich.text import Text

    text = Text(name or "scenario", style="bold")
    if label:
        below = "\n".join(("", *filter(None, lines), ""))
        text = Text.assemble(text, "\n", (label, "bold blue"), ": ", (value, "bold"), below)
    return text


def table(
    title: str,
    rows: Sequence[Row],
    *,
    bold: Collection[str] = (),
    left: Collection[str] = (),
    no_wrap: bool = False,
) -> View | None:
    """Return rows as a table in the house's look; None if there are none.

    Args:
        title: stands above it; may be empty.
        rows: cells by heading, the first of which names the row; an empty one is a rule.
        bold: names of the rows that stand out.
        left: headings of columns of words; those of numbers are to the right.
        no_wrap: whether columns after the first keep their width.
    """
    from rich import box
    from rich.table import Table
    from rich.text import Text

    if not any(rows):
        return None
    view = Table(title=title or None, box=box.SIMPLE_HEAD, **_LOOK)
    for place, heading in enumerate(rows[0]):
        words = place == 0 or heading in left
        view.add_column(
            Text(heading),
            justify="left" if words else "right",
            no_wrap=no_wrap and place > 0,
            overflow="fold",
        )
    for row in rows:
        if row:
            cells = list(map(Text, row.values()))
            view.add_row(*cells, style="bold" if cells[0].plain in bold else "")
        else:
            view.add_section()
    return view


def markdown_table(rows: Sequence[Row]) -> str:
    """Return rows as a table in Markdown, its texts as they are.

    Args:
        rows: cells by heading, the first of which names the row; at least one.
    """
    rule = ["---", *("---:" for _ in list(rows[0])[1:])]
    lines = [list(rows[0]), rule, *(list(row.values()) for row in rows)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def rows(columns: Mapping[str, Sequence[str | None]]) -> list[Row]:
    """Return columns as rows: a column in which nobody has a cell is left out, elsewhere one is a dash.

    Args:
        columns: cells by heading, equally many in each.
    """
    stated = {heading: cells for heading, cells in columns.items() if any(cell is not None for cell in cells)}
    return [
        {heading: "-" if cell is None else cell for heading, cell in zip(stated, cells, strict=True)}
        for cells in zip(*stated.values(), strict=True)
    ]


def beside(columns: Mapping[str, Row]) -> list[Row]:
    """Return the rows of a table that has what is compared side by side.

    Args:
        columns: by heading, each with the same labels and its own cells.
    """
    labels = next(iter(columns.values()), {})
    return [{"": label} | {name: cells[label] for name, cells in columns.items()} for label in labels]


def grouped(said: Iterable[tuple[str, str]]) -> list[str]:
    """Return each sentence once, with the names of those whom it is said of; without, if it is of all.

    Args:
        said: names and sentences; an empty one says nothing of its name.
    """
    said = list(said)
    everyone = {name for name, _ in said}
    names: dict[str, dict[str, None]] = {sentence: {} for _, sentence in said if sentence}
    for name, sentence in said:
        names.get(sentence, {})[name] = None
    return [
        sentence if len(of) == len(everyone) else f"{'; '.join(of)}: {sentence}"
        for sentence, of in names.items()
    ]


def pairs(title: str, rows: Iterable[tuple[str, str | None]]) -> View:
    """Return names with their words beside them.

    Args:
        title: stands above them; may be empty.
        rows: names, which may be empty, and words; without words a name is left out.
    """
    from rich import box
    from rich.table import Table
    from rich.text import Text

    view = Table(title=title or None, box=box.SIMPLE if title else None, show_header=False, **_LOOK)
    for name, words in rows:
        if words is not None:
            view.add_row(Text(name), Text(words))
    return view
