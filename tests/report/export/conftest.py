"""What tests of exports share: a result at the pose of export_scene, and its rotation."""

import math
from collections.abc import Callable
from dataclasses import replace

import pytest
from export_scene import AIRSPACE, ANGLES_DEG, ORIGIN, POSITION_M, SEA_M
from scipy.spatial.transform import Rotation

from nullpose import Pose, Result, Scenario, evaluate, solve


@pytest.fixture(scope="session")
def turned() -> Rotation:
    """The rotation to the world from the body, by SciPy."""
    return Rotation.from_euler("ZYX", [ANGLES_DEG[f"{name}_deg"] for name in ("yaw", "pitch", "roll")], True)


@pytest.fixture(scope="session")
def placed(paper: Scenario) -> Callable[..., Result]:
    """Returns a builder: the paper's scene at the pose above, its origin stating altitudes as named."""
    solved = solve(paper, certify=False)

    def build(*altitudes: str) -> Result:
        stated = {"alt_m": ORIGIN[2], "alt_msl_m": ORIGIN[2] - SEA_M}
        origin = {"lat_deg": ORIGIN[0], "lon_deg": ORIGIN[1]} | {key: stated[key] for key in altitudes}
        scenario = Scenario.from_dict(paper.to_dict() | {"origin": origin, "airspace": AIRSPACE})
        roll_rad, pitch_rad, yaw_rad = map(math.radians, ANGLES_DEG.values())
        pose = Pose(POSITION_M, roll_rad, pitch_rad, yaw_rad, mount_rad=0.4)
        links = evaluate(scenario, pose)
        value = min(link.sinr for link in links)
        objective = replace(solved.objective, value=value, value_db=10.0 * math.log10(value))
        return replace(solved, scenario=scenario, pose=pose, links=links, objective=objective)

    return build
