"""The report as one HTML page that holds its figures and asks for nothing else."""

from __future__ import annotations

import base64
import html
import re
from collections.abc import Mapping
from pathlib import Path

_STYLE = """
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, "DejaVu Sans", sans-serif; color: #1a1a1a; background: #fff;
  max-width: 52rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.7rem; line-height: 1.25; } h2 { font-size: 1.25rem; margin-top: 2.2rem; }
h1 + p, blockquote + p { font-size: 1.08rem; }
blockquote { margin: 1rem 0; padding: .4rem 1rem; border-left: 4px solid #d55e00; background: #fdf3ec; }
img { width: 100%; height: auto; } p > em:only-child { color: #555; font-size: .9rem; }
.wide { overflow-x: auto; }
sub { line-height: 0; }
table { border-collapse: collapse; font-size: .8rem; font-variant-numeric: tabular-nums;
  margin: .6rem 0 1.2rem; }
th, td { padding: .25rem .5rem; border-bottom: 1px solid #ddd; white-space: nowrap; }
td:last-child:nth-child(4) { white-space: normal; } th { border-bottom: 2px solid #888; }
td:first-child, th:first-child { text-align: left; padding-left: 0; }
code, pre { font: .86rem/1.45 "DejaVu Sans Mono", monospace; background: #f4f4f4; }
code { padding: .1em .3em; } pre { padding: .7rem 1rem; overflow-x: auto; } pre code { padding: 0; }
@media print { body { max-width: none; margin: 0; } h2 { break-after: avoid; }
  img, table { break-inside: avoid; } }
"""

_PAGE = """<!DOCTYPE html>
<html lang="en-GB">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>{style}</style>
</head>
<body>
{body}</body>
</html>
"""

_KEPT_TOGETHER = (
    (re.compile(r"(?<=\d) (?=%|dB\b)"), "&nbsp;"),
    (re.compile(r"\bP_M/P\b"), "<i>P</i><sub><i>M</i></sub>/<i>P</i>"),
    (re.compile(r"(?<=</i>) = (?=\S)"), "&nbsp;=&nbsp;"),
)
_IMAGE = re.compile(r'src="figures/([a-z]+)\.png"')


def report_page(text: str, title: str, figures: Mapping[str, Path]) -> str:
    """Return a report in Markdown as a page; figures are put into it as SVG.

    Args:
        text: the report.
        title: of the page.
        figures: SVG files by name.
    """
    from markdown_it import MarkdownIt

    body = MarkdownIt("commonmark", {"html": False}).enable("table").render(text)
    body = body.replace("<table>", '<div class="wide"><table>').replace("</table>", "</table></div>")

    for pattern, together in _KEPT_TOGETHER:
        body = pattern.sub(together, body)

    def inlined(found: re.Match[str]) -> str:
        content = base64.b64encode(figures[found.group(1)].read_bytes()).decode("ascii")
        return f'src="data:image/svg+xml;base64,{content}"'

    return _PAGE.format(title=html.escape(title), style=_STYLE, body=_IMAGE.sub(inlined, body))
