"""The multistart search of a family under an axis field."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from sizes import chosen

from nullpose.errors import SolveError
from nullpose.physics import sinr
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.solver.multistart import multistart

VERTICAL = AxisField.affine([0.0, 0.0, 1.0], np.zeros((3, 3)))


def test_what_is_found_is_what_it_says(paper: Callable) -> None:
    """The log value is that of the position and the axis found, by the physics."""
    scene = paper(10.0)
    for field in (AxisField.free(), VERTICAL):
        found = multistart(build_family(scene), field, seed=0)
        axis = found.axis / np.linalg.norm(found.axis)
        assert found.log_value == pytest.approx(
            math.log(np.min(sinr(scene, found.position_m, axis))), abs=1e-12
        )


def test_seeds_agree_and_repeat(random_scene: Callable) -> None:
    """A seed repeats to the last bit; different seeds come to the same value."""
    rng = np.random.default_rng(61)
    for _ in range(5):
        family = build_family(random_scene(rng, 4, 2, 10.0))
        first, again, other = (multistart(family, AxisField.free(), seed=seed) for seed in (0, 0, 1))
        np.testing.assert_array_equal(first.position_m, again.position_m)
        np.testing.assert_array_equal(first.axis, again.axis)
        assert (first.log_value, first.starts, first.evaluations) == (
            again.log_value,
            again.starts,
            again.evaluations,
        )
        assert other.log_value == pytest.approx(first.log_value, abs=1e-9)


def test_the_needle_over_the_jammer_is_found(scene: Callable) -> None:
    """The vertical optimum under strong jamming is a needle over the jammer, which every seed finds."""
    rng = np.random.default_rng(71)
    for _ in range(10):
        jammer = tuple(rng.uniform([10.0, 10.0, 0.0], [40.0, 40.0, 4.0]))
        family = build_family(scene([(0, 0, 0), (0, 50, 0), (50, 25, 0)], [jammer], jammer_powers_w=1e6))
        for seed in range(3):
            found = multistart(family, VERTICAL, seed=seed)
            np.testing.assert_allclose(found.position_m, [*jammer[:2], 8.0], atol=1e-3)


def rectangle(west: float, east: float, south: float, north: float) -> dict[str, object]:
    """Returns a no-fly zone as a polygon."""
    return {"polygon_m": [(west, south), (east, south), (east, north), (west, north)]}


SQUARE = {"x_m": (0.0, 10.0), "y_m": (0.0, 40.0)}
NARROW = {
    "a fence two micrometres wide": {"geofence_m": [(0, 0), (40, 37), (40 - 2e-6, 37 + 2e-6), (-2e-6, 2e-6)]},
    "a fence thin as a needle": {"geofence_m": [(0, 0), (40, 40), (40, 40 + 4e-6)]},
    "a thin fence with a bend": {
        "geofence_m": [(0, 0), (40, 0), (40, 40), (40 - 4e-6, 40), (40 - 4e-6, 4e-6), (0, 4e-6)]
    },
    "a range on the border of a fence": {
        "x_m": (5.0, 5.0),
        "geofence_m": rectangle(5, 10, 0, 40)["polygon_m"],
    },
    "a range that touches a fence": {"x_m": (0.0, 5.0), "geofence_m": rectangle(5, 10, 0, 40)["polygon_m"]},
    "the corner of a fence": {
        "x_m": (0.0, 5.0),
        "y_m": (-4.0, 0.0),
        "geofence_m": rectangle(5, 10, 0, 40)["polygon_m"],
    },
    "the tip of a fence": {"x_m": (5.0, 5.0), "geofence_m": [(5, 5), (20, 0), (20, 40)]},
    "a wall between two zones": {**SQUARE, "no_fly": [rectangle(-5, 5, -5, 45), rectangle(5, 15, -5, 45)]},
    "a gap between two zones": {
        **SQUARE,
        "no_fly": [rectangle(-5, 5, -5, 45), rectangle(5 + 2e-6, 15, -5, 45)],
    },
    "a floor between two zones": {
        **SQUARE,
        "no_fly": [
            rectangle(-5, 15, -5, 45) | {"altitude_m": (0.0, 20.0)},
            rectangle(-5, 15, -5, 45) | {"altitude_m": (20.0, 40.0)},
        ],
    },
    "what a zone leaves of a fence": {
        "geofence_m": rectangle(0, 10, 0, 40)["polygon_m"],
        "no_fly": [rectangle(2e-6, 11, -1, 41)],
    },
    "the corner that a bent zone leaves of a fence": {
        "geofence_m": rectangle(0, 10, 0, 40)["polygon_m"],
        "no_fly": [{"polygon_m": [(2e-6, 0), (11, -1), (11, 41), (-1, 41), (-1, 2e-6)]}],
    },
    "the border of a fence that is a zone": {
        "geofence_m": rectangle(0, 10, 0, 40)["polygon_m"],
        "no_fly": [rectangle(0, 10, 0, 40)],
    },
    "the corners between a fence and a cylinder": {
        "geofence_m": rectangle(-10, 10, -10, 10)["polygon_m"],
        "no_fly": [{"centre_m": (0, 0), "radius_m": 14.142135}],
    },
    "a corner that a keep-out ball leaves": {
        "x_m": (-5.0, 5.0),
        "y_m": (-5.0, 5.0),
        "altitude_m": (0.0, 5.0),
        "keep_out_m": 8.660254,
    },
    "a point": {"x_m": (5.0, 5.0), "y_m": (5.0, 5.0), "altitude_m": (8.0, 8.0)},
    "beside a zone without area": {**SQUARE, "no_fly": [{"x_m": (5.0, 5.0), "y_m": (0.0, 40.0)}]},
}


@pytest.mark.parametrize("airspace", chosen(NARROW.values(), range(0, 17, 2)), ids=NARROW)
def test_narrow_airspaces_are_found(airspace: dict[str, object], scene: Callable) -> None:
    """However little an airspace leaves, a position in it or on its border is found, for any seed."""
    narrow = scene([(0, 0, 0), (10, 40, 1)], [(17, 15, 4)], jammer_powers_w=10.0, **airspace)
    family = build_family(narrow)
    for field in (AxisField.free(), VERTICAL):
        for seed in range(2):
            found = multistart(family, field, seed=seed)
            assert narrow.airspace.allows(found.position_m)
            away_m = np.linalg.norm(family.ratios.points_m - found.position_m, axis=1)
            assert np.all(away_m >= narrow.airspace.keep_out_m - 1e-9)
            axis = found.axis / np.linalg.norm(found.axis)
            assert found.log_value == pytest.approx(
                math.log(np.min(sinr(narrow, found.position_m, axis))), abs=1e-9
            )


def test_a_sliver_is_searched_to_its_best(scene: Callable) -> None:
    """In a fence two micrometres wide the value is that of a fence a millimetre wide, within what that is."""
    ends = []
    for width in (2e-6, 1e-3):
        fence = [(0, 0), (40, 37), (40 - width, 37 + width), (-width, width)]
        narrow = scene([(0, 0, 0), (10, 40, 1)], [(17, 15, 4)], jammer_powers_w=10.0, geofence_m=fence)
        ends.append(multistart(build_family(narrow), AxisField.free(), seed=0).log_value)
    assert ends[0] == pytest.approx(ends[1], abs=1e-3)


def test_no_position_is_said(scene: Callable) -> None:
    """Where nothing is allowed after all, that is said, not that no node is received."""
    family = build_family(scene([(0, 0, 0), (10, 40, 1)], x_m=(-1.0, 1.0), y_m=(-1.0, 1.0)))
    closed = family.changed(keep_out_points_m=np.array([[0.0, 0.0, 19.0]]), keep_out_m=50.0)
    with pytest.raises(SolveError, match="no position was found in what the airspace leaves"):
        multistart(closed, AxisField.free(), seed=0)
