"""The verb ``sweep``."""

from __future__ import annotations

from typing import Annotated

import typer

from nullpose.cli.options import (
    MOUNTS,
    REACH,
    AllowOutside,
    At,
    Fast,
    JsonOutput,
    OutFolder,
    ProofOptions,
    ScenarioFile,
    SceneOptions,
    Width,
    expanded,
    mounts_of,
    refuse,
)
from nullpose.cli.output import compiling_announced, tell
from nullpose.cli.printing import say
from nullpose.cli.progress import Ticker
from nullpose.problem.schemes import Scheme


@expanded
def sweep(
    *,
    file: ScenarioFile,
    settings: Annotated[
        list[str],
        typer.Option(
            "--set",
            metavar="PATH",
            help="The setting to vary, as in jammers.M.power_w. Repeat as PATH=VALUE to fix others.",
            show_default=False,
        ),
    ],
    start: Annotated[float, typer.Option("--from", help="First value.", show_default=False)],
    stop: Annotated[float, typer.Option("--to", help="Last value.", show_default=False)],
    out: OutFolder,
    allow_outside: AllowOutside = False,
    at_s: At = None,
    points: Annotated[int, typer.Option("--points", help="Number of values, both ends included.")] = 37,
    log: Annotated[
        bool, typer.Option("--log/--linear", help="Space the values by a constant ratio, or evenly.")
    ] = False,
    scheme: Annotated[
        list[Scheme] | None,
        typer.Option(
            "--scheme",
            metavar="NAME",
            help="Only this scheme (names: nullpose solve --help). Can be repeated.",
            show_default="the paper's four",
        ),
    ] = None,
    reach: Annotated[
        float | None,
        typer.Option(
            "--reach",
            metavar="REACH",
            help="In place of schemes: find the least tilt with which a vehicle reaches this times the "
            "omnidirectional value, for each mount.",
            show_default=f"{REACH}, if --mount is stated",
        ),
    ] = None,
    mount: Annotated[
        str | None,
        typer.Option(
            "--mount",
            metavar="DEG,DEG",
            help="Mounts of the antenna for the least tilt: 0 upright, 90 flat.",
            show_default=f"{MOUNTS}, if --reach is stated",
        ),
    ] = None,
    proof: ProofOptions,
    fast: Fast = False,
    width: Width = None,
    bounds: Annotated[bool, typer.Option("--bounds", help="Draw the upper bounds as bands.")] = False,
    json_output: JsonOutput = False,
) -> None:
    """Solve at many values of one setting.

    It writes a table (CSV) and a figure (PNG, SVG, PDF).
    """
    from nullpose.errors import require_usage
    from nullpose.solver import SolveOptions
    from nullpose.study import spaced, sweep as sweep_scenario

    varied = [setting.strip() for setting in settings if "=" not in setting]
    require_usage(
        len(varied) == 1,
        f"--set: exactly one path to vary is needed, without a value; given {', '.join(settings)}",
    )
    # the varied key may be one without which the others make no scenario, as the exponent of a power law is
    fixed = [setting if "=" in setting else f"{setting}={start!r}" for setting in settings]
    scene = SceneOptions(file=file, overrides=fixed, allow_outside=allow_outside, at_s=at_s)
    scenario = scene.read()
    mounts_deg = None if reach is None and mount is None else mounts_of(mount or MOUNTS)
    if mounts_deg is not None:
        refuse("with a least tilt", scheme=scheme, fast=fast, bounds=bounds)
    options = proof.keywords(fast)
    SolveOptions(**options)
    values = spaced(start, stop, points, log=log)
    names = [f"sweep.{end}" for end in ("csv", "png", "svg", "pdf")]
    scene.check_outputs((f"--out ({name})", out / name) for name in names)
    schemes = [name.value for name in scheme] if scheme else None
    with compiling_announced(proof.time_limit), Ticker(f"sweep of {varied[0]}") as ticker:
        found = sweep_scenario(
            scenario,
            varied[0],
            values,
            schemes=schemes,
            mounts_deg=mounts_deg,
            share=REACH if reach is None else reach,
            on_progress=ticker,
            **options,
        )
    if scenario.array is not None:
        say("The swept cases have one dipole; the file's array is left out.", err=True)
    from nullpose.report.sweep import sweep_view, write_sweep

    files = write_sweep(found, out, log=log, width=width, bounds=bounds)
    tell(found, sweep_view, json_output, files=files, **scenario.instant)
