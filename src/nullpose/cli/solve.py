"""The verb ``solve``: of one dipole, of an array, or under errors."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from nullpose.cli.options import (
    AllowOutside,
    CertificateFile,
    Fast,
    FigureFile,
    FigureWidth,
    Gap,
    GeoJsonFile,
    JsonOutput,
    NodeLimit,
    NullJammer,
    Off,
    Overrides,
    Robust,
    ScenarioFile,
    Seed,
    TimeLimit,
    Verified,
    Width,
    error_sizes,
    read_scenario,
    refuse,
    solve_options,
)
from nullpose.cli.output import compiling_announced, prepare_outputs, tell
from nullpose.cli.progress import GapBar, Ticker
from nullpose.problem.schemes import Scheme

if TYPE_CHECKING:
    from nullpose.scenario import Scenario
    from nullpose.solver import ErrorSizes, Result

_REJECTED = "{}; this is a fault of nullpose: please report it with the scenario"


def solve(
    file: ScenarioFile,
    scheme: Annotated[
        Scheme, typer.Option("--scheme", metavar="NAME", help="One of the schemes above.")
    ] = Scheme.OPTIMUM,
    overrides: Overrides = None,
    allow_outside: AllowOutside = False,
    gap: Gap = None,
    time_limit: TimeLimit = 60.0,
    node_limit: NodeLimit = 10**9,
    fast: Fast = False,
    seed: Seed = 0,
    robust: Robust = False,
    off: Off = None,
    null_jammer: NullJammer = None,
    certificate: CertificateFile = None,
    verify: Verified = False,
    geojson: GeoJsonFile = None,
    figure: FigureFile = None,
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

    scenario = read_scenario(file, overrides, allow_outside)
    prepare_outputs(file, overrides, certificate=certificate, geojson=geojson, figure=figure, width=width)
    options, sizes = solve_options(gap, time_limit, node_limit, fast, seed), error_sizes(off)
    checked = verify or certificate is not None
    of_one_dipole = {
        "scheme": scheme is not Scheme.OPTIMUM,
        "null_jammer": null_jammer,
        "certificate": certificate,
        "verify": verify,
    }
    if geojson is not None:
        from nullpose.report.geojson import require_origin

        require_origin(scenario)
    if robust:
        refuse("with --robust", **of_one_dipole)
        found = _solve_robustly(scenario, sizes, options)
    elif scenario.array is not None:
        refuse("for a scenario with an [array]", geojson=geojson, **of_one_dipole)
        from nullpose.solver import solve as solve_scenario

        with compiling_announced():
            found = solve_scenario(scenario, **options)
    else:
        refuse("with --fast, which proves nothing,", certificate=certificate and fast, verify=verify and fast)
        found = _solve_dipole(scenario, scheme, null_jammer, options, checked)
    found = replace(found, error_sizes=sizes)
    rejected = checked and found.rigour.value != "verified"
    files = _write(found, None if rejected else certificate, geojson, figure, width)
    fault = _REJECTED.format(found.reason) if rejected else ""
    tell(found, result_view, json_output, files=files, fault=fault)


def _solve_robustly(scenario: Scenario, sizes: ErrorSizes, options: dict[str, Any]) -> Result:
    """Return the pose that guarantees most under the scenario's errors, or those of the sizes."""
    from nullpose.scenario.overrides import Override, apply_overrides
    from nullpose.solver import solve as solve_scenario
    from nullpose.solver.options import SolveOptions
    from nullpose.solver.robust import ROBUST_GAP

    note, disc_m = "", [sizes.jammers_m, sizes.jammers_m, 0.0]
    if not scenario.is_uncertain:
        points = scenario.objective_record.interferers
        errors = {
            "receiver.attitude_error_deg": sizes.attitude_deg,
            "receiver.position_error_m": sizes.position_m,
            **{f"{points}[{i}].uncertainty_m": disc_m for i in range(len(getattr(scenario, points)))},
        }
        scenario = apply_overrides(scenario, [Override(path, size) for path, size in errors.items()])
        note = "The scenario states no errors. These are taken in their place; --off changes them."
    target = SolveOptions(**options).of(scenario, ROBUST_GAP).target
    with compiling_announced(), GapBar(target) as bar:
        found = solve_scenario(scenario, robust=True, on_progress=bar, **options)
    return replace(found, note=" ".join(filter(None, (note, found.note))))


def _solve_dipole(
    scenario: Scenario,
    scheme: Scheme,
    null_jammer: str | None,
    options: dict[str, Any],
    checked: bool,
) -> Result:
    """Return where a scenario's dipole hears most, its proof checked if that is wanted.

    Raises:
        UsageError: before any work, there is no proof that could be checked.
    """
    from nullpose.solver import solve as solve_scenario
    from nullpose.solver.options import SolveOptions

    if checked:
        from nullpose.solver.certificate_from_proof import require_certificate, verified

        require_certificate(scenario, scheme.value, null_jammer)
    target = SolveOptions(**options).of(scenario).target
    with compiling_announced(), GapBar(target) as bar:
        solution = solve_scenario(scenario, scheme.value, null_jammer=null_jammer, on_progress=bar, **options)
    if not checked:
        return solution
    with Ticker("checking leaves") as ticker:
        return verified(solution, ticker)


def _write(
    solution: Result,
    certificate: Path | None,
    geojson: Path | None,
    figure: Path | None,
    width: FigureWidth | None,
) -> list[Path]:
    """Return the files that were asked for after writing them."""
    if certificate is not None:
        from nullpose.certificate import write_certificate
        from nullpose.solver.certificate_from_proof import certificate_of

        write_certificate(certificate_of(solution), certificate)
    if geojson is not None:
        from nullpose.report.geojson import write_geojson

        write_geojson(solution, geojson)
    if figure is not None:
        from nullpose.report.figures.poses import draw_result
        from nullpose.report.figures.style import write_figure_file

        write_figure_file(draw_result(solution, width), figure)
    return [path for path in (certificate, geojson, figure) if path is not None]
