"""Many solves: a setting varied over a range and the table it fills, and vehicles compared."""

from nullpose.study.airframe_cases import AIRFRAME_CASES, AirframeCase, cases_of
from nullpose.study.airframe_comparison import (
    AirframeComparison,
    AirframeResult,
    Guaranteed,
    compare_airframes,
)
from nullpose.study.antenna_comparison import AntennaComparison, compare_antennas
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
    "Field",
    "Guaranteed",
    "SweepPlan",
    "SweepRow",
    "SweepTable",
    "cases_of",
    "compare_airframes",
    "compare_antennas",
    "plan_sweep",
    "spaced",
    "sweep",
    "value_map",
]
