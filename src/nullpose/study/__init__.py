"""Many solves and the table that they fill: a setting swept, vehicles or antennas compared."""

from nullpose.study.antenna_comparison import compare_antennas
from nullpose.study.case import AIRFRAME_CASES, Case
from nullpose.study.evaluation import Evaluation, GivenDetails, evaluate_against
from nullpose.study.field import Field
from nullpose.study.least_tilt import LeastTilt, MountTilt, least_tilt
from nullpose.study.poses_csv import poses_from_csv
from nullpose.study.sweep import spaced, sweep
from nullpose.study.table import Guaranteed, ResultRow, ResultTable
from nullpose.study.value_map import value_map
from nullpose.study.vehicle_search import Sufficiency
from nullpose.study.vehicles import (
    cases_of,
    compare_airframes,
    compare_schemes,
    difference,
    least_sufficient,
    verdict_on,
)

__all__ = [
    "AIRFRAME_CASES",
    "Case",
    "Evaluation",
    "Field",
    "GivenDetails",
    "Guaranteed",
    "LeastTilt",
    "MountTilt",
    "ResultRow",
    "ResultTable",
    "Sufficiency",
    "cases_of",
    "compare_airframes",
    "compare_antennas",
    "compare_schemes",
    "difference",
    "evaluate_against",
    "least_sufficient",
    "least_tilt",
    "poses_from_csv",
    "spaced",
    "sweep",
    "value_map",
    "verdict_on",
]
