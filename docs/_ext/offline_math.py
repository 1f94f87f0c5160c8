"""Equations as MathML, written when the pages are built: browsers draw them without a script or a network.

The build also warns, and so fails when strict, of a formula that could not be converted whole and of a page
that would load anything from another host.
"""

from __future__ import annotations

import re
from pathlib import Path

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.math import get_node_equation_number
from sphinx.writers.html5 import HTML5Translator

LOGGER = logging.getLogger(__name__)

# What the converter leaves in its output when it does not know a command or an environment.
LEFT_OVER = re.compile(r"\\[A-Za-z]+|<m[io]>&(?:amp;)?</m[io]>")

# What a browser fetches by itself, as opposed to a link that a reader may follow.
FETCHED = re.compile(
    r"""<(?:script|img|iframe)\b[^>]*\ssrc=["'](?:https?:)?//|<link\b[^>]*rel=["']stylesheet["'][^>]*//"""
)


def mathml(node: nodes.math | nodes.math_block, display: str) -> str:
    """Return a formula as MathML.

    Args:
        node: the formula in LaTeX.
        display: ``inline`` or ``block``.
    """
    latex = " ".join(node.astext().split())
    try:
        converted = convert(latex, display=display)
    except Exception as error:  # they have no common root; a strict build ends at the warning
        LOGGER.warning("formula not converted (%s): %s", error, latex, location=node)
        return ""
    left_over = LEFT_OVER.search(converted)
    if left_over:
        LOGGER.warning("formula not converted at %s: %s", left_over.group(), latex, location=node)
    return converted


def visit_math(self: HTML5Translator, node: nodes.math) -> None:
    """Write an inline formula."""
    self.body.append(f'<span class="math">{mathml(node, "inline")}</span>')
    raise nodes.SkipNode


def visit_display_math(self: HTML5Translator, node: nodes.math_block) -> None:
    """Write a displayed formula, with its number and a link to it if it has a label."""
    self.body.append(self.starttag(node, "div", CLASS="math"))
    self.body.append(f'<div class="formula">{mathml(node, "block")}</div>')
    if node["number"]:
        self.body.append(f'<span class="eqno">({get_node_equation_number(self, node)})')
        self.add_permalink_ref(node, "Link to this equation")
        self.body.append("</span>")
    self.body.append("</div>\n")
    raise nodes.SkipNode


def check_pages(app: Sphinx, error: Exception | None) -> None:
    """Warn of every page that would load something from another host."""
    if error is None and app.builder.format == "html":
        for page in sorted(Path(app.outdir).rglob("*.html")):
            fetched = FETCHED.search(page.read_text(encoding="utf-8"))
            if fetched:
                LOGGER.warning(
                    "%s loads from another host: %s", page.relative_to(app.outdir), fetched.group()
                )


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the renderer ``mathml``."""
    app.add_html_math_renderer("mathml", (visit_math, None), (visit_display_math, None))
    app.connect("build-finished", check_pages)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
