"""The directives that put the tables of `reference.py` into a page."""

from __future__ import annotations

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from reference import key_rows, option_rows


class Table(SphinxDirective):
    """A table of the program: `{keys} airspace`, `{options} study run`."""

    optional_arguments = 1
    final_argument_whitespace = True

    def run(self) -> list[nodes.Node]:
        """Parse the table's lines as those of the page."""
        rows = key_rows if self.name == "keys" else option_rows
        container = nodes.container()
        self.state.nested_parse(StringList(list(rows(" ".join(self.arguments)))), 0, container)
        return container.children


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directives."""
    app.add_directive("keys", Table)
    app.add_directive("options", Table)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
