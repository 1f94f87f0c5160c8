"""The boxes of a proof as a page draws them."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from nullpose import solve
from nullpose.scenario import Scenario
from nullpose.solver.proof_steps import ProofStep, proof_steps
from nullpose.studio.replay import MOST_BOXES, Replay, drawn_airspace_m

ROOM_M = np.array([[-50.0, -50.0, 8.0], [50.0, 50.0, 30.0]])


class Scene:
    """Stands for viser's; keeps what is in it."""

    def __init__(self) -> None:
        self.batches: list[Any] = []

    def add_batched_meshes_simple(self, name: str, *_: object, **props: Any) -> Any:
        """Return a handle whose properties can be set."""
        self.batches.append(SimpleNamespace(**props))
        return self.batches[-1]

    def drawn(self) -> tuple[np.ndarray, np.ndarray]:
        """Return places and sizes of all boxes that can be seen."""
        seen = [one for one in self.batches if one.visible]
        none = np.empty((0, 3))
        return (
            np.vstack([none, *(one.batched_positions for one in seen)]),
            np.vstack([none, *(one.batched_scales for one in seen)]),
        )


def step(centre_m: Any, half_m: Any) -> ProofStep:
    """Return a step of some boxes."""
    return ProofStep(gap=1.0, centre_m=np.array(centre_m, float), half_m=np.array(half_m, float))


@pytest.fixture
def scene() -> Scene:
    """An empty one."""
    return Scene()


def test_every_open_box_is_drawn_with_its_place_and_size(scene: Scene, paper: Scenario) -> None:
    """The boxes in the scene are those of the step, cut off where the airspace drawn ends."""
    steps = proof_steps(solve(paper))
    replay = Replay(scene, np.array([[-1e3] * 3, [1e3] * 3]))
    for one in steps:
        replay.show(one)
        places, sizes = scene.drawn()
        assert sorted(map(tuple, places)) == sorted(map(tuple, one.centre_m.astype(np.float32)))
        assert np.sum(sizes, axis=0) == pytest.approx(np.sum(2.0 * one.half_m, axis=0), rel=1e-3, abs=1e-3)


def test_boxes_are_cut_off_at_the_airspace_that_is_drawn(scene: Scene) -> None:
    """One that is all outside is not drawn."""
    Replay(scene, ROOM_M).show(step([[50, 0, 20], [90, 0, 20]], [[10, 5, 30], [5, 5, 5]]))
    places, sizes = scene.drawn()
    assert places.tolist() == [[45.0, 0.0, 19.0]]
    assert sizes.tolist() == [[10.0, 10.0, 22.0]]


def test_of_very_many_boxes_the_largest_are_drawn(scene: Scene) -> None:
    """As many as the browser keeps up with."""
    half_m = np.linspace(0.01, 1.0, 9_000)[:, None] * np.ones(3)
    Replay(scene, ROOM_M).show(step(np.full((9_000, 3), 20.0), half_m))
    _, sizes = scene.drawn()
    assert len(sizes) == MOST_BOXES
    assert sizes.min() > 1.0


def test_the_airspace_drawn_holds_the_altitudes_and_the_nodes(paper: Scenario) -> None:
    """Boxes can be seen wherever points are."""
    low, high = drawn_airspace_m(paper)
    assert (low[2], high[2]) == (8.0, 30.0)
    assert low[1] < 0.0
    assert high[1] > 50.0
