"""What every view for a terminal shares: texts shown as they are, columns that keep their order."""

import io

import pytest
from rich.console import Console

from nullpose.report.document import beside, document, head, pairs, table


def test_texts_are_shown_as_they_are() -> None:
    """What looks like markup is none, in a head, a heading, a cell or a note."""
    odd = "[red]gate[/red]"
    view = document(head(odd), pairs(odd, [("name", odd)]), None, table("", [{odd: odd}]), odd)
    console = Console(width=120, file=io.StringIO(), highlight=False)
    console.print(view)
    assert console.file.getvalue().count(odd) >= 5


def test_what_is_compared_stands_side_by_side() -> None:
    """Each label has a row, each of those compared a column."""
    rows = beside({"one": {"x": "1", "y": "2"}, "two": {"y": "4", "x": "3"}})
    assert rows == [{"": "x", "one": "1", "two": "3"}, {"": "y", "one": "2", "two": "4"}]


@pytest.mark.parametrize("width", [30, 50, 80, 120])
def test_digits_are_never_cut(width: int) -> None:
    """At any width each number stands whole on one line; names and headings give way."""
    numbers = ["-123456.789", "0.000123456", "9876543.21"]
    cells = {"x of the drone (m)": numbers[0], "received power (W)": numbers[1], "z (m)": numbers[2]}
    view = table("Links", [{"node": "a-sensor-with-quite-a-long-name-in-the-field", **cells}])
    console = Console(width=width, file=io.StringIO(), highlight=False)
    console.print(view, crop=False)
    text = console.file.getvalue()
    assert all(number in text for number in numbers)
    assert all(word in text for word in ("received", "power", "(W)", "drone"))
    assert width < 80 or max(map(len, text.splitlines())) <= width
