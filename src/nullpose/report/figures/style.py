"""The look that all figures share, and how they are written."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from nullpose.errors import require_usage
from nullpose.files import prepare_folder, replacing
from nullpose.physics.types import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK = "#1a1a1a"
GREY = "#6b6b6b"
NODE, JAMMER, EAVESDROPPER, NULL = "#0072b2", "#d55e00", "#b04e94", "#e69f00"
DRONE = INK
FORBIDDEN = "#8c3b3b"
MARKS: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "node": (NODE, "s"),
        "jammer": (JAMMER, "X"),
        "eavesdropper": (EAVESDROPPER, "D"),
        "source": (NODE, "^"),
    }
)
"""Colour and marker of points: told apart in grey and with any colour vision."""


@dataclass(frozen=True, slots=True)
class Curve:
    """How a curve is drawn: told apart by colour, by line and by marker, so that any one is enough.

    Args:
        label: its name in words.
        colour: as in ``#0a3fd6``.
        line: a Matplotlib line style.
        marker: a Matplotlib marker, or nothing.
        width: line width, points.
        order: drawing order, later ones on top.
    """

    label: str
    colour: str
    line: str | tuple[int, tuple[float, ...]]
    marker: str
    width: float
    order: float


CURVES: Mapping[str, Curve] = MappingProxyType(
    {
        "optimum": Curve("optimum pose", NODE, "-", "o", 2.4, 3.0),
        "zero-interference": Curve("zero interference", "#000000", (0, (6.0, 2.0)), "s", 1.5, 4.0),
        "maximum-gain": Curve("maximum gain", JAMMER, "-", "^", 1.5, 3.5),
        "vertical": Curve("vertical", EAVESDROPPER, (0, (5.0, 1.6, 1.2, 1.6)), "D", 1.5, 3.2),
    }
)
"""How schemes are drawn, by name."""


def curve_of(scheme: str) -> Curve:
    """Look up how a scheme is drawn: green and dotted, if it has no curve of its own."""
    return CURVES.get(scheme) or Curve(scheme, "#00694a", ":", "v", 1.5, 3.1)


VEHICLES: Mapping[str, Curve] = MappingProxyType(
    {
        "level-vertical": Curve("level, vertical", EAVESDROPPER, (0, (5.0, 1.6, 1.2, 1.6)), "D", 1.5, 3.0),
        "level-horizontal": Curve("level, horizontal", "#e69f00", (0, (6.0, 2.0)), "s", 1.5, 3.1),
        "tilt-10-horizontal": Curve("tilt 10, horizontal", "#009e73", (0, (3.0, 1.2)), "^", 1.6, 3.3),
        "tilt-10-vertical": Curve("tilt 10, vertical", "#009e73", ":", "<", 1.5, 3.0),
        "tilt-20-vertical": Curve("tilt 20, vertical", "#44aa99", ":", "<", 1.5, 3.0),
        "tilt-20-horizontal": Curve("tilt 20, horizontal", "#44aa99", (0, (3.0, 1.2)), ">", 1.6, 3.25),
        "tilt-30-vertical": Curve("tilt 30, vertical", "#56b4e9", ":", "<", 1.5, 3.0),
        "tilt-30-horizontal": Curve("tilt 30, horizontal", "#56b4e9", "-", "v", 1.6, 3.2),
        "omnidirectional": Curve("omnidirectional", NODE, "-", "o", 2.4, 3.0),
        "stated": Curve("the file's", JAMMER, (0, (4.0, 1.0, 1.0, 1.0, 1.0, 1.0)), "X", 1.6, 3.4),
        "array": Curve("array", GREY, (0, (1.2, 1.2)), "P", 1.5, 2.9),
    }
)
"""How vehicles are drawn: Okabe and Ito's colours, told apart with any colour vision, lines and markers."""

Look: TypeAlias = dict[str, Any]
"""Arguments of Matplotlib by name, as of a line or a text."""

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
    "axes.formatter.useoffset": False,  # every number at an axis is whole, and none stands beside it
    "axes.formatter.limits": (-99, 99),
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "text.color": INK,
    "svg.hashsalt": "nullpose",  # the same figure gives the same file
    "legend.frameon": False,
    "legend.handletextpad": 0.5,
    "legend.columnspacing": 1.2,
    "hatch.linewidth": 0.5,
    "pdf.fonttype": 42,  # fonts are embedded whole, as TrueType
}

_PRINT = {
    "font.size": 8.0,
    "axes.labelsize": 8.0,
    "axes.titlesize": 8.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "legend.fontsize": 7.0,
    "legend.title_fontsize": 7.0,
    "figure.titlesize": 8.0,
}

SERIF = "-serif"
"""What a width ends in for letters as in the text of a paper."""
_SERIF = {"font.family": ["STIXGeneral", "DejaVu Serif"], "mathtext.fontset": "stix"}

WIDTHS_MM: Mapping[str, float] = MappingProxyType({"column": 88.0, "page": 181.0})
"""Widths of figures in print: one column, or both, of an IEEE page."""


def inches(usual: tuple[float, float], width: str | None, share: float) -> tuple[float, float]:
    """Choose the width and height of a figure: the usual, or in print its width and a share of it."""
    if width is None:
        return usual
    wide = WIDTHS_MM[width.removesuffix(SERIF)] / 25.4
    return wide, share * wide


def is_column(width: str | None) -> bool:
    """Tell whether a figure is as wide as a column."""
    return width is not None and width.startswith("column")


@contextmanager
def house_style(width: str | None = None) -> Iterator[None]:
    """Apply the shared look to every figure made inside, with the letters of a screen or of print."""
    import matplotlib

    look = _RC if width is None else _RC | _PRINT
    with matplotlib.rc_context(look | _SERIF if (width or "").endswith(SERIF) else look):
        yield


@contextmanager
def house_figure(size_inch: tuple[float, float], width: str | None = None) -> Iterator[Figure]:
    """Begin a figure of a size in the shared look, which holds inside."""
    from matplotlib.figure import Figure

    with house_style(width):
        yield Figure(figsize=size_inch, layout="constrained")


def line_style(look: Curve) -> Look:
    """Translate a look into Matplotlib's arguments of a line with markers."""
    line = {"color": look.colour, "linestyle": look.line, "linewidth": look.width, "label": look.label}
    return line | {"marker": look.marker, "markersize": 4.2, "markerfacecolor": "white", "zorder": look.order}


def draw_curve(
    axes: Axes,
    look: Curve,
    across: ArrayLike,
    heights: ArrayLike,
    band: tuple[FloatArray, FloatArray] | None = None,
    *,
    steps: bool = False,
    every: int | tuple[int, int] | None = None,
) -> None:
    """Draw a curve, with a band where both of its ends are known.

    Args:
        axes: where to draw.
        look: of the curve.
        across: where.
        heights: how high; infinite ones are left out.
        band: lower and upper end.
        steps: whether a height holds up to the next place.
        every: which points have a marker, as Matplotlib has it; all without.
    """
    heights = np.where(np.isfinite(heights), heights, np.nan)
    axes.plot(
        across, heights, drawstyle="steps-post" if steps else "default", markevery=every, **line_style(look)
    )
    if band is not None:
        finite = np.isfinite(band[0]) & np.isfinite(band[1])
        shade: Look = {"color": look.colour, "alpha": 0.12, "linewidth": 0.0, "zorder": 1.0}
        axes.fill_between(across, *band, where=finite, step="post" if steps else None, **shade)


def prepare_figure_file(path: Path) -> None:
    """Make sure that a figure can be written later, its folder made if need be.

    Raises:
        UsageError: the name ends in none of .png, .svg and .pdf.
        OutputError: its folder cannot be made or written.
    """
    require_usage(
        path.suffix.lower() in (".png", ".svg", ".pdf"),
        f"figure: given {path}; allowed: a name that ends in .png, .svg or .pdf",
    )
    prepare_folder(path.parent)


def write_figure(figure: Figure, *paths: Path) -> tuple[Path, ...]:
    """Write a figure as PNG, SVG or PDF, by the paths' suffixes; existing files are replaced.

    Raises:
        OutputError: a file cannot be written.
    """
    in_print = any(abs(figure.get_figwidth() - mm / 25.4) < 1e-6 for mm in WIDTHS_MM.values())
    options: dict[str, Look] = {
        ".png": {"dpi": 600 if in_print else 200},
        ".svg": {"metadata": {"Date": None}, "dpi": 600},  # of what is no line: patterns, colours of maps
        ".pdf": {"metadata": {"CreationDate": None}, "dpi": 600},
    }
    for path in paths:
        kind = path.suffix.lower()
        with house_style(), replacing(path) as temporary:
            figure.savefig(temporary, format=kind[1:], facecolor="white", **options[kind])
    return paths
