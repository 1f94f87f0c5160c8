"""Rows are read once, part by part, into arrays that say the same."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from nullpose.report.study import values as values_module
from nullpose.report.study.values import STATUSES, gather
from nullpose.study.monte_carlo import read_study

Make = Callable[..., Path]


def test_arrays_are_the_rows(make: Make, ladder: Callable[..., Any]) -> None:
    """By scene, combination and case; what is maximised in dB; batches are passed on as they come."""
    cells = ladder(9, 1.0, 2.0, points=2)
    cells[2][1][0], cells[8][0][2], cells[8][1][2] = "no room", (3.0, "best-found"), (3.0, "given")
    table = read_study(make(cells, sweep={"jammers.M.power_w": [1.0, 2.0]}))
    batches: list[pd.DataFrame] = []
    values = gather(table, batches.append)
    assert values.value.shape == (9, 2, 3)
    frame = table.frame()
    np.testing.assert_allclose(values.value.ravel(), 10.0 * np.log10(frame["value"].to_numpy(float)))
    assert [STATUSES[code] for code in values.status.ravel()] == list(frame["status"])
    np.testing.assert_allclose(values.gap.ravel(), frame["gap"].to_numpy(float), rtol=1e-6)
    assert values.counts() == {
        "certified": 51,
        "gap-not-reached": 0,
        "best-found": 1,
        "given": 1,
        "failed": 1,
    }
    assert [len(batch) for batch in batches] == [24, 24, 6]
    assert {"value_db", "bound_db"} <= set(batches[0].columns)


def test_reasons_are_counted_up_to_a_number(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    """Reasons that quote numbers, each its own, do not fill the memory."""
    monkeypatch.setattr(values_module, "_MOST_REASONS", 2)
    reasons = gather(read_study(make([[[f"no room for {n}", 1.0, 2.0]] for n in range(6)]))).reasons
    assert sum(reasons.values()) == 6
    assert len(reasons) == 3
    assert reasons["level-vertical", "failed", "other reasons"] == 4


def test_what_is_maximised(make: Make) -> None:
    """By the study's own word for it."""
    assert read_study(make([[[1.0, 2.0, 3.0]]])).quantity.noun == "SINR"
