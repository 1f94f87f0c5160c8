"""What more loss does to the value of a scene."""

from collections.abc import Callable

import numpy as np
from hypothesis import given, settings, strategies as st

from nullpose import Scenario, solve
from nullpose.channel.elevation import AVERAGES

LOSSES_DB = st.floats(0.0, 15.0)


@settings(max_examples=40)
@given(
    seed=st.integers(0, 2**32 - 1),
    average=st.sampled_from(AVERAGES),
    los_loss_db=LOSSES_DB,
    more_db=LOSSES_DB,
    hidden_db=LOSSES_DB,
)
def test_more_loss_never_raises_a_value_without_jammers(
    seed: int, average: str, los_loss_db: float, more_db: float, hidden_db: float, random_scene: Callable
) -> None:
    """More loss with line of sight, that without it being the same: no link gets better at any pose."""
    rng = np.random.default_rng(seed)
    scene = random_scene(rng, int(rng.integers(1, 5)), 0)
    curve = {"a": float(rng.uniform(1.0, 40.0)), "b": float(rng.uniform(0.05, 0.5))}
    table = {"model": "elevation", "average": average, "nlos_loss_db": los_loss_db + more_db + hidden_db}
    channels = (table | curve | {"los_loss_db": los_loss_db + added_db} for added_db in (0.0, more_db))
    scenes = (Scenario.from_dict(scene.to_dict() | {"channel": channel}) for channel in channels)
    less, more = (solve(each, gap=1e-3, time_limit_s=5.0) for each in scenes)
    assert more.objective.value <= less.objective.upper_bound
