"""The verb ``evaluate``."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from nullpose.scenario import Scenario
from nullpose.cli.options import (
    JsonOutput,
    Off,
    ProofOptions,
    SceneOptions,
    error_sizes,
    expanded,
    numbers_of,
)
from nullpose.cli.output import compiling_announced, tell
from nullpose.cli.printing import say
from nullpose.cli.progress import GapBar


@expanded
def evaluate(
    *,
    scene: SceneOptions,
    pose: Annotated[
        str | None,
        typer.Option("--pose", metavar="X,Y,Z", help="The drone's position in metres.", show_default=False),
    ] = None,
    pose_lat_lon: Annotated[
        str | None,
        typer.Option(
            "--pose-lat-lon",
            metavar="LAT,LON,ALT",
            help="The position in degrees and metres, in place of --pose. ALT is over what [origin] states: "
            "the ellipsoid (alt_m), or the sea if it states alt_msl_m alone.",
            show_default=False,
        ),
    ] = None,
    attitude: Annotated[
        str | None,
        typer.Option(
            "--attitude",
            metavar="ROLL,PITCH,YAW",
            help="Degrees. Rz(yaw) Ry(pitch) Rx(roll) turns body (x forward, z up) to ENU.",
            show_default="0,0,0",
        ),
    ] = None,
    poses: Annotated[
        Path | None,
        typer.Option(
            "--poses",
            metavar="CSV",
            help="File of many poses, in place of --pose: x_m, y_m, z_m (or lat_deg, lon_deg and alt_m), "
            "roll_deg, pitch_deg, yaw_deg.",
            show_default=False,
        ),
    ] = None,
    proof: ProofOptions,
    off: Off = None,
    json_output: JsonOutput = False,
) -> None:
    """Evaluate poses of your own against the upper bound."""
    from nullpose.errors import require_usage
    from nullpose.physics import Pose, Poses
    from nullpose.report.results import evaluation_view
    from nullpose.scenario.plausibility import close_to_degrees
    from nullpose.solver import solve
    from nullpose.solver.options import SolveOptions
    from nullpose.study import evaluate_against, poses_from_csv
    from nullpose.study.evaluation import require_one_antenna

    require_usage(
        [pose, pose_lat_lon, poses].count(None) == 2 and (poses is None or attitude is None),
        "evaluate: give either --pose or --pose-lat-lon, with --attitude unless it is 0,0,0, or --poses",
    )
    scenario = scene.read()
    require_one_antenna(scenario, "evaluate")
    mount_rad = 0.0 if scenario.airframe is None else scenario.airframe.mount_rad
    candidates: Poses | list[Pose]
    if poses is not None:
        candidates = poses_from_csv(poses, mount_rad, scenario.origin)
    else:
        roll, pitch, yaw = map(math.radians, _three("--attitude", attitude or "0,0,0"))
        position_m = _three("--pose", pose or "") if pose_lat_lon is None else _placed(scenario, pose_lat_lon)
        candidates = [Pose(position_m, roll, pitch, yaw, mount_rad)]
    remedy = "--pose-lat-lon LAT,LON,ALT, or in a file the columns lat_deg, lon_deg and alt_m"
    for warning in close_to_degrees(scenario.origin, [each.position_m for each in candidates], remedy):
        say(f"warning: {'--pose' if poses is None else poses}: {warning}", err=True)
    options, sizes = proof.keywords(), error_sizes(off)
    with compiling_announced(proof.time_limit), GapBar(SolveOptions(**options).of(scenario).target) as bar:
        best = solve(scenario, on_progress=bar, **options)
    evaluation = evaluate_against(replace(best, error_sizes=sizes), candidates)
    found = evaluation.results[0] if poses is None else evaluation
    tell(found, lambda _: evaluation_view(evaluation), json_output)


def _placed(scenario: Scenario, text: str) -> NDArray[np.float64]:
    """Convert a latitude, longitude and altitude to a position.

    Raises:
        UsageError: the scenario has no origin, or the place is not near it.
    """
    from nullpose.errors import UsageError

    if scenario.origin is None:
        raise UsageError(
            f"--pose-lat-lon: given {text!r}, but the scenario has no [origin]; allowed: --pose X,Y,Z in "
            "metres; add an [origin] with lat_deg, lon_deg and alt_m"
        )
    keys = ("lat_deg", "lon_deg", "alt_msl_m" if scenario.origin.alt_m is None else "alt_m")
    return scenario.origin.position_m(dict(zip(keys, _three("--pose-lat-lon", text), strict=True)))


def _three(option: str, text: str) -> NDArray[np.float64]:
    import numpy as np

    return np.array(numbers_of(option, text, "three numbers with commas, as in 3,24,8.5", 3))
