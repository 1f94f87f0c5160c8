"""The verb ``vehicle``."""

from __future__ import annotations

import math
from typing import Annotated

import typer

from nullpose.cli.options import (
    MOUNTS,
    REACH,
    FigureFiles,
    JsonOutput,
    ProofOptions,
    SceneOptions,
    Width,
    expanded,
    mounts_of,
)
from nullpose.cli.output import compiling_announced, prepare_outputs, tell
from nullpose.cli.progress import Ticker


@expanded
def vehicle(
    *,
    scene: SceneOptions,
    reach: Annotated[
        float | None,
        typer.Option(
            "--reach",
            metavar="REACH",
            help="What suffices: this times the omnidirectional value, above 0 to 1.",
            show_default=f"{REACH}",
        ),
    ] = None,
    loss_db: Annotated[
        float | None,
        typer.Option(
            "--loss-db", metavar="DB", help="Or the loss that is allowed, in dB.", show_default=False
        ),
    ] = None,
    mount: Annotated[
        str,
        typer.Option(
            "--mount",
            metavar="DEG,DEG",
            help="Mounts of the antenna: angles from the body's vertical, 0 upright, 90 flat; or best, for "
            "the mount that needs least tilt alone.",
        ),
    ] = MOUNTS,
    figure: FigureFiles = None,
    width: Width = None,
    proof: ProofOptions,
    json_output: JsonOutput = False,
) -> None:
    """Find the least tilt that a vehicle needs.

    For each mount of the antenna: the least tilt that is enough, and the largest that is proved too little.
    """
    from nullpose.report.vehicle import vehicle_view
    from nullpose.study.least_tilt import least_tilt, values_by_angle

    share, mounts_deg = _share(reach, loss_db), mounts_of(mount)
    scenario = scene.read()
    prepare_outputs(scene, figure=figure or [], width=width)
    with compiling_announced(proof.time_limit), Ticker("least tilt") as ticker:
        found = least_tilt(
            scenario,
            share=share,
            mounts_deg=mounts_deg,
            on_progress=ticker,
            **proof.keywords(),
        )
    if figure:
        from nullpose.report.figures.style import write_figure
        from nullpose.report.figures.sweep import draw_least_tilt

        with compiling_announced(proof.time_limit), Ticker("values by axis angle") as ticker:
            values = values_by_angle(found, on_progress=ticker, **proof.keywords())
        write_figure(draw_least_tilt(found, values, width), *figure)
    tell(found, vehicle_view, json_output, files=figure or [], **scenario.instant)


def _share(reach: float | None, loss_db: float | None) -> float:
    """Choose the share that suffices: stated, by a loss in dB, or the usual one.

    Raises:
        UsageError: both are stated, or one that is not allowed.
    """
    from nullpose.errors import require_usage

    if loss_db is None:
        return REACH if reach is None else reach
    require_usage(
        reach is None, f"--reach: given {reach} with --loss-db {loss_db:g}; leave out one of the two"
    )
    require_usage(
        0.0 < loss_db < math.inf, f"--loss-db: given {loss_db!r}; allowed: more than 0 dB, as in 0.05"
    )
    return float(10.0 ** (-loss_db / 10.0))
