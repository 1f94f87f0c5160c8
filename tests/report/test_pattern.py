"""What a pattern file holds, in words."""

import dataclasses
import io

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from rich.console import Console

from nullpose.antenna.summary import PatternSummary, summary_of
from nullpose.antenna.table import PatternTable
from nullpose.report.figures.pattern import draw_pattern
from nullpose.report.pattern import pattern_view


def told(summary: PatternSummary) -> str:
    """Returns what is printed."""
    console = Console(file=io.StringIO(), width=200)
    console.print(pattern_view(summary))
    return console.file.getvalue()


def test_an_isotropic_table_without_frequency() -> None:
    """No null is invented, no frequency and no size; notes and what is not known are told."""
    table = PatternTable(
        theta_deg=np.arange(0.0, 181.0, 15.0),
        phi_deg=np.arange(0.0, 360.0, 15.0),
        gain=np.ones((13, 24)),
        source="x.csv (csv)",
        notes=("A note.",),
    )
    text = told(summary_of(table))
    assert "x.csv (csv)" in text.splitlines()[0]
    assert "deepest null      none" in text
    assert "polarisation      not known" in text
    assert text.rstrip().endswith("A note.")
    coarse = dataclasses.replace(summary_of(table), null_db=12.34, null_deg=(30.0, 45.0))
    assert "12.3 dB below the peak, at theta 30, phi 45" in told(coarse)


def table_of(step_deg: float = 5.0) -> PatternTable:
    """Returns a pattern that leans forward and up, with a null behind."""
    theta_deg, phi_deg = np.arange(0.0, 180.1, step_deg), np.arange(0.0, 360.0, step_deg)
    theta, phi = np.meshgrid(np.radians(theta_deg), np.radians(phi_deg), indexing="ij")
    gain = np.maximum(1.0 + 0.5 * np.cos(theta) + 0.8 * np.sin(theta) * np.cos(phi - 0.3), 0.0)
    return PatternTable(theta_deg=theta_deg, phi_deg=phi_deg, gain=gain, source="lean.csv (csv)")


@pytest.fixture(scope="module")
def figure() -> Figure:
    """The figure of a pattern, drawn."""
    drawn = draw_pattern(table_of())
    FigureCanvasAgg(drawn).draw()
    return drawn


def test_the_cuts_are_the_tables(figure: Figure) -> None:
    """Each line is the table's row or columns in dBi, at the angle that it stands for."""
    table = table_of()
    gain_dbi = np.maximum(10.0 * np.log10(np.maximum(table.gain, 1e-30)), 5.0 - 40.0)
    azimuth, front, side = (axes.lines[0].get_xydata() for axes in figure.axes[:3])
    assert azimuth[:-1, 1] == pytest.approx(gain_dbi[18])
    for line, column in ((front, 0), (side, 18)):
        assert line[:37, 1] == pytest.approx(gain_dbi[:, column])
        assert line[36:73, 1] == pytest.approx(gain_dbi[::-1, column + 36])
    for line in (azimuth, front, side):
        assert np.degrees(line[:-1, 0]) == pytest.approx(np.arange(0.0, 360.0, 5.0))


def test_no_word_touches_another(figure: Figure) -> None:
    """Titles, angles, rings and the bar's numbers stand apart, all within the figure."""
    texts = [*figure.texts]
    for axes in (axes for axes in figure.axes if axes.axison):  # the surface has none but its axes' names
        texts += [axes.title, *axes.texts, *axes.get_xticklabels(), *axes.get_yticklabels()]
    boxes = [
        (text.get_text(), text.get_window_extent())
        for text in texts
        if text.get_text() and text.get_visible()
    ]
    pairs = [
        (one[0], other[0])
        for i, one in enumerate(boxes)
        for other in boxes[i + 1 :]
        if one[1].overlaps(other[1])
    ]
    assert pairs == []
    width, height = figure.canvas.get_width_height()
    assert all(box.x0 >= 0 and box.x1 <= width and box.y0 >= 0 and box.y1 <= height for _, box in boxes)


@pytest.mark.parametrize("step_deg", [1.0, 20.0, 36.0])
def test_any_grid_can_be_drawn(step_deg: float) -> None:
    """Fine grids, and coarse ones without a row at 90 degrees, name the angles that they have."""
    drawn = draw_pattern(table_of(step_deg))
    near = min(np.arange(0.0, 180.1, step_deg), key=lambda angle: abs(angle - 90.0))
    assert f"theta {near:g}," in drawn.axes[0].get_title()
    assert len(drawn.axes) == 5
