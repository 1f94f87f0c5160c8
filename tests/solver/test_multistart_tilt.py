"""A vehicle that may tilt more has every pose of one that may tilt less, so its best value is no lower."""

import math
from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np
import pytest

from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.scenario import Airframe, Scenario
from nullpose.solver import solve
from nullpose.solver.multistart import multistart

TILTS_DEG = (0.0, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 90.0)
SCENES = 24
ROUNDING = 2e-6
"""Relative: a band of 1e-5 degrees at a mount of as little is of the width of rounding."""


def scenes_by_tilt(random_scene: Callable, count: int) -> Iterator[list[Scenario]]:
    """Yield scenes, each under every tilt: mounts in between, and a hair off upright or flat."""
    for number in range(count):
        rng = np.random.default_rng([46, number])
        scene = random_scene(
            rng, int(rng.integers(1, 6)), int(rng.integers(1, 4)), 10.0 ** rng.uniform(-1.0, 3.0)
        )
        hair_deg = 10.0 ** rng.uniform(-6.0, -1.0)
        mount_deg = (rng.uniform(1.0, 89.0), rng.uniform(1.0, 89.0), hair_deg, 90.0 - hair_deg)[number % 4]
        airframes = (Airframe(tilt_max_deg=tilt_deg, mount_deg=mount_deg) for tilt_deg in TILTS_DEG)
        yield [scene.model_copy(update={"airframe": airframe}) for airframe in airframes]


def test_more_tilt_is_never_worse_in_a_search(random_scene: Callable) -> None:
    """The search alone finds as much in a band, however narrow, as in any that it holds."""
    for scenes in scenes_by_tilt(random_scene, SCENES):
        fields = [AxisField.within(*scene.axis_band) for scene in scenes]
        logs = [
            multistart(build_family(scene), field, seed=0).log_value
            for scene, field in zip(scenes, fields, strict=True)
        ]
        assert np.all(np.maximum.accumulate(logs) - logs <= ROUNDING)


def test_more_tilt_is_never_worse_before_a_proof(random_scene: Callable) -> None:
    """So does the light search with the proof that follows, whether it ends at its gap or at a limit."""
    for scenes in scenes_by_tilt(random_scene, SCENES // 4):
        limits = {"gap": 1e-3, "node_limit": 3000, "time_limit_s": math.inf}
        found = [solve(scene, **limits).objective for scene in scenes]
        values = np.array([each.value for each in found])
        assert np.all(values >= np.maximum.accumulate(values) * (1.0 - 1e-3))
        for less, more in pairwise(found):
            assert less.value <= more.upper_bound


@pytest.mark.parametrize("mount_deg", [10.0, 45.0, 80.0])
def test_a_narrow_band_is_searched_in_as_few_steps_as_its_cone(scene: Callable, mount_deg: float) -> None:
    """Steps of the axis follow the band, so a narrow one takes no more than some times those of its cone."""
    places_m = np.column_stack([np.random.default_rng(8).uniform(0.0, 100.0, (6, 2)), np.zeros(6)])
    family = build_family(scene(places_m[:4], places_m[4:], jammer_powers_w=100.0))
    evaluations = []
    for tilt_deg in (0.0, 1e-4):
        airframe = Airframe(tilt_max_deg=tilt_deg, mount_deg=mount_deg)
        evaluations.append(multistart(family, AxisField.within(*airframe.axis_band), seed=0).evaluations)
    assert evaluations[1] <= 3 * evaluations[0]


def test_a_dipole_that_is_all_but_upright_has_the_vertical_ones_needle() -> None:
    """A tilt of .002 degrees does not lose the best place of the vertical dipole, .6 % ahead of others."""
    nodes = [
        (58.17175, 1.326636, 3.621542, 1.418996),
        (38.56001, 41.36796, 1.349520, 1.270537),
        (27.35895, 16.87898, 2.226444, 2.061602),
        (23.90122, 22.12244, 3.321086, 0.6354204),
        (45.27331, 45.63720, 0.2663163, 2.730531),
    ]
    jammers = [(50.68430, 17.65774, 0.1655093, 8.606109), (44.02628, 40.04298, 4.299250, 8.606109)]
    scenario = Scenario.from_dict(
        {
            "airspace": {"altitude_m": [8.0, 30.0]},
            "airframe": {"tilt_max_deg": 0.002017185, "mount_deg": 0.001},
            "receiver": {"noise_w": 1.073512e-14, "reference_gain_db": 0.0},
            "channel": {
                "model": "elevation", "a": 0.1, "b": 1.0, "los_loss_db": 0.0, "nlos_loss_db": 165.0,
                "average": "power",
            },
            "nodes": [{"position_m": [x, y, z], "power_w": power_w} for x, y, z, power_w in nodes],
            "jammers": [{"position_m": [x, y, z], "power_w": power_w} for x, y, z, power_w in jammers],
        }
    )  # fmt: skip
    assert scenario.axis_band[0] < scenario.axis_band[1] == 1.0
    less = solve(scenario, "vertical", certify=False).objective.value
    assert solve(scenario, certify=False).objective.value >= less
