"""What `solve` does with ``--figure``. Matplotlib is imported only if one was asked for."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["prepare_figure", "write_figure"]


def prepare_figure(path: Path | None) -> None:
    """Make sure, before any work, that a figure can be written.

    Args:
        path: where to, or None if no figure was asked for.

    Raises:
        UsageError: its name ends in neither .png nor .svg.
        OutputError: its folder cannot be made or written.
    """
    if path is not None:
        from nullpose.report.figures.style import prepare_figure_file

        prepare_figure_file(path)


def write_figure(path: Path | None, draw: Callable[[], Figure]) -> None:
    """Draw and write a figure if one was asked for.

    Args:
        path: where to, or None.
        draw: returns it.

    Raises:
        OutputError: the file cannot be written.
    """
    if path is not None:
        from nullpose.report.figures.style import write_figure_file

        write_figure_file(draw(), path)
