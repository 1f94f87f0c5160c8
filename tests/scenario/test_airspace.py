"""The airspace's box."""

import numpy as np
import pytest

from nullpose.scenario import Airspace, NoFlyZone

FENCED = Airspace(
    altitude_m=(8.0, 30.0),
    x_m=(-50.0, 50.0),
    geofence_m=[[-40, -40], [60, -40], [60, 80], [0, 20], [-40, 80]],
    no_fly=[
        {"centre_m": [17, 15], "radius_m": 5},
        {"name": "mast", "x_m": [-20, -10], "y_m": [0, 10], "altitude_m": [0, 15]},
    ],
)


@pytest.mark.parametrize(
    ("allowed", "positions"),
    [
        (True, [[0, 0, 8], [0, 0, 30], [50, 0, 10], [0, 20, 10]]),  # the last is a vertex of the fence
        (False, [[0, 0, 7.99], [0, 0, 30.01], [55, 0, 10], [0, 21, 10]]),  # inside the fence or the box
        (True, [[22, 15, 10], [-15, 5, 15], [-15, 5, 16], [-10, 5, 10]]),
        (False, [[17, 15, 10], [21.99, 15, 10], [-15, 5, 10], [-15, 5, 8]]),  # a zone covers the floor
    ],
)
def test_what_is_allowed(allowed: bool, positions: list[list[float]]) -> None:
    """Inside the box and the fence and outside the zones; their borders are allowed."""
    assert FENCED.allows(positions).tolist() == [allowed] * 4


@pytest.mark.parametrize("margin_m", [0.0, 2.0])
def test_allows_is_vectorised_and_agrees_with_the_clearance(margin_m: float) -> None:
    """Any leading shape; allowed is where the clearance is not negative, up to a billionth of a metre."""
    rng, fenced = np.random.default_rng(5), FENCED.model_copy(update={"margin_m": margin_m})
    positions = rng.uniform([-60.0, -50.0, 5.0], [70.0, 90.0, 33.0], (40, 50, 3))
    allowed, clearance = fenced.allows(positions), fenced.clearance_m(positions)
    assert allowed.shape == clearance.shape == (40, 50)
    assert allowed.dtype == bool
    np.testing.assert_array_equal(allowed, clearance >= -1e-9)
    assert 0.1 < allowed.mean() < 0.9
    step = rng.normal(0.0, 3.0, positions.shape)
    change = np.abs(fenced.clearance_m(positions + step) - clearance)
    assert (change <= np.linalg.norm(step, axis=-1) + 1e-9).all()


def test_zones_out_of_reach_of_ranges_and_fence_change_nothing() -> None:
    """No zone is left out that would forbid an allowed position."""
    rng = np.random.default_rng(2)
    fence, reached = [[-40.0, -40.0], [40.0, -40.0], [40.0, 40.0], [-40.0, 40.0]], []
    for _ in range(200):
        (x, y), r, low = rng.uniform(-90.0, 90.0, 2), rng.uniform(1.0, 20.0), rng.uniform(-20.0, 60.0)
        box = {"x_m": (x - r, x + r), "y_m": (y - r, y + r)}
        zone = NoFlyZone(name="Z", altitude_m=(low, low + 20.0), **box)
        flat = rng.uniform() < 0.3
        airspace = Airspace(
            altitude_m=(20.0, 20.0 if flat else 40.0),
            x_m=(-60.0, 30.0),
            geofence_m=fence if rng.uniform() < 0.5 else None,
            no_fly=(zone,),
        )
        free = airspace.model_copy(update={"no_fly": ()})
        positions_m = rng.uniform([-90.0, -90.0, 20.0], [90.0, 90.0, 20.0 if flat else 40.0], (1000, 3))
        forbids = bool(np.any(free.allows(positions_m) & ~airspace.allows(positions_m)))
        assert airspace.reached(zone) or not forbids
        reached.append((airspace.reached(zone), forbids))
    assert {(True, True), (False, False)} <= set(reached)
