"""Antennas compared: the paper's best pose flown with a scenario's antennas, and the best pose for these."""

from __future__ import annotations

import math
from types import MappingProxyType
from typing import Unpack

from nullpose.errors import require_usage
from nullpose.scenario import Antenna, Scenario
from nullpose.scenario.origin import POINT_LISTS
from nullpose.solver import Result, solve
from nullpose.solver.options import SolveKeywords, SolveOptions
from nullpose.solver.result import provenance
from nullpose.study.case import Case, OnProgress, report_steps
from nullpose.study.evaluation import evaluated
from nullpose.study.table import ResultRow, ResultTable


def compare_antennas(
    scenario: Scenario,
    *,
    on_progress: OnProgress = None,
    **options: Unpack[SolveKeywords],
) -> ResultTable:
    """Solve a scenario with the paper's antennas and with its own, and fly the first pose with the latter.

    The rows are ``promised``, the best pose for the paper's antennas with these; ``received``, that pose with
    the scenario's antennas; ``with_ground`` and ``with_null``, that pose with those on the ground alone and
    with the drone's alone; ``possible``, the best pose for the scenario's antennas.

    Args:
        scenario: states another antenna than the paper's, on the drone or on the ground.
        on_progress: called with how many of the two solves are done.
        options: as for :func:`nullpose.solver.solve`.

    Raises:
        UsageError: every antenna is the paper's; a bad seed or limit.
        SolveError: no pose reaches every node.
    """
    solve_options = SolveOptions(**options).of(scenario)
    require_usage(
        scenario.states_antennas,
        "antenna: every antenna is the paper's, a dipole with a perfect null on the drone and isotropic "
        "ones on the ground; state [antenna] null_depth_db, or antenna at a node or a jammer",
    )
    results: dict[str, Result] = {}
    scenes = {"promised": with_antennas(scenario, drone=False, ground=False), "possible": scenario}
    for name, scene in report_steps([*scenes.items()], on_progress):
        results[name] = solve(scene, **options)
        options["certify"] = solve_options.certify and not results[name].interrupted
    flown = {
        "received": scenario,
        "with_ground": with_antennas(scenario, drone=False, ground=True),
        "with_null": with_antennas(scenario, drone=True, ground=False),
    }
    promised = results["promised"]
    evaluations = {name: evaluated(promised, scene, promised.pose) for name, scene in flown.items()}
    results = {"promised": promised, **evaluations, "possible": results["possible"]}
    rows = (ResultRow.of(math.nan, result, Case(name=name)) for name, result in results.items())
    settings = MappingProxyType(provenance(solve_options.seed) | solve_options.settings)
    return ResultTable("", tuple(rows), scenario=scenario, provenance=settings)


def with_antennas(scenario: Scenario, *, drone: bool, ground: bool) -> Scenario:
    """Keep the antennas of a scenario, or put in the paper's of the same gain.

    Args:
        scenario: as stated.
        drone: whether to keep the drone's.
        ground: whether to keep those on the ground.
    """
    changed: dict[str, object] = {} if drone else {"antenna": Antenna(gain_dbi=scenario.antenna_gain_dbi)}
    if not ground:
        changed |= {kind: tuple(each.isotropic for each in getattr(scenario, kind)) for kind in POINT_LISTS}
        changed["destination"] = scenario.destination and scenario.destination.isotropic
    return scenario.model_copy(update=changed)
