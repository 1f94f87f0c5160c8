"""A result as a document: a head, tables of rows, pairs of names and words, notes.

Every text is shown as it is given: what looks like markup is none.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from textwrap import wrap
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from rich.console import Console, ConsoleOptions, RenderableType, RenderResult

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
) -> View | None:
    """Return rows as a table in the house's look, whose numbers are whole at any width; None without rows.

    Args:
        title: stands above it; may be empty.
        rows: cells by heading, the first of which names the row; an empty one is a rule.
        bold: names of the rows that stand out.
        left: headings of columns of words; those of numbers are to the right.
    """
    if not any(rows):
        return None
    words = {heading for place, heading in enumerate(rows[0]) if place == 0 or heading in left}
    return _Fitted(lambda excess: _table(title, rows, bold, words, excess))


_ANY_WIDTH = 10_000
_LONGEST_WORD = 20  # characters; longer ones, such as names, are broken where there is no room


class _Fitted:
    """A table that is made for the width there is: lines end between words, and digits are never broken."""

    def __init__(self, make: Callable[[int | None], RenderableType]) -> None:
        self._make = make

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Yield the table as it is, or narrower by its excess over the width, or as wide as it has to be."""
        room = options.update(max_width=_ANY_WIDTH)
        view = self._make(None)
        if console.measure(view, options=room).maximum > options.max_width:
            excess = console.measure(self._make(0), options=room).maximum - options.max_width
            view = self._make(max(excess, 0))
        needed = max(options.max_width, console.measure(view, options=room).maximum)
        yield from console.render(view, options.update(max_width=needed))


def _word_widths(rows: Sequence[Row], words: Collection[str], excess: int) -> dict[str, int]:
    """Return how wide each column of words is, so much narrower in all than its cells, as far as words allow.

    Args:
        rows: cells by heading.
        words: headings of the columns of words.
        excess: characters.
    """
    cells = {heading: [heading, *(row[heading] for row in rows if row)] for heading in words}
    widths = {heading: max(map(len, cells[heading])) for heading in words}
    longest = {heading: max(map(len, " ".join(cells[heading]).split()), default=1) for heading in words}
    for most in (max(longest.values(), default=0), _LONGEST_WORD):
        while excess and (wide := [each for each in widths if widths[each] > min(longest[each], most)]):
            widths[max(wide, key=widths.__getitem__)] -= 1
            excess -= 1
    return widths


def _table(
    title: str, rows: Sequence[Row], bold: Collection[str], words: Collection[str], excess: int | None
) -> RenderableType:
    """Return a table of rows.

    Args:
        title: stands above it.
        rows: cells by heading; if all headings are blank, none is shown.
        bold: names of the rows that stand out.
        words: headings of the columns of words.
        excess: characters by which columns of words are narrower than their cells, those of numbers being as
            narrow as their numbers; None for no limit.
    """
    from rich import box
    from rich.table import Table
    from rich.text import Text

    named = any(map(str.strip, rows[0] if rows else ()))
    rules = box.SIMPLE_HEAD if named else box.SIMPLE if title else None
    view = Table(title=title or None, box=rules, show_header=named, **_LOOK)
    widths = {} if excess is None else _word_widths(rows, words, excess)
    for heading in rows[0] if rows else ():
        is_words, longest = heading in words, max((len(row[heading]) for row in rows if row), default=1)
        lines = [heading]
        if excess is not None and not is_words:
            lines = wrap(heading, max(longest, *map(len, heading.split() or [""])), break_on_hyphens=False)
        view.add_column(
            Text("\n".join(lines)),
            justify="left" if is_words else "right",
            no_wrap=not is_words,
            overflow="fold",
            width=widths.get(heading),
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
    listed = [{"": name, " ": words} for name, words in rows if words is not None]
    return _Fitted(lambda excess: _table(title, listed, (), ("", " "), excess))
