"""How docstrings become pages, where the defaults do not fit this code."""

from __future__ import annotations

from pydantic import BaseModel
from sphinx.application import Sphinx
from sphinx.ext.napoleon.docstring import GoogleDocstring


class Docstring(GoogleDocstring):
    """A Google-style docstring in which an attribute's colon is a colon, not the end of its type."""

    def _parse_attribute_docstring(self) -> list[str]:
        return list(self._consume_to_end())


def read_sections(app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    """Turn the sections of a docstring (Args, Returns, Raises) into what Sphinx reads."""
    lines[:] = Docstring(list(lines), what=what, name=name, obj=obj, options=options).lines()


def model_signature(
    app: Sphinx, what: str, name: str, obj: object, options: object, signature: str, returns: str
) -> tuple[str, str] | None:
    """Return no signature for a table of the scenario: its keys are described below it, with their units."""
    if what == "class" and isinstance(obj, type) and issubclass(obj, BaseModel):
        return "", ""
    return None


def setup(app: Sphinx) -> dict[str, bool]:
    """Register both; this stands in for sphinx.ext.napoleon."""
    app.connect("autodoc-process-docstring", read_sections)
    app.connect("autodoc-process-signature", model_signature)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
