"""A flight that is stated and not solved for: of five instants, with a wait, a turn and a short last step."""

import math
from pathlib import Path

import numpy as np

from nullpose import Pose, Scenario, Trajectory, apply_overrides, load
from nullpose.physics import evaluate, objective_of_links
from nullpose.solver.result import Stats
from nullpose.solver.trajectory import Aim

TIMES_S = np.array([0.0, 4.0, 8.0, 12.0, 14.0])
PLACES_M = np.array([(2.0, 20, 9), (5.0, 24, 9), (5.0, 24, 9), (-3.0, 30, 21), (-3.0, 31, 21)])
ORIGIN = (50.0, 14.5, 230.0)


def moving(*overrides: str) -> Scenario:
    """Returns the example in motion, on the Earth, for 14 s."""
    origin = f"origin={{lat_deg={ORIGIN[0]}, lon_deg={ORIGIN[1]}, alt_m={ORIGIN[2]}}}"
    stated = ["time.duration_s=14", "time.step_s=4", "jammers.M.power_w=100", origin]
    example = load(Path(__file__).parents[2] / "examples" / "moving_jammer.toml")
    return apply_overrides(example, [*stated, *overrides])


def flown(aim: Aim = Aim.WORST, *overrides: str) -> Trajectory:
    """Returns the flight, its values by the physics, its bounds made up."""
    scenario, angles = moving(*overrides), np.linspace(0.2, 1.3, len(TIMES_S))
    poses = tuple(
        Pose(place_m, 0.5 * angle, -angle, 2.0 * angle)
        for place_m, angle in zip(PLACES_M, angles, strict=True)
    )
    scenes = [scenario.at(time_s) for time_s in TIMES_S]
    values = np.array(
        [objective_of_links(scene, evaluate(scene, pose)) for scene, pose in zip(scenes, poses, strict=True)]
    )
    value = 10.0 * math.log10(values.min()) if aim.is_worst else float(np.mean(np.log2(1.0 + values)))
    return Trajectory(
        scenario=scenario,
        maximise=aim,
        times_s=TIMES_S,
        poses=poses,
        values=values,
        optimum_values=2.0 * values,
        value=value,
        upper_bound=value + 0.3,
        gap_db=0.05,
        bound_name="key-instants" if aim.is_worst else "prices",
        baselines={"hover": value - 1.0, "greedy": -math.inf, "window": None, "clairvoyant": value + 0.5},
        reason="the time limit",
        stats=Stats(wall_s=1.0),
    )
