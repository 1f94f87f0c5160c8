"""The verb ``solve``."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from nullpose.cli.array import refuse_with_array, solve_with_array
from nullpose.cli.faults import INTERRUPTED
from nullpose.cli.figure import prepare_outputs, write_figure
from nullpose.cli.gap_bar import GapBar
from nullpose.cli.options import (
    AllowOutside,
    CombiningName,
    Fast,
    Gap,
    JsonOutput,
    NodeLimit,
    Overrides,
    ScenarioFile,
    Seed,
    TimeLimit,
)
from nullpose.cli.output import Ticker, compiling_announced, show, show_json
from nullpose.cli.robust import refuse_with_robust, solve_robustly
from nullpose.schemes import Scheme

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from nullpose.solve import Solution

__all__ = ["solve"]


def solve(
    file: ScenarioFile,
    scheme: Annotated[Scheme, typer.Option("--scheme", help="How the pose is chosen.")] = Scheme.OPTIMUM,
    overrides: Overrides = None,
    allow_outside: AllowOutside = False,
    gap: Gap = None,
    time_limit: TimeLimit = 60.0,
    node_limit: NodeLimit = 10**9,
    fast: Fast = False,
    seed: Seed = 0,
    robust: Annotated[
        bool,
        typer.Option(
            "--robust", help="Maximise what is guaranteed under the errors that the scenario states."
        ),
    ] = False,
    null_jammer: Annotated[
        str | None,
        typer.Option(
            "--null-jammer",
            metavar="NAME",
            help="Zero interference: the jammer to point the null at. Without it each is tried.",
            show_default=False,
        ),
    ] = None,
    certificate: Annotated[
        Path | None,
        typer.Option(
            "--certificate",
            metavar="FILE",
            help="Write the proof here, for `nullpose verify`; compressed if the name ends in .gz.",
            show_default=False,
        ),
    ] = None,
    verify: Annotated[
        bool,
        typer.Option("--verify", help="Check the proof in outward-rounded arithmetic, as `verify` does."),
    ] = False,
    geojson: Annotated[
        Path | None,
        typer.Option(
            "--geojson",
            metavar="FILE",
            help="Write the pose, the nodes and the airspace here, for a map, as GeoJSON; needs an origin.",
            show_default=False,
        ),
    ] = None,
    combining: Annotated[
        CombiningName | None,
        typer.Option(
            "--combining",
            help="With an [array]: weights for each node, or one beam for all.",
            show_default="digital",
        ),
    ] = None,
    figure: Annotated[
        Path | None,
        typer.Option(
            "--figure",
            metavar="FILE",
            help="Draw what was found in its scene into a file named .png or .svg.",
            show_default=False,
        ),
    ] = None,
    json_output: JsonOutput = False,
) -> None:
    """Find the best pose for a scenario, and prove how far from the best of all it can be."""
    from nullpose.scenario import apply_overrides, load

    scenario = apply_overrides(load(file, allow_outside=allow_outside), overrides or [])
    prepare_outputs(file, certificate=certificate, geojson=geojson, figure=figure)
    special = {
        "scheme": scheme if scheme is not Scheme.OPTIMUM else None,
        "null_jammer": null_jammer,
        "certificate": certificate,
        "verify": verify,
        "geojson": geojson,
    }
    common: dict[str, Any] = {"gap": gap, "certify": not fast, "seed": seed, "json_output": json_output}
    common["figure"] = figure
    if robust:
        refuse_with_robust(**special, combining=combining)
        solve_robustly(scenario, time_limit_s=time_limit, node_limit=node_limit, **common)
        return
    if scenario.array is not None:
        refuse_with_array(**special)
        solve_with_array(scenario, (combining or CombiningName.DIGITAL).value, **common)
        return
    from nullpose.certificate import write_certificate
    from nullpose.errors import SolveError, UsageError
    from nullpose.report.geojson import require_origin, write_geojson
    from nullpose.solve import Rigour, certificate_of, default_gap_of, require_certificate, verified
    from nullpose.solve import solve as solve_scenario

    if combining is not None:
        raise UsageError("--combining: given for a scenario without an [array]; add one, or leave it out")
    checked = verify or certificate is not None
    if checked:
        option = "--certificate" if certificate is not None else "--verify"
        if fast:
            raise UsageError(f"{option}: given with --fast, which proves nothing; leave out one of the two")
        require_certificate(scenario, scheme.value, null_jammer)
    if geojson is not None:
        require_origin(scenario)
    target = default_gap_of(scenario) if gap is None else gap
    with compiling_announced(), GapBar(target) as bar:
        solution = solve_scenario(
            scenario,
            scheme.value,
            gap=target,
            time_limit_s=time_limit,
            node_limit=node_limit,
            certify=not fast,
            seed=seed,
            null_jammer=null_jammer,
            on_progress=bar,
        )
    if checked:
        with Ticker("checking leaves") as ticker:
            solution = verified(solution, ticker)
    rejected = checked and solution.rigour is not Rigour.VERIFIED
    if certificate is not None and not rejected:
        write_certificate(certificate_of(solution), certificate)
    if geojson is not None:
        write_geojson(solution, geojson)
    write_figure(figure, partial(_drawn, solution))
    if json_output:
        show_json(solution.to_dict())
    else:
        from nullpose.report.results import solution_view

        show(solution_view(solution))
    if rejected:
        raise SolveError(
            f"{solution.reason}; this is a fault of nullpose: please report it with the scenario"
        )
    if solution.interrupted:
        raise typer.Exit(INTERRUPTED)


def _drawn(solution: Solution) -> Figure:
    from nullpose.report.figures import draw_pose

    return draw_pose(solution)
