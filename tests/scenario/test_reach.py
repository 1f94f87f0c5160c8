"""Whether an airspace has room, and whether what is uncertain reaches into it."""

import re
import time
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario import Airspace, Scenario
from nullpose.scenario.reach import may_hold_a_position
from scenes import NODE, small

SQUARE = [[0, 0], [10, 0], [10, 10], [0, 10]]


def faults(airspace: object = None, jammer: object = None, receiver: object = None) -> tuple[Fault, ...]:
    """Returns the faults of the paper's scene with keys added to some of its tables."""
    paper = small(
        airspace={"altitude_m": [8.0, 30.0]} | (airspace or {}),
        receiver={"noise_w": 1e-3, "reference_gain_db": 0.0} | (receiver or {}),
        nodes=[NODE, NODE | {"position_m": [0.0, 50.0, 0.0]}],
        jammers=[{"position_m": [17.0, 15.0, 4.0], "power_w": 1.0} | (jammer or {})],
    )
    try:
        Scenario.from_dict(paper)
    except ScenarioError as error:
        return error.faults
    return ()


ALL = {"x_m": [-1, 11], "y_m": [-1, 11]}
HALVES = [{"x_m": [-1, 6], "y_m": [-1, 11]}, {"x_m": [4, 11], "y_m": [-1, 11]}]


@pytest.mark.parametrize(
    ("room", "airspace"),
    [
        (False, {"geofence_m": SQUARE, "no_fly": [{"centre_m": [5, 5], "radius_m": 8}]}),
        (False, {"geofence_m": SQUARE, "x_m": [10.5, 30]}),
        (False, {"x_m": [0, 10], "y_m": [0, 10], "no_fly": HALVES}),
        (False, {"geofence_m": SQUARE, "no_fly": [{"polygon_m": [[-1, -1], [30, -1], [-1, 30]]}]}),
        (
            False,
            {"geofence_m": SQUARE, "no_fly": [ALL | {"altitude_m": [0, 20]}, ALL | {"altitude_m": [15, 40]}]},
        ),
        (False, {"geofence_m": SQUARE, "altitude_m": [8, 8], "keep_out_m": 20.0}),
        (True, {"geofence_m": SQUARE, "no_fly": [{"centre_m": [5, 5], "radius_m": 7.05}]}),
        (True, {"geofence_m": SQUARE, "x_m": [10, 30]}),
        (True, {"geofence_m": SQUARE, "no_fly": [{"x_m": [0, 10], "y_m": [0, 10]}]}),  # its border is left
        (True, {"no_fly": [{"centre_m": [0, 0], "radius_m": 1e6}]}),
        (True, {"x_m": [0, 10], "no_fly": [{"x_m": [-1, 11], "y_m": [-1e6, 1e6]}]}),
        (True, {"geofence_m": SQUARE, "no_fly": [ALL | {"altitude_m": [0, 29.9]}]}),
        (True, {"geofence_m": SQUARE, "altitude_m": [8, 8], "keep_out_m": 9.4}),
    ],
)
def test_room_is_what_fence_zones_and_balls_leave(room: bool, airspace: dict[str, Any]) -> None:
    """A corner, a border or a layer that is left is room; where nothing is, the airspace is at fault."""
    found = [(fault.path, "there is no room for the vehicle" in fault.message) for fault in faults(airspace)]
    assert found == ([] if room else [("airspace", True)])


@pytest.mark.parametrize(
    ("jammer", "receiver", "words"),
    [
        ({"uncertainty_m": 4.0}, {}, "make keep_out_m more than 4"),
        ({"uncertainty_m": 5.0}, {}, "inside the airspace"),
        ({"uncertainty_m": 4.5}, {}, "more than 4.5"),
        ({"uncertainty_m": 30}, {}, "keep the airspace away"),
        ({"uncertainty_m": 3.0}, {"position_error_m": 1.5}, "position_error_m = 1.5"),
    ],
)
def test_uncertainty_that_reaches_in(jammer: dict[str, Any], receiver: dict[str, Any], words: str) -> None:
    """A set, with the vehicle's own error, that holds an allowed position is a fault of the set."""
    (fault,) = faults(jammer=jammer, receiver=receiver)
    assert fault.path == "jammers[0].uncertainty_m"
    assert words in fault.message


@pytest.mark.parametrize(
    "airspace",
    [
        {"keep_out_m": 6.0},
        {"no_fly": [{"centre_m": [17, 15], "radius_m": 5.5}]},
        {"no_fly": [{"x_m": [10, 24], "y_m": [8, 22], "altitude_m": [0, 10]}]},
        {"geofence_m": [[-40, -20], [10, -20], [10, 70], [-40, 70]]},
        {"x_m": [-50, 10]},
    ],
)
def test_an_airspace_kept_away(airspace: dict[str, Any]) -> None:
    """A larger keep-out radius, a zone, a fence or a bound keeps the vehicle away from a set."""
    assert faults(jammer={"uncertainty_m": 5.0})
    assert faults(airspace, {"uncertainty_m": 5.0}) == ()


@given(
    seed=st.integers(0, 2**32 - 1),
    error=st.sampled_from([0.0, 0.5]),
    keep_out=st.sampled_from([0.5, 3.0, 20.0]),
)
def test_the_witness_is_one(seed: int, error: float, keep_out: float) -> None:
    """The place named is allowed, and no further from the set than the vehicle's error."""
    rng = np.random.default_rng(seed)
    radius = rng.uniform(0.5, 8.0)
    found = faults(
        {"keep_out_m": keep_out, "no_fly": [{"centre_m": [18, 15], "radius_m": 4}]},
        {"uncertainty_m": radius},
        {"position_error_m": error},
    )
    for fault in found:
        place = np.array([float(x) for x in re.search(r"at \[(.*?)\]", fault.message)[1].split(",")])
        offset = place - [17.0, 15.0, 4.0]
        assert place[2] >= 8.0 - 1e-2
        assert np.linalg.norm(place[:2] - [18, 15]) >= 4.0 - 1e-2
        assert keep_out - 1e-2 <= np.linalg.norm(offset) <= radius + error + 1e-2
    if radius + error < keep_out or radius + error < 4.0:
        assert found == ()


def test_an_error_of_the_vehicle_alone() -> None:
    """A vehicle that may be off by more than the keep-out radius may meet points that are known exactly."""
    assert faults(receiver={"position_error_m": 7.9}) != ()  # the jammer is 4 m below the floor
    assert faults(receiver={"position_error_m": 3.9}) == ()
    assert faults({"keep_out_m": 9.0}, receiver={"position_error_m": 8.5}) == ()
    found = faults(receiver={"position_error_m": 8.5})
    assert {fault.path for fault in found} == {"receiver.position_error_m"}
    assert all("make keep_out_m more than 8.5" in fault.message for fault in found)
    for fault, point in zip(found, ("nodes[0]", "nodes[1]", "jammers[0]"), strict=True):
        assert f"may meet {point}" in fault.message


def ring(count: int, radius_m: float) -> list[list[float]]:
    """Returns a polygon of many corners around the middle of the scene."""
    angles = np.arange(count) * 2.0 * np.pi / count
    return (radius_m * np.stack([np.cos(angles), np.sin(angles)], axis=1) + [5.0, 25.0]).tolist()


def test_corners_are_counted_in_all() -> None:
    """A fence and zones with too many corners together are refused; one corner less is accepted."""
    zones = [{"polygon_m": ring(1200, 5.0 + size)} for size in range(4)]
    zones.append({"centre_m": [0, 9], "radius_m": 1})
    assert not faults({"geofence_m": ring(199, 80.0), "no_fly": zones})
    (fault,) = faults({"geofence_m": ring(200, 80.0), "no_fly": zones})
    assert fault.path == "airspace"
    assert "have 5001 corners, must be at most 5000 in all; leave out" in fault.message


def test_intricate_airspaces_are_judged_quickly() -> None:
    """Where room is hard to find among 5,000 corners, it is not looked for without end."""
    spikes = np.array(ring(4990, 40.0))
    spikes[::2] = 0.5 * spikes[::2] + [2.5, 12.5]
    walls = [{"x_m": [-60, 5], "y_m": [-60, 90]}, {"x_m": [5, 70], "y_m": [-60, 90]}]
    began = time.process_time()
    assert not faults({"geofence_m": spikes.tolist(), "no_fly": walls})
    assert time.process_time() - began < 60.0


Range = tuple[float, float]


def has_room(x_m: Range, y_m: Range, altitude_m: Range, centres: np.ndarray, radius: float) -> bool:
    """Returns whether a box holds a position outside balls."""
    airspace = Airspace(keep_out_m=radius, x_m=x_m, y_m=y_m, altitude_m=altitude_m)
    return may_hold_a_position(airspace, centres)


@pytest.mark.parametrize("excess", [-0.002, 0.002])
def test_room_left_inside_a_face_only(excess: float) -> None:
    """Discs on a triangular lattice leave a hole until the radius is the side over the square root of 3."""
    rows, columns = np.meshgrid(np.arange(-6, 7), np.arange(-6, 7))
    lattice = np.stack([columns + 0.5 * rows, rows * np.sqrt(0.75), 0.0 * rows], axis=-1).reshape(-1, 3)
    centres = lattice[np.abs(lattice[:, :2]).max(axis=1) < 2.5]
    # A box around the hole between (0, 0), (1, 0) and (1/2, sqrt(3)/2).
    radius = 1.0 / np.sqrt(3.0) + excess
    assert has_room((0.4, 0.6), (0.2, 0.4), (0, 0), centres, radius) is (excess < 0.0)


def test_many_balls_in_few_seconds() -> None:
    """A hundred balls, none of which covers the box alone, are judged by all their triples."""
    centres = np.random.default_rng(7).uniform(-0.5, 1.5, size=(100, 3))
    assert not has_room((0, 1), (0, 1), (0, 1), centres, 0.8)


coordinate = st.integers(-8, 8).map(lambda eighth: eighth / 8.0)
corner = st.integers(0, 3).map(lambda quarter: quarter / 4.0)


@given(
    st.lists(st.tuples(coordinate, coordinate, coordinate), min_size=1, max_size=7, unique=True),
    st.tuples(corner, corner, corner),
    st.floats(0.3, 1.4),
)
def test_agrees_with_sampling(
    centres: list[tuple[float, ...]], sides: tuple[float, ...], radius: float
) -> None:
    """Where a position of a dense grid is free there is room; where all are deep in balls there is none."""
    axes = [np.linspace(0.0, side, 17 if side else 1) for side in sides]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    clearance = np.linalg.norm(grid[:, None] - np.array(centres), axis=-1).min(axis=1).max() - radius
    spacing = np.linalg.norm(np.array(sides) / 16.0) / 2.0  # no position is farther than this from the grid
    room = has_room(*((0.0, side) for side in sides), np.array(centres), radius)
    if clearance >= 0.0:
        assert room
    elif clearance < -spacing:
        assert not room
