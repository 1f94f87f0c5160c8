"""The verb ``trajectory``."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from nullpose.cli.faults import INTERRUPTED
from nullpose.cli.options import AllowOutside, JsonOutput, Overrides, ScenarioFile, SceneOptions, TimeLimit
from nullpose.cli.output import compiling_announced, tell
from nullpose.cli.printing import say
from nullpose.cli.progress import ProgressBar


def trajectory(
    *,
    file: ScenarioFile,
    overrides: Overrides = None,
    allow_outside: AllowOutside = False,
    maximise: Annotated[
        str,
        typer.Option(
            "--maximise",
            metavar="worst|mean-db|mean-rate",
            help="The smallest value over the instants, the mean of its decibels, or the mean of "
            "log2(1 + ratio).",
        ),
    ] = "worst",
    gap_db: Annotated[
        float,
        typer.Option("--gap-db", metavar="DB", help="Stop the proof at this gap in dB, or in bits/s/Hz."),
    ] = 0.05,
    time_limit: TimeLimit = None,
    window: Annotated[
        float | None,
        typer.Option(
            "--window",
            metavar="S",
            help="Compare with a flight that plans anew at each instant and sees S seconds ahead.",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="DIR",
            help="Write the flight, figures and a film to this folder. It is created if necessary.",
            show_default=False,
        ),
    ] = None,
    json_output: JsonOutput = False,
) -> None:
    """Find the best flight through a scene in motion, and a bound on all flights.

    The vehicle has a speed limit, airframe.speed_max_m_s. The attitude may change
    as fast as it needs to.
    """
    from nullpose.report.trajectory import file_names, trajectory_view, write_trajectory
    from nullpose.solver.branch_and_bound import INTERRUPT
    from nullpose.solver.trajectory import TIME_LIMIT_S, solve_trajectory
    from nullpose.study.between_instants import sample_between

    scene = SceneOptions(file=file, overrides=overrides, allow_outside=allow_outside)
    scenario = scene.read(in_motion=True)
    if out is not None:
        scene.check_outputs((f"--out ({name})", out / name) for name in file_names(scenario))
    with compiling_announced(time_limit), ProgressBar("trajectory") as bar:
        found = solve_trajectory(
            scenario,
            maximise,
            gap_db=gap_db,
            time_limit_s=TIME_LIMIT_S if time_limit is None else time_limit,
            window_s=window,
            on_progress=lambda words, number: bar.show(
                min(1.0, gap_db / number) if words == "gap" and number > 0.0 else number,
                f"{words} {number:.2g} of {gap_db if words == 'gap' else 1:g}",
            ),
        )
        samples = sample_between(found)
    files = [] if out is None else write_trajectory(found, samples, out)
    if files and scenario.origin is not None:
        say(
            "trajectory.plan: a plan holds no times, and of the attitude only the heading; the values are "
            "those of the whole pose at its instant",
            err=True,
        )
    tell(
        found,
        partial(trajectory_view, samples=samples),
        json_output,
        files=files,
        lowest_sample=dict(zip(("time_s", "value"), samples[:, samples[1].argmin()].tolist(), strict=True)),
    )
    if found.reason == INTERRUPT:
        raise typer.Exit(INTERRUPTED)
