"""Many solves: a setting varied over a range, and the table it fills."""

from nullpose.study.files import prepare_folder, replacing, write_text
from nullpose.study.plan import SweepPlan, plan_sweep
from nullpose.study.spacing import spaced
from nullpose.study.sweep import sweep
from nullpose.study.table import SweepRow, SweepTable

__all__ = [
    "SweepPlan",
    "SweepRow",
    "SweepTable",
    "plan_sweep",
    "prepare_folder",
    "replacing",
    "spaced",
    "sweep",
    "write_text",
]
