"""Many solves: a setting varied over a range and the table it fills, and vehicles compared."""

from nullpose.study.airframe_cases import AIRFRAME_CASES, AirframeCase, cases_of
from nullpose.study.airframe_comparison import (
    AirframeComparison,
    AirframeResult,
    Guaranteed,
    compare_airframes,
)
from nullpose.study.antenna_comparison import AntennaComparison, compare_antennas
from nullpose.study.evaluation import Evaluation, GivenDetails, evaluate_against
from nullpose.study.poses_csv import poses_from_csv
from nullpose.study.spacing import spaced
from nullpose.study.sweep import SweepPlan, plan_sweep, sweep
from nullpose.study.table import SweepRow, SweepTable
from nullpose.study.value_map import Field, value_map

__all__ = [
    "AIRFRAME_CASES",
    "AirframeCase",
    "AirframeComparison",
    "AirframeResult",
    "AntennaComparison",
    "Evaluation",
    "Field",
    "GivenDetails",
    "Guaranteed",
    "SweepPlan",
    "SweepRow",
    "SweepTable",
    "cases_of",
    "compare_airframes",
    "compare_antennas",
    "evaluate_against",
    "plan_sweep",
    "poses_from_csv",
    "spaced",
    "sweep",
    "value_map",
]
