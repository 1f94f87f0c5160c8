"""Scenes and dense algebra that the tests of the family share."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.scenario import Scenario


@pytest.fixture(scope="session")
def random_problem() -> Callable[..., Scenario]:
    """Returns a builder: so many nodes and jammers on a field of 100 m, powers over two decades, a gain."""

    def build(rng: np.random.Generator, nodes: int, jammers: int, **airspace: object) -> Scenario:
        places = rng.uniform(0.0, [100.0, 100.0, 5.0], (nodes + jammers, 3)).tolist()
        points = [{"position_m": at, "power_w": 10.0 ** rng.uniform(-1.0, 1.0)} for at in places]
        receiver = {"noise_dbm": -60.0, "reference_gain_db": -40.0}
        ground = {"nodes": points[:nodes], "jammers": points[nodes:]}
        limits = {"altitude_m": (10.0, 40.0)} | airspace
        return Scenario.from_dict({"airspace": limits, "receiver": receiver, **ground})

    return build
