"""A trajectory as tables, and its files in a folder."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from importlib.util import find_spec
from pathlib import Path
from types import MappingProxyType

import numpy as np

from nullpose.files import json_text, prepare_folder, replacing
from nullpose.physics.types import FloatArray
from nullpose.report.document import View, document, head, pairs, table
from nullpose.report.export.geojson import flight_geojson_file
from nullpose.report.export.mcap import flight_mcap_file
from nullpose.report.export.plain import flight_csv_file, flight_tum_file
from nullpose.report.export.plan import flight_plan_file
from nullpose.report.figures.style import write_figure
from nullpose.report.figures.trajectory import draw_flight, instant_words, write_film
from nullpose.report.geometry import tilt_rad
from nullpose.report.results import azimuth_text
from nullpose.scenario import Scenario
from nullpose.solver import Rigour
from nullpose.solver.trajectory import Trajectory
from nullpose.study.between_instants import PARTS

_FILES: Mapping[str, Callable[[Trajectory], bytes]] = MappingProxyType(
    {
        "trajectory.json": lambda flight: f"{json_text(flight.to_dict())}\n".encode(),
        "trajectory.csv": flight_csv_file,
        "trajectory.tum": flight_tum_file,
        "trajectory.geojson": flight_geojson_file,
        "trajectory.plan": flight_plan_file,
        "trajectory.mcap": flight_mcap_file,
    }
)
_FIGURES, _FILM, _MAPS = ("plan.png", "values.png", "attitude.png"), "flight.gif", (".geojson", ".plan")
_BOUNDS = MappingProxyType(
    {
        "clairvoyant": "the best of each instant alone (clairvoyant)",
        "key-instants": "the instants that decide, and the reach between them (key instants)",
        "prices": "prices of the speed limit (Lagrangian)",
    }
)
_FLIGHTS = MappingProxyType(
    {
        "hover": "hover: one place, turning",
        "greedy": "greedy: to each best place",
        "window": "seeing the window ahead",
        "trajectory": "this trajectory",
        "clairvoyant": "clairvoyant bound: no speed limit",
    }
)
_SHOWN, _NOTABLE = 15, 0.5  # rows of instants, and how far below the worst of them a sample is told first


def file_names(scenario: Scenario) -> list[str]:
    """List the files of a trajectory: those for maps only with an origin, MCAP only with its library."""
    left_out = dict.fromkeys(_MAPS, scenario.origin is None) | {".mcap": find_spec("mcap_ros2") is None}
    return [name for name in (*_FILES, *_FIGURES, _FILM) if not left_out.get(Path(name).suffix)]


def write_trajectory(flight: Trajectory, samples: FloatArray, folder: Path) -> list[Path]:
    """Write a trajectory as files and figures; return the paths.

    Args:
        flight: the trajectory.
        samples: times and values at and between the instants, (2, n).
        folder: is made if need be; files in it of the same names are replaced.

    Raises:
        OutputError: a file cannot be written.
    """
    paths = [prepare_folder(folder) / name for name in file_names(flight.scenario)]
    for path in (path for path in paths if path.name in _FILES):
        with replacing(path) as temporary:
            temporary.write_bytes(_FILES[path.name](flight))
    for name, figure in draw_flight(flight, samples).items():
        write_figure(figure, folder / f"{name}.png")
    write_film(flight, folder / _FILM)
    return paths


def flight_words(flight: Trajectory, samples: FloatArray) -> tuple[str, ...]:
    """Say what a trajectory has: its value, how low it falls between the instants, and lines on the bound.

    Args:
        flight: the trajectory.
        samples: times and values at and between the instants, (2, n).
    """
    unit, what, is_worst = flight.unit, instant_words(flight), flight.maximise.is_worst
    words = f"{what} at the worst instant" if is_worst else f"mean {what} of the instants"
    lowest, loss = _lowest_sample(flight, samples)
    return (
        f"{words} {flight.value:z.4f} {unit}",
        *([f"between the instants it falls to {lowest} (estimate)"] if loss > _NOTABLE else []),
        f"upper bound {math.ceil(1e4 * flight.upper_bound) / 1e4:z.4f} {unit} (gap {flight.gap:.2g} {unit}), "
        f"from {_BOUNDS[flight.bound_name]}",
        flight.status.message.removeprefix("certified ") + (flight.reason and f": {flight.reason}"),
        Rigour.FLOATING_POINT.message,
        f"the bound is of {'any flight in continuous time' if is_worst else 'the mean of the instants only'}",
        f"{len(flight.poses)} instants; {flight.stats.wall_s:.2g} s",
    )


def trajectory_view(flight: Trajectory, samples: FloatArray) -> View:
    """Set a trajectory as tables: value and bound, what planning is worth, motion, and the instants.

    Args:
        flight: the trajectory.
        samples: times and values at and between the instants, (2, n).
    """
    value, *lines = flight_words(flight, samples)
    step = -(-len(flight.poses) // _SHOWN)
    return document(
        head(flight.scenario.name, "Trajectory", value, lines),
        table("What planning is worth", _worth(flight)),
        pairs("Motion", _motion(flight, samples)),
        table("Instants", _instants(flight)[::step]),
        f"One row in {step} is shown." if step > 1 else None,
    )


def _worth(flight: Trajectory) -> list[dict[str, str]]:
    values = dict(flight.baselines) | {"trajectory": flight.value}
    return [
        {
            "flight": words,
            f"{flight.maximise} ({flight.unit})": f"{value:z.4f}",
            f"difference ({flight.unit})": f"{value - flight.value:+z.4f}",
        }
        for name, words in _FLIGHTS.items()
        if (value := values.get(name)) is not None
    ]


def _motion(flight: Trajectory, samples: FloatArray) -> list[tuple[str, str | None]]:
    airframe = flight.scenario.airframe
    lowest, loss = _lowest_sample(flight, samples)
    return [
        (
            "largest speed",
            f"{np.max(flight.speeds_m_s):.4g} m/s, limit {airframe and airframe.speed_max_m_s:g} m/s",
        ),
        ("largest turn rate", f"{np.degrees(np.max(flight.turn_rates_rad_s)):.3g} deg/s, without a limit"),
        ("between instants", f"lowest {lowest}, an estimate by {PARTS} samples a step"),
        ("", f"{loss:.2g} {flight.quantity.unit} below the worst instant" if loss > 0.0 else None),
    ]


def _lowest_sample(flight: Trajectory, samples: FloatArray) -> tuple[str, float]:
    """Return the lowest sample in words, and how far it is below the worst instant, in its unit."""
    lowest, at_instants = (
        flight.quantity.in_unit(float(np.min(each))) for each in (samples[1], flight.values)
    )
    place = f"{lowest:z.4f} {flight.quantity.unit} at {samples[0, np.argmin(samples[1])]:.4g} s"
    return place, at_instants - lowest


def _instants(flight: Trajectory) -> list[dict[str, str]]:
    quantity = flight.quantity
    return [
        {
            "time (s)": f"{row['time_s']:.4g}",
            "position (m)": " ".join(f"{x:z.2f}" for x in row["position_m"]),
            "axis tilt (deg)": f"{math.degrees(tilt_rad(pose)):.1f}",
            "azimuth (deg)": azimuth_text(pose, -2),
            f"{quantity.smallest_short} ({quantity.unit})": f"{row[f'value_{quantity.ending}']:z.4f}",
            "alone": f"{row[f'optimum_{quantity.ending}']:z.4f}",
        }
        for row, pose in zip(flight.rows(), flight.poses, strict=True)
    ]
