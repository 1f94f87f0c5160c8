"""Contact sheets of every figure of README, pages and command line: `python docs/figures/sheet.py out`.

At the width of a column and of a screen; light, dark, grey and as a deuteranope sees them. It fails if
letters of a figure of the command line are cut off, overlap, or are smaller than 6 points in print. A second
folder is one of a study, for the figures of its report.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from itertools import combinations
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import imsave
from matplotlib.text import Text
from mpl_toolkits.mplot3d.art3d import Text3D
from numpy.typing import NDArray
from PIL import Image
from twins import IMAGES, deuteranope, grey, inverted

import nullpose
from nullpose.antenna.files import read_pattern
from nullpose.report.figures.dots import draw_comparison
from nullpose.report.figures.pattern import draw_pattern
from nullpose.report.figures.plan import draw_value_map
from nullpose.report.figures.poses import draw_result
from nullpose.report.figures.style import WIDTHS_MM, write_figure
from nullpose.report.figures.sweep import draw_least_tilt, draw_sweep
from nullpose.report.study.cases import report_cases
from nullpose.report.study.figures import figures_of
from nullpose.report.study.summary import summarise
from nullpose.solver import solve
from nullpose.study import compare_schemes
from nullpose.study.least_tilt import least_tilt, values_by_angle
from nullpose.study.monte_carlo import read_study

EXAMPLES = Path(__file__).parents[2] / "examples"
POSES = ("paper", "field", "no-fly", "eavesdropper", "geodetic", "town", "array", "robust")
MAPS = ("no-fly", "geodetic")
LEAST_PT, SLACK_PX = 6.0, 1.0
COLUMN_PX, SCREEN_PX = 416, 900  # 88 mm at 120 dots to the inch, and a page of the documentation
SIDE_BY_SIDE = {COLUMN_PX: 4, SCREEN_PX: 6}
VIEWS = {"light": lambda colours: colours, "dark": inverted, "grey": grey, "deuteranope": deuteranope}
Pixels = NDArray[np.floating]
Widths = tuple[str | None, ...]
BOTH: Widths = ("column", None)
SCREEN: Widths = (None,)


def drawings(study: Path | None) -> Iterator[tuple[str, Callable[[str | None], Figure], Widths]]:
    """Yield the command line's figures with the widths at which each can be drawn.

    Args:
        study: folder of a study whose report's figures are drawn; None for none.
    """
    for name in POSES:
        scenario = nullpose.load(EXAMPLES / f"{name}.toml")
        result = solve(scenario, robust=name == "robust", gap=1e-2, time_limit_s=20.0)
        yield f"solve-{name}", lambda width, result=result: draw_result(result, width), BOTH
        if name in MAPS:
            field = nullpose.value_map(result)
            yield f"map-{name}", lambda width, at=(result, field): draw_value_map(*at, width), BOTH
    paper = nullpose.load(EXAMPLES / "paper.toml")
    table = nullpose.sweep(paper, "jammers.M.power_w", [0.01, 0.1, 1.0, 10.0, 100.0])
    yield "sweep", lambda width: draw_sweep(table, log=True, width=width), BOTH
    yield "sweep-bounds", lambda width: draw_sweep(table, log=True, width=width, bounds=True), BOTH
    schemes = compare_schemes(paper)
    yield "compare", lambda width: draw_comparison(schemes, width), BOTH
    vehicles = nullpose.compare_airframes(nullpose.load(EXAMPLES / "airframe.toml"))
    yield "compare-airframes", lambda width: draw_comparison(vehicles, width), BOTH
    found = least_tilt(paper, mounts_deg=(0.0, 45.0, 90.0))
    values = values_by_angle(found)
    yield "vehicle", lambda width: draw_least_tilt(found, values, width), BOTH
    pattern = read_pattern(EXAMPLES / "hexarotor-433mhz.out.gz", estimate=True)
    yield "antenna", lambda _: draw_pattern(pattern), SCREEN
    if study is not None:
        read = read_study(study)
        for name, figure in figures_of(summarise(read, report_cases(read.spec), 0.0)).items():
            yield f"study-{name}", lambda _, figure=figure: figure, SCREEN


def hidden_labels(figure: Figure) -> Iterator[Text]:
    """Yield the numbers of ticks beyond the ends of the axes, and what ends at an outline."""
    for axes in figure.findobj(Axes):
        yield from (text for text in axes.texts if text.get_clip_on())  # numbers of contours
        for axis in axes._axis_map.values() if axes.name != "3d" else ():  # there all ticks are inside
            drawn = axis._update_ticks()
            for tick in (*axis.majorTicks, *axis.minorTicks):
                if tick not in drawn:
                    yield from (tick.label1, tick.label2)


def faults(figure: Figure) -> list[str]:
    """List letters that are cut off, on other letters, or too small in print."""
    for _ in range(2):
        figure.draw_without_rendering()
    hidden = set(hidden_labels(figure))
    texts = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip()]
    texts = [text for text in texts if not isinstance(text, Text3D)]  # which know their place when drawn
    boxes = [(text, text.get_window_extent()) for text in texts if text not in hidden]
    found = [
        f"cut off: {text.get_text()!r}"
        for text, box in boxes
        if min(box.x0, box.y0) < -SLACK_PX
        or box.x1 > figure.bbox.x1 + SLACK_PX
        or box.y1 > figure.bbox.y1 + SLACK_PX
    ]
    found += [
        f"overlap: {one.get_text()!r} and {other.get_text()!r}"
        for (one, box), (other, beside) in combinations(boxes, 2)
        if one.get_rotation() % 90.0 == other.get_rotation() % 90.0 == 0.0  # else the box is too large
        and box.shrunk(0.9, 0.6).overlaps(beside.shrunk(0.9, 0.6))
    ]
    if any(abs(figure.get_figwidth() - mm / 25.4) < 1e-6 for mm in WIDTHS_MM.values()):
        small = [text for text, _ in boxes if text.get_fontsize() < LEAST_PT]
        found += [f"{text.get_fontsize():.1f} pt: {text.get_text()!r}" for text in small]
    return found


def scaled(path: Path, width_px: int) -> Pixels:
    """Read a picture at a width."""
    with Image.open(path) as picture:
        height_px = round(picture.height * width_px / picture.width)
        return (
            np.asarray(picture.convert("RGB").resize((width_px, height_px), Image.Resampling.LANCZOS)) / 255.0
        )


def sheet(pictures: list[Pixels], across: int) -> Pixels:
    """Set pictures of one width in columns, each below the shortest so far."""
    width = pictures[0].shape[1]
    columns: list[list[Pixels]] = [[] for _ in range(across)]
    for picture in pictures:
        shortest = min(columns, key=lambda column: sum(len(each) for each in column))
        shortest += [picture, np.full((12, width, 3), 0.8)]
    longest = max(sum(len(each) for each in column) for column in columns)
    padded = []
    for column in columns:
        empty = longest - sum(len(each) for each in column)
        padded += [np.vstack([*column, np.full((empty, width, 3), 0.8)]), np.full((longest, 12, 3), 0.8)]
    return np.hstack(padded)


def main(folder: Path, study: Path | None = None) -> int:
    """Write the figures and the sheets to a folder; return how many faults there are.

    Args:
        folder: is made.
        study: folder of a study whose report's figures are on the sheets too.
    """
    folder.mkdir(parents=True, exist_ok=True)
    count = 0
    by_width: dict[int, list[Path]] = {COLUMN_PX: [], SCREEN_PX: []}
    for name, draw, widths in drawings(study):
        for width in widths:
            figure, pixels = draw(width), SCREEN_PX if width is None else COLUMN_PX
            for fault in faults(figure):
                count += 1
                print(f"{name}, {width or 'screen'}: {fault}")
            by_width[pixels].append(*write_figure(figure, folder / f"{name}-{width or 'screen'}.png"))
    pages = [path for path in sorted(IMAGES.glob("*.png")) if not path.stem.endswith("-dark")]
    by_width[SCREEN_PX] += pages
    for pixels, paths in by_width.items():
        pictures = [scaled(path, pixels) for path in paths]
        for view, seen in VIEWS.items():
            whole = sheet([np.clip(seen(picture), 0.0, 1.0) for picture in pictures], SIDE_BY_SIDE[pixels])
            imsave(folder / f"sheet-{'column' if pixels == COLUMN_PX else 'screen'}-{view}.png", whole)
    return count


if __name__ == "__main__":
    sys.exit(min(main(*map(Path, sys.argv[1:] or ["out"])), 1))
