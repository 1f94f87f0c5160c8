"""What a box may use of a border: multipliers by least squares, and constraints as they are at its centre."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from tests.reference.plain_kernels import plain

from nullpose.problem.airspace import airspace_zones
from nullpose.problem.records import Domain
from nullpose.scenario import Airspace
from nullpose.solver.kernels.bounds import borders
from nullpose.solver.kernels.bounds.node import BALL, CENTRE, COLUMNS, HALF, LEVEL
from nullpose.solver.kernels.search import domain as kernels_of_domain
from nullpose.solver.kernels.search.zones import MOST_ALTERNATIVES

SEEDS = st.integers(0, 2**32 - 1)

choose_border, borders_of, slope_of, forbidding = map(
    plain,
    (borders.choose_border, borders.borders, borders.slope_and_rest, kernels_of_domain.forbidding),
)


def chosen_border(domain: Domain, row: np.ndarray) -> int:
    """Returns the zone that forbids all of a box, having filled the border that is to be used in it."""
    choose_border(domain, row)
    return forbidding(domain, row[CENTRE:HALF], row[HALF:LEVEL])


def row_of(centre: np.ndarray, half: np.ndarray) -> np.ndarray:
    """Returns a node with a box and a border that is yet to be chosen."""
    row = np.full(COLUMNS, 7.0)
    row[CENTRE:HALF], row[HALF:LEVEL] = centre, half
    return row


@given(seed=SEEDS, kind=st.sampled_from([0.0, 1.0, 2.0]))
def test_a_constraint_at_the_centre(seed: int, kind: float) -> None:
    """Value, slope and curvature at the centre give the constraint anywhere, a hair above it if at all."""
    rng = np.random.default_rng(seed)
    normal = rng.normal(size=3)
    normal /= np.linalg.norm(normal)
    side = np.array([kind, *(normal if kind == 0.0 else rng.uniform(-20.0, 20.0, 3)), rng.uniform(1.0, 9.0)])
    row, slope = row_of(rng.uniform(-20.0, 20.0, 3), np.ones(3)), np.empty(3)
    value, bend, axes = slope_of(side, row, slope)
    for move in rng.uniform(-1.0, 1.0, (10, 3)):
        p = row[CENTRE:HALF] + move
        exact = p @ side[1:4] - side[4]
        if kind > 0.0:
            used = 2 if kind == 1.0 else 3
            assert axes == used
            exact = float(np.sum((p - side[1:4])[:used] ** 2)) - side[4] ** 2
        stated = value + slope @ move + 0.5 * bend * float(np.sum(move[:axes] ** 2))
        assert stated == pytest.approx(exact, abs=1e-9)
    exact = row[CENTRE:HALF] @ side[1:4] - side[4] if kind == 0.0 else value
    assert value >= exact


def domain_of(airspace: Airspace, balls_m: np.ndarray, radius_m: float) -> Domain:
    """Returns a domain with keep-out balls and the zones of an airspace."""
    arrays = [np.array([-99.0, -99.0, 8.0]), np.array([99.0, 99.0, 40.0]), balls_m.copy()]
    zones = airspace_zones(airspace).values()
    for array in (*arrays, *zones):
        array.flags.writeable = False
    return Domain(*arrays, radius_m, *zones)


TWO_ZONES = Airspace(
    altitude_m=(8.0, 40.0),
    no_fly=({"centre_m": (30.0, 0.0), "radius_m": 5.0}, {"x_m": (-40.0, -20.0), "y_m": (-9.0, 9.0)}),
)
BALLS_M = np.array([[0.0, 30.0, 8.0], [30.0, 6.0, 10.0]])


@pytest.mark.parametrize(
    ("centre", "half", "border", "forbidden"),
    [
        ((0.0, 0.0, 20.0), 1.0, -1, -1),  # nothing near
        ((0.0, 34.0, 9.0), 1.0, 0, -1),  # a ball reaches in
        ((25.5, 0.0, 30.0), 1.0, 2, -1),  # the cylinder reaches in
        ((30.0, 0.0, 30.0), 1.0, -1, 2),  # all of it in the cylinder
        ((-20.0, 0.0, 20.0), 1.0, 3, -1),  # a wall
        ((-30.0, 0.0, 20.0), 1.0, -1, 3),
        ((30.0, 5.4, 10.0), 4.0, 1, -1),  # a ball and a zone, the centre outside of the zone: the ball
        ((30.0, 4.8, 10.0), 4.0, 2, -1),  # and the centre inside of it: the zone
    ],
)
def test_the_border_that_a_box_uses(centre: tuple, half: float, border: int, forbidden: int) -> None:
    """Balls come first unless the centre lies in a zone; a zone that holds all of a box forbids it."""
    domain = domain_of(TWO_ZONES, BALLS_M, 5.0)
    row = row_of(np.array(centre), np.full(3, half))
    assert chosen_border(domain, row) == forbidden
    if forbidden < 0:
        assert row[BALL] == border
        sides, counts = np.full((MOST_ALTERNATIVES, 2, 5), np.nan), np.zeros(MOST_ALTERNATIVES, np.int64)
        assert borders_of(domain, row, sides, counts) == (0 if border < 0 else 1)
        if 0 <= border < 2:
            np.testing.assert_array_equal(sides[0, 0], [2.0, *BALLS_M[border], 5.0])


@pytest.mark.parametrize("order", [[0, 1], [1, 0]])
def test_a_zone_that_forbids_all_of_a_box_is_found_behind_others(order: list[int]) -> None:
    """Though the box's centre lies in another zone, whose border crosses the box."""
    tower = {"centre_m": (0.0, 0.0), "radius_m": 5.0}
    block = {"x_m": (-10.0, 20.0), "y_m": (-10.0, 10.0)}
    zones = tuple((tower, block)[i] for i in order)
    domain = domain_of(Airspace(altitude_m=(8.0, 40.0), no_fly=zones), np.zeros((0, 3)), 1.0)
    row = row_of(np.array([4.5, 0.0, 20.0]), np.ones(3))
    assert chosen_border(domain, row) == order.index(1)
