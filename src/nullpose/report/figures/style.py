"""The look that all figures share, and how they are written."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from nullpose.errors import UsageError
from nullpose.files import prepare_folder, replacing
from nullpose.schemes import Curve, Scheme

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = [
    "CURVES",
    "GREY",
    "INK",
    "VEHICLES",
    "Curve",
    "house_style",
    "prepare_figure_file",
    "write_figure",
    "write_figure_file",
]

INK = "#1a1a1a"
GREY = "#6b6b6b"
_FORMATS = (".png", ".svg")


CURVES: Mapping[str, Curve] = MappingProxyType({scheme.value: scheme.record.curve for scheme in Scheme})
"""How schemes are drawn."""

VEHICLES: Mapping[str, Curve] = MappingProxyType(
    {
        "level-vertical": Curve("level, vertical", "#cc79a7", (0, (5.0, 1.6, 1.2, 1.6)), "D", 1.5, 3.0),
        "level-horizontal": Curve("level, horizontal", "#e69f00", (0, (6.0, 2.0)), "s", 1.5, 3.1),
        "tilt-10": Curve("tilt 10, horizontal", "#009e73", (0, (3.0, 1.2)), "^", 1.6, 3.3),
        "tilt-30": Curve("tilt 30, horizontal", "#56b4e9", "-", "v", 1.6, 3.2),
        "omnidirectional": Curve("omnidirectional", "#0a3fd6", "-", "o", 2.4, 3.0),
        "stated": Curve("the file's", "#d55e00", (0, (4.0, 1.0, 1.0, 1.0, 1.0, 1.0)), "X", 1.6, 3.4),
        "array": Curve("array", "#8c8c8c", (0, (1.2, 1.2)), "P", 1.5, 2.9),
    }
)
"""How vehicles are drawn: Okabe and Ito's colours, told apart with any colour vision, lines and markers."""

_RC: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 9.0,
    "axes.labelsize": 9.5,
    "axes.edgecolor": GREY,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.8,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "text.color": INK,
    "svg.hashsalt": "nullpose",  # the same figure gives the same file
}


@contextmanager
def house_style() -> Iterator[None]:
    """Apply the shared look to every figure made inside."""
    import matplotlib

    with matplotlib.rc_context(_RC):
        yield


def write_figure(figure: Figure, folder: Path, stem: str) -> tuple[Path, Path]:
    """Return the paths of a PNG and an SVG of a figure after writing both.

    Args:
        figure: what to write.
        folder: an existing folder.
        stem: file name without its suffix.

    Raises:
        OutputError: a file cannot be written.
    """
    png, svg = folder / f"{stem}.png", folder / f"{stem}.svg"
    return write_figure_file(figure, png), write_figure_file(figure, svg)


def prepare_figure_file(path: Path) -> Path:
    """Return the path of a figure to be written later, its folder made if need be.

    Args:
        path: ends in .png or .svg.

    Raises:
        UsageError: it ends otherwise.
        OutputError: its folder cannot be made or written.
    """
    if path.suffix.lower() not in _FORMATS:
        raise UsageError(f"figure: given {path}; allowed: a name that ends in {' or '.join(_FORMATS)}")
    prepare_folder(path.parent)
    return path


def write_figure_file(figure: Figure, path: Path) -> Path:
    """Return the path of a figure after writing it, as PNG or SVG by the path's suffix.

    Args:
        figure: what to write.
        path: ends in .png or .svg; an existing file is replaced.

    Raises:
        OutputError: the file cannot be written.
    """
    options: dict[str, Any] = {"dpi": 200} if path.suffix.lower() == ".png" else {"metadata": {"Date": None}}
    with house_style(), replacing(path) as temporary:
        figure.savefig(temporary, format=path.suffix.lower()[1:], facecolor="white", **options)
    return path
