"""How docstrings become pages, where the defaults do not fit this code."""

from __future__ import annotations

import re

from pydantic import BaseModel
from sphinx.application import Sphinx
from sphinx.ext.napoleon.docstring import GoogleDocstring

ALIAS = re.compile(r"TypeAliasForwardRef\('(\w+)'\)")


class Docstring(GoogleDocstring):
    """A Google-style docstring in which an attribute's colon is a colon, not the end of its type."""

    def _parse_attribute_docstring(self) -> list[str]:
        return list(self._consume_to_end())


def read_sections(app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    """Turn the sections of a docstring (Args, Returns, Raises) into what Sphinx reads."""
    lines[:] = Docstring(list(lines), what=what, name=name, obj=obj, options=options).lines()


def tidy_signature(
    app: Sphinx,
    what: str,
    name: str,
    obj: object,
    options: object,
    signature: str | None,
    returns: str | None,
) -> tuple[str, str | None] | None:
    """Return a signature and its result's type as a reader wants them; nothing where there is no signature.

    A table of the scenario shows none: its keys are described below it, with their units. Elsewhere type
    aliases go by their names, inside other types too.
    """
    if signature is None:
        return None
    if what == "class" and isinstance(obj, type) and issubclass(obj, BaseModel):
        return "", None
    return ALIAS.sub(r"\1", signature), ALIAS.sub(r"\1", returns) if returns else None


def setup(app: Sphinx) -> dict[str, bool]:
    """Register both; this stands in for sphinx.ext.napoleon."""
    app.connect("autodoc-process-docstring", read_sections)
    app.connect("autodoc-process-signature", tidy_signature)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
