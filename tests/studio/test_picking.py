"""A click goes to the point that it is at, to the zone around its place on the ground, or to the ground."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, seed, strategies as st

from nullpose import load
from nullpose.studio.edits import with_added
from nullpose.studio.picking import ground_place_m, picked
from nullpose.studio.state import State

PAPER = State(scenario=load(Path(__file__).parents[2] / "examples" / "paper.toml"))
SIZE_M = 100.0
_EYES = st.tuples(st.floats(-150, 150), st.floats(-150, 150), st.floats(5, 150))


@seed(19)
@given(_EYES, st.sampled_from([key for key, _ in PAPER.points()]))
def test_a_click_at_a_point_picks_what_is_seen_there(eye_m: tuple[float, float, float], key: tuple) -> None:
    """That point, or another in the same direction."""
    point = dict(PAPER.points())[key]
    way = np.subtract(point.position_m, eye_m)
    found = picked(PAPER, SIZE_M, eye_m, way)
    assert found is not None
    seen = np.subtract(dict(PAPER.points())[found].position_m, eye_m)
    reach = 0.06 * SIZE_M / np.linalg.norm(seen) + 0.03
    assert found == key or np.arccos(seen @ way / np.linalg.norm(seen) / np.linalg.norm(way)) < reach


@seed(19)
@given(_EYES, st.tuples(st.floats(-100, 100), st.floats(-100, 100)))
def test_the_ground_is_met_where_the_click_is(eye_m: tuple[float, float, float], at: tuple) -> None:
    """A ray to a place on the ground meets it there, and one upwards nowhere."""
    way = np.subtract((*at, 0.0), eye_m)
    assert ground_place_m(SIZE_M, eye_m, way) == pytest.approx(at, abs=1e-6)
    assert ground_place_m(SIZE_M, eye_m, -way) is None


def test_a_zone_is_picked_by_its_ground() -> None:
    """A click inside a zone's outline selects it; far from everything nothing is selected."""
    view = with_added(PAPER, "no-fly zone", (40.0, 40.0), SIZE_M)
    eye_m = (40.0, 40.0, 90.0)
    assert picked(view, SIZE_M, eye_m, (0.0, 0.0, -1.0)) == ("no_fly", 0)
    assert picked(view, SIZE_M, eye_m, (1.0, 0.0, -1.0)) is None
