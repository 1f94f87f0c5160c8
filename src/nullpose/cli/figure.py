"""What `solve` does with ``--figure``. Matplotlib is imported only if one was asked for."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["prepare_outputs", "write_figure"]


def prepare_outputs(file: Path, *, figure: Path | None, **others: Path | None) -> None:
    """Make sure, before any work, that what was asked for can be written, and takes no other file's place.

    Args:
        file: the scenario's.
        figure: where to, or None if no figure was asked for.
        others: further outputs by the names of their options.

    Raises:
        UsageError: the figure's name ends in neither .png nor .svg.
        OutputError: an output is an input or another output too, or it or its folder cannot be written.
    """
    from nullpose.files import check_outputs
    from nullpose.scenario.loading import files_of

    if figure is not None:
        from nullpose.report.figures.style import prepare_figure_file

        prepare_figure_file(figure)
    check_outputs(files_of(file), {f"--{name}": path for name, path in {**others, "figure": figure}.items()})


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
