"""What a pattern file holds, in words."""

import dataclasses
import io

import numpy as np
from rich.console import Console

from nullpose.antenna.summary import PatternSummary, summary_of
from nullpose.antenna.table import PatternTable
from nullpose.report.pattern import pattern_view


def told(summary: PatternSummary) -> str:
    """Returns what is printed."""
    console = Console(file=io.StringIO(), width=200)
    console.print(pattern_view(summary))
    return console.file.getvalue()


def test_an_isotropic_table_without_frequency() -> None:
    """No null is invented, no frequency and no size; notes and what is not known are told."""
    table = PatternTable(
        theta_deg=np.arange(0.0, 181.0, 15.0),
        phi_deg=np.arange(0.0, 360.0, 15.0),
        gain=np.ones((13, 24)),
        source="x.csv (csv)",
        notes=("A note.",),
    )
    text = told(summary_of(table))
    assert "x.csv (csv)" in text.splitlines()[0]
    assert "deepest null      none" in text
    assert "polarisation      not known" in text
    assert text.rstrip().endswith("A note.")
    coarse = dataclasses.replace(summary_of(table), null_db=12.34, null_deg=(30.0, 45.0))
    assert "12.3 dB below the peak, at theta 30, phi 45" in told(coarse)
