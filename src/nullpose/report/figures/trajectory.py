"""A flight: from above, its values and the attitude over time, and as a film."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
from matplotlib.animation import PillowWriter
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from nullpose.files import replacing
from nullpose.objectives import IntArray
from nullpose.physics.types import FloatArray
from nullpose.report.figures.names import place_names, write_name
from nullpose.report.figures.plan import NULL_LINE, draw_areas, filled
from nullpose.report.figures.plan_scene import PlanScene
from nullpose.report.figures.style import DRONE, GREY, INK, JAMMER, MARKS, NULL, Look, house_style
from nullpose.report.geometry import azimuth_rad, tilt_rad
from nullpose.report.numbers import capitalised, number
from nullpose.scenario.motion import places_m
from nullpose.solver.trajectory import Aim, Trajectory
from nullpose.solver.trajectory.result import from_nats

_AXIS, _FREE, _SEEN = 0.04, 0.1, 0.5  # half an axis, ground around, tracks: shares of the extent
_MARKS, _LEAST_M = 9, 1.0  # instants with marks at most, and an extent
_RIM: Look = {"edgecolors": "white", "linewidths": 0.5, "s": 30}
_SHAPES = {"plan": (5.8, 5), "values": (3.8, 2), "attitude": (4.6, 2)}  # inches high, columns of the legend
_FILM_INCH, _FILM_DPI, _FRAMES, _A_SECOND = (4.8, 4.2), 100, 60, 10


def instant_words(flight: Trajectory) -> str:
    """Name what a flight has at an instant, as in "smallest SINR"."""
    smallest = flight.quantity.smallest
    return f"rate log2(1 + {smallest})" if flight.maximise is Aim.MEAN_RATE else smallest


def draw_flight(flight: Trajectory, samples: FloatArray) -> dict[str, Figure]:
    """Draw a flight from above, its values and its attitude over time; return the figures by name.

    Args:
        flight: the trajectory.
        samples: times and values at and between the instants, (2, n).
    """
    with house_style():
        figures = {name: Figure((7.0, high), layout="constrained") for name, (high, _) in _SHAPES.items()}
        _draw_plan(figures["plan"], flight)
        _draw_values(figures["values"].add_subplot(), flight, samples)
        _draw_attitude(figures["attitude"], flight)
        for name, figure in figures.items():
            figure.axes[0].set_title(flight.scenario.name, fontsize=10, wrap=True, parse_math=False)
            marks = dict(zip(*figure.axes[0].get_legend_handles_labels()[::-1], strict=True))
            figure.legend(marks.values(), marks, loc="outside lower center", ncols=_SHAPES[name][1])
        place_names(figures["plan"].axes[0])
    return figures


def write_film(flight: Trajectory, path: Path) -> None:
    """Write a flight as an animated GIF of at most 60 frames.

    Raises:
        OutputError: the file cannot be written.
    """
    with house_style(), replacing(path) as temporary:
        figure = Figure(figsize=_FILM_INCH, layout="constrained")
        axes = figure.add_subplot()
        _, axis, dots = _draw_scene(axes, flight, np.array([0]))
        place_names(axes)
        writer, values = PillowWriter(fps=_A_SECOND), _in_unit(flight, flight.values)
        writer.setup(figure, temporary, dpi=_FILM_DPI)
        for index in np.unique(np.linspace(0, len(values) - 1, _FRAMES).round().astype(int)):
            axis.set_data(*_axis_ends_m(axes, flight, index).T)
            for dot, track_m in dots:
                dot.set_offsets(track_m[index])
            axes.set_title(
                f"{flight.times_s[index]:.1f} s, {flight.positions_m[index, 2]:.1f} m up: "
                f"{number(float(values[index]), flight.quantity)} {flight.unit}",
                fontsize=9,
            )
            if index == 0:
                figure.draw_without_rendering()
                figure.set_layout_engine("none")  # which would shift the ground from frame to frame
            writer.grab_frame()
        writer.finish()


def marked_instants(flight: Trajectory) -> IntArray:
    """Return the indices of the instants that have marks, at even steps of way and time."""
    flown_m = np.append(0.0, np.cumsum(flight.speeds_m_s * np.diff(flight.times_s)))
    shares = flown_m / max(_LEAST_M, flown_m[-1]) + flight.times_s / flight.times_s[-1]
    return np.unique(np.searchsorted(shares, np.linspace(0.0, shares[-1], _MARKS)))


def _draw_plan(figure: Figure, flight: Trajectory) -> None:
    axes, marked = figure.add_subplot(), marked_instants(flight)
    line, _, dots = _draw_scene(axes, flight, marked)
    for (dot, track_m), index in product((each for each in dots if np.ptp(each[1], axis=0).any()), marked):
        colour = to_hex(np.ravel(dot.get_facecolor())[:4].tolist())
        write_name(axes, f"{flight.times_s[index]:.4g} s", track_m[index], colour=colour)
    figure.colorbar(line, ax=axes, label="Time (s)", shrink=0.85, aspect=30)


def _draw_scene(
    axes: Axes, flight: Trajectory, marked: IntArray
) -> tuple[LineCollection, Line2D, list[tuple[PathCollection, FloatArray]]]:
    """Draw the ground, all tracks and the flight, with marks at some instants.

    Returns:
        The line of the flight, the last of the antenna's, and the marks of the drone and of each point with
        their tracks from above, (t, 2), metres.
    """
    scenario, flown_m = flight.scenario, flight.positions_m[:, :2]
    tracks_m = [places_m(point, scenario.origin, flight.times_s)[:, :2] for point in scenario.points]
    _set_frame(axes, flown_m, np.stack(tracks_m))
    draw_areas(axes, PlanScene(scenario=scenario.at(0.0), poses=flight.poses))
    line = LineCollection(
        [*np.stack([flown_m[:-1], flown_m[1:]], axis=1)],
        array=flight.times_s[:-1],
        clim=(0.0, flight.times_s[-1]),
        cmap="viridis",
        linewidths=2.4,
        zorder=5.0,
        capstyle="round",
    )
    axes.add_collection(line)
    for index in marked:
        (axis,) = axes.plot(
            *_axis_ends_m(axes, flight, index).T, zorder=6.0, label="antenna axis (null)", **NULL_LINE
        )
    dots = [(axes.scatter(*flown_m[marked].T, color=DRONE, zorder=7.0, label="drone", **_RIM), flown_m)]
    for point, track_m in zip(scenario.points, tracks_m, strict=True):
        kind = type(point).__name__.lower()
        colour, marker = MARKS.get(kind, MARKS["node"])
        axes.plot(*track_m.T, color=colour, linewidth=1.0, linestyle=(0, (3, 1.5)), zorder=1.5)
        dots.append(
            (
                axes.scatter(*track_m[marked].T, color=colour, marker=marker, zorder=3.0, label=kind, **_RIM),
                track_m,
            )
        )
        seen_m = [place_m for place_m in track_m if axes.viewLim.contains(*place_m)] or [track_m[0]]
        write_name(axes, point.name, seen_m[len(seen_m) // 2], is_bold=True)
    return line, axis, dots


def _set_frame(axes: Axes, flown_m: FloatArray, tracks_m: FloatArray) -> None:
    """Show the flight, what stands, and of the tracks, (n, t, 2), what is not far from these."""
    around_m = np.vstack([flown_m, tracks_m[~np.ptp(tracks_m, axis=1).any(axis=1), 0]])
    low, high = around_m.min(axis=0), around_m.max(axis=0)
    size_m = max(_LEAST_M, float(np.max(high - low)))
    near_m = np.vstack([around_m, *tracks_m]).clip(low - _SEEN * size_m, high + _SEEN * size_m)
    ends_m = np.stack([near_m.min(axis=0) - _FREE * size_m, near_m.max(axis=0) + _FREE * size_m])
    (west, south), (east, north) = filled(axes, ends_m)
    axes.set(
        xlim=(west, east), ylim=(south, north), aspect="equal", xlabel="East x (m)", ylabel="North y (m)"
    )


def _axis_ends_m(axes: Axes, flight: Trajectory, index: int) -> FloatArray:
    """Compute the ends of a line along the antenna at an instant as it is seen from above, (2, 2), metres."""
    half_m = _AXIS * max(axes.viewLim.size) * flight.poses[index].antenna_axis[:2]
    return np.asarray(flight.positions_m[index, :2] + np.outer((-1.0, 1.0), half_m))


def _draw_values(axes: Axes, flight: Trajectory, samples: FloatArray) -> None:
    """Draw the value at and between the instants, the best of each instant alone, and the bound."""
    best, values, between = (
        _in_unit(flight, each) for each in (flight.optimum_values, flight.values, samples[1])
    )
    axes.plot(flight.times_s, best, color=GREY, label="best pose of each instant alone")
    axes.plot(samples[0], between, color=INK, linewidth=0.8, label="between instants (estimate)")
    axes.plot(flight.times_s, values, ".", color=INK, markersize=5.0, label="the flight at the instants")
    kind = "worst" if flight.maximise.is_worst else "mean"
    axes.axhline(flight.value, color=INK, linestyle=":", linewidth=1.2, label=f"{kind} of the flight")
    axes.axhline(
        flight.upper_bound, color=JAMMER, ls="--", linewidth=1.2, label=f"no flight has its {kind} above"
    )
    axes.set(xlabel="Time (s)", ylabel=f"{capitalised(instant_words(flight))} ({flight.unit})")


def _draw_attitude(figure: Figure, flight: Trajectory) -> None:
    """Draw the tilt of the antenna and of the vehicle, and the antenna's azimuth; its sign is that flown."""
    angles = [(tilt_rad(pose, False), azimuth_rad(pose, False), pose.tilt_rad) for pose in flight.poses]
    above, below = figure.subplots(2, 1, sharex=True)
    antenna, azimuth, vehicle = np.degrees(np.unwrap(angles, axis=0).T)
    above.plot(flight.times_s, antenna, ".-", color=INK, markersize=4.0, label="antenna")
    above.plot(flight.times_s, vehicle, "--", color=NULL, linewidth=1.2, label="vehicle")
    below.plot(flight.times_s, azimuth, ".-", color=INK, markersize=4.0)
    above.set(ylabel="Tilt from vertical (°)")
    below.set(xlabel="Time (s)", ylabel="Antenna's azimuth (°)\n0 east, 90 north")


def _in_unit(flight: Trajectory, values: FloatArray) -> FloatArray:
    """Convert values of instants to the unit of what is maximised."""
    with np.errstate(divide="ignore"):
        logs = flight.maximise.gains(np.log(flight.quantity.to_ratio(values)))
    return np.array([from_nats(flight.quantity, flight.maximise, log) for log in logs.tolist()])
