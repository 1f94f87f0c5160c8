"""The verb ``map``."""

from __future__ import annotations

from typing import Annotated

import typer

from nullpose.cli.options import Fast, JsonOutput, OutFolder, ProofOptions, SceneOptions, Width, expanded
from nullpose.cli.output import compiling_announced, tell
from nullpose.cli.progress import GapBar
from nullpose.problem.schemes import Scheme


@expanded
def best_map(
    *,
    scene: SceneOptions,
    out: OutFolder,
    scheme: Annotated[
        Scheme, typer.Option("--scheme", help="Scheme that chooses the axis.")
    ] = Scheme.OPTIMUM,
    altitude: Annotated[
        float | None,
        typer.Option(
            "--altitude", metavar="M", help="Altitude of the map, metres.", show_default="the best pose's"
        ),
    ] = None,
    cells: Annotated[
        int, typer.Option("--cells", metavar="N", help="Number of points along the longer side.")
    ] = 181,
    proof: ProofOptions,
    fast: Fast = False,
    width: Width = None,
    json_output: JsonOutput = False,
) -> None:
    """Draw a map of the best value at each position.

    At each position the axis is the best one that the scheme allows.

    It writes a table (CSV) and a figure (PNG, PDF).
    """
    from nullpose.files import prepare_folder
    from nullpose.report.sweep import map_view, write_map
    from nullpose.solver import solve
    from nullpose.solver.options import SolveOptions
    from nullpose.study.value_map import require_map, value_map

    scenario = scene.read()
    require_map(scenario, altitude, cells)
    scene.check_outputs((f"--out ({name})", out / name) for name in ("map.csv", "map.png", "map.pdf"))
    options = proof.keywords(fast)
    with compiling_announced(proof.time_limit), GapBar(SolveOptions(**options).of(scenario).target) as bar:
        result = solve(scenario, scheme.value, on_progress=bar, **options)
        field = value_map(result, altitude_m=altitude, cells=cells)
    files = write_map(result, field, prepare_folder(out), width)
    tell(result, lambda found: map_view(found, field), json_output, files=files, map=field.to_dict())
