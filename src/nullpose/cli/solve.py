"""The verb ``solve``: of one dipole, of an array, or under errors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nullpose.cli.options import (
    Fast,
    FigureFiles,
    FigureWidth,
    JsonOutput,
    Off,
    ProofOptions,
    SceneOptions,
    Width,
    error_sizes,
    expanded,
    refuse,
)
from nullpose.cli.output import compiling_announced, prepare_outputs, tell
from nullpose.cli.printing import say
from nullpose.cli.progress import GapBar, Ticker
from nullpose.problem.schemes import Scheme

if TYPE_CHECKING:
    from nullpose.scenario import Scenario
    from nullpose.solver import ErrorSizes, Result

_REJECTED = "{}; this is a fault of nullpose: please report it with the scenario"
_ASSUMED = (
    "Your file states no errors, so these count (change: --off), "
    "balls no larger than the airspace allows: {}."
)
_CLEAR = 0.99  # of the way to where the vehicle may be, which balls that are assumed may take


@expanded
def solve(
    *,
    scene: SceneOptions,
    scheme: Annotated[
        Scheme, typer.Option("--scheme", metavar="NAME", help="One of the schemes above.")
    ] = Scheme.OPTIMUM,
    proof: ProofOptions,
    fast: Fast = False,
    robust: Annotated[
        bool,
        typer.Option(
            "--robust", help="Maximise the value guaranteed under the scenario's errors; default gap 1e-2."
        ),
    ] = False,
    hover: Annotated[
        bool,
        typer.Option(
            "--hover",
            help="For a scene in motion: hold one pose at all its instants, the value being the smallest; "
            "default gap 1e-4.",
        ),
    ] = False,
    off: Off = None,
    null_jammer: Annotated[
        str | None,
        typer.Option(
            "--null-jammer",
            metavar="NAME",
            help="For zero-interference: the jammer to point the null at. Default: each is tried.",
            show_default=False,
        ),
    ] = None,
    certificate: Annotated[
        Path | None,
        typer.Option(
            "--certificate",
            metavar="FILE",
            help="Check the proof and write it to FILE, for nullpose verify. FILE.gz is compressed.",
            show_default=False,
        ),
    ] = None,
    verify: Annotated[
        bool,
        typer.Option("--verify", help="Check the proof in interval arithmetic, as nullpose verify does."),
    ] = False,
    export: Annotated[
        list[Path] | None,
        typer.Option(
            "--export",
            metavar="FILE",
            help="Write the pose to FILE for another program, in the format of its ending: .json, .tum, "
            ".csv, .geojson, .kml, .plan or .mcap. Can be repeated.",
            show_default=False,
        ),
    ] = None,
    figure: FigureFiles = None,
    width: Width = None,
    json_output: JsonOutput = False,
) -> None:
    """Find the best pose, and prove how good it is.

    The proof says how far the pose's value can be below the optimum.

    \b
    Schemes:
      optimum               the best pose of all
      zero-interference     the null points at a jammer
      maximum-gain          the antenna broadside to the nodes; of three or more,
                            the axis with the largest smallest signal
      vertical              the antenna upright
    """  # noqa: D301  the mark that keeps the lines as they are
    from nullpose.report.results import result_view
    from nullpose.report.words import error_words
    from nullpose.solver import solve as solve_scenario
    from nullpose.solver.certificate_from_proof import require_certificate, verified
    from nullpose.solver.hover import HOVER_GAP
    from nullpose.solver.options import SolveOptions
    from nullpose.solver.robust import ROBUST_GAP

    scenario = scene.read(in_motion=hover)
    if exports := export or []:
        from nullpose.report.export import require_exports

        require_exports(scenario.still(), exports)
    prepare_outputs(scene, certificate=certificate, export=exports, figure=figure or [], width=width)
    options, sizes = proof.keywords(fast), error_sizes(off)
    is_checked = verify or certificate is not None
    is_array = scenario.array is not None and not robust
    if robust or hover or is_array:
        refuse(
            "with --hover" if hover else "with --robust" if robust else "for a scenario with an [array]",
            robust=robust and hover,
            export=exports if is_array else None,
            scheme=scheme is not Scheme.OPTIMUM,
            null_jammer=null_jammer,
            certificate=None if hover else certificate,
            verify=verify and not hover,
        )
    if fast:
        refuse("with --fast", certificate=certificate, verify=verify)
    if is_checked:
        require_certificate(scenario, scheme.value, null_jammer)
    note = ""
    if robust and not scenario.is_uncertain:
        scenario = _with_errors(scenario, sizes)
        note = _ASSUMED.format(error_words(scenario))
    gap = ROBUST_GAP if robust else HOVER_GAP if hover else None
    target = SolveOptions(**options).of(scenario, gap).target
    with compiling_announced(proof.time_limit), GapBar(target) as bar:
        found = solve_scenario(
            scenario, scheme, null_jammer=null_jammer, robust=robust, hover=hover, on_progress=bar, **options
        )
    if is_checked:
        with Ticker("checking leaves") as ticker:
            found = verified(found, ticker)
    note = " ".join(filter(None, (note, found.note)))
    found = replace(found, error_sizes=None if hover else sizes, note=note)
    is_rejected = is_checked and found.rigour.value != "verified"
    files = _write(found, None if is_rejected else certificate, exports, figure or [], width)
    fault = _REJECTED.format(found.reason) if is_rejected else ""
    tell(found, result_view, json_output, files=files, fault=fault)


def _with_errors(scenario: Scenario, sizes: ErrorSizes) -> Scenario:
    """Give a scenario the errors of the sizes; balls are smaller that the vehicle might meet."""
    import numpy as np

    from nullpose.problem.build import distances_m
    from nullpose.scenario import apply_overrides
    from nullpose.scenario.overrides import Override

    airspace, kind = scenario.airspace, scenario.objective_record.interferers
    apart_m = distances_m(scenario.of_interferers("positions_m"), airspace.lower_m, airspace.upper_m)
    free_m = _CLEAR * np.maximum(apart_m, airspace.keep_out_m) - sizes.position_m
    errors = {
        "receiver.attitude_error_deg": sizes.attitude_deg,
        "receiver.position_error_m": sizes.position_m,
        **{
            f"{kind}[{i}].uncertainty_m": radius_m
            for i, radius_m in enumerate(np.clip(free_m, 0.0, sizes.jammers_m).tolist())
        },
    }
    return apply_overrides(scenario, [Override(path, size) for path, size in errors.items()])


def _write(
    result: Result,
    certificate: Path | None,
    exports: Sequence[Path],
    figures: Sequence[Path],
    width: FigureWidth | None,
) -> list[Path]:
    """Write the files that have a name, and say what a format cannot hold; return their paths."""
    if certificate is not None:
        from nullpose.certificate import write_certificate
        from nullpose.solver.certificate_from_proof import certificate_of

        write_certificate(certificate_of(result), certificate)
    if exports:
        from nullpose.report.export import write_export

        for path in exports:
            if lost := write_export(result, path):
                say(f"{path}: {lost}", err=True)
    if figures:
        from nullpose.report.figures.poses import draw_result
        from nullpose.report.figures.style import write_figure

        write_figure(draw_result(result, width), *figures)
    return [*filter(None, [certificate]), *exports, *figures]
