"""Zones that the vehicle stays out of."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.errors import ScenarioError
from nullpose.scenario import NoFlyZone, Scenario
from scenes import require_fault

SEEDS = st.integers(0, 2**32 - 1)
ANGLES = np.linspace(0.0, 2.0 * np.pi, 200, endpoint=False)
SIDES = {"x_m": [0, 1], "y_m": [0, 1]}
BOX = NoFlyZone(x_m=(-2.0, 3.0), y_m=(1.0, 5.0), altitude_m=(10.0, 20.0))


def test_shapes() -> None:
    """Each zone knows its shape and, seen from above, its outline, counter-clockwise."""
    prism = NoFlyZone(polygon_m=[[0, 0], [0, 3], [4, 0]])
    cylinder = NoFlyZone(centre_m=[17, 15], radius_m=5)
    assert (BOX.shape, prism.shape, cylinder.shape) == ("box", "polygon", "cylinder")
    np.testing.assert_array_equal(BOX.outline_m, [[-2, 1], [3, 1], [3, 5], [-2, 5]])
    np.testing.assert_array_equal(prism.outline_m, [[4, 0], [0, 3], [0, 0]])
    assert cylinder.outline_m.shape == (0, 2)


@pytest.mark.parametrize(
    ("allowed", "forbidden"),
    [
        ((8.0, 30.0), (10.0, 20.0)),
        ((10.0, 30.0), (-math.inf, 20.0)),
        ((12.0, 30.0), (-math.inf, 20.0)),
        ((8.0, 20.0), (10.0, math.inf)),
        ((12.0, 18.0), (-math.inf, math.inf)),
        ((15.0, 15.0), (-math.inf, math.inf)),
        ((20.0, 30.0), (10.0, 20.0)),  # these three touch, which is allowed
        ((5.0, 10.0), (10.0, 20.0)),
        ((10.0, 10.0), (10.0, 20.0)),
    ],
)
def test_altitudes_where_not_all_are_allowed(
    allowed: tuple[float, float], forbidden: tuple[float, float]
) -> None:
    """A zone that covers the airspace's floor or ceiling leaves no sheet of it allowed."""
    assert BOX.forbidden_range_m(allowed) == forbidden
    place = [0.0, 3.0, allowed[0]]
    assert (BOX.depth_m(place, allowed) > 0.0) == (forbidden[0] < allowed[0] < forbidden[1])


@given(SEEDS)
def test_a_box_is_a_polygon_too(seed: int) -> None:
    """A box stated by its sides and by its corners has the same depths, and turning both changes none."""
    rng = np.random.default_rng(seed)
    places = rng.uniform([-6.0, -3.0, 5.0], [7.0, 9.0, 25.0], (100, 3))
    corners = BOX.outline_m
    prism = NoFlyZone(polygon_m=corners, altitude_m=(10.0, 20.0))
    np.testing.assert_array_equal(BOX.depth_m(places), prism.depth_m(places))
    angle = rng.uniform(-np.pi, np.pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turned = NoFlyZone(polygon_m=corners @ turn.T, altitude_m=(10.0, 20.0))
    turned_places = np.concatenate([places[:, :2] @ turn.T, places[:, 2:]], axis=1)
    np.testing.assert_allclose(turned.depth_m(turned_places), BOX.depth_m(places), atol=1e-12)


@pytest.mark.parametrize(
    ("values", "path", "words"),
    [
        ({}, "", "neither x_m and y_m nor centre_m and radius_m nor polygon_m is given, exactly one"),
        ({"x_m": [0, 1]}, "", "x_m given without y_m; add it"),
        ({"radius_m": 1.0}, "", "radius_m given without centre_m or centre_lat_lon_deg; add it"),
        (SIDES | {"radius_m": 1.0}, "", "x_m and y_m and radius_m are given, exactly one is allowed"),
        ({"centre_m": [0, 0], "radius_m": 0.0}, "radius_m", "a shape has an inside"),
        ({"centre_m": [0, 0, 0], "radius_m": 1.0}, "centre_m", "a list of two numbers [x, y]"),
        ({"centre_m": [0, 0], "radiu_m": 1.0}, "radiu_m", 'did you mean "radius_m"?'),
        ({"polygn_m": [[0, 0], [1, 0], [0, 1]]}, "polygn_m", 'did you mean "polygon_m"?'),
        ({"x_m": [1, 0], "y_m": [0, 1]}, "x_m", "reversed"),
        (SIDES | {"altitude_m": [9, 0]}, "altitude_m", "reversed"),
        ({"polygon_m": [[0, 0], [1, 1], [1, 0], [0, 1]]}, "polygon_m", "crosses or touches itself"),
        (SIDES | {"name": ""}, "name", "an empty text"),
    ],
)
def test_what_is_no_zone(values: dict[str, object], path: str, words: str) -> None:
    """No shape, several, half of one, and numbers out of range are refused, once each."""
    require_fault(lambda: NoFlyZone.from_dict(values), path, words)


def test_more_zones_than_corners_are_refused_by_their_number(paper: Callable) -> None:
    """Each has a corner at least, so they are counted before any of them is read."""
    data = paper().to_dict()
    data["airspace"]["no_fly"] = [{"centre_m": "unread"}] * 10_000
    with pytest.raises(ScenarioError, match="a list of 10000 values, must be a list of at most 5000 tables"):
        Scenario.from_dict(data)
