"""The smallest scenario as plain data, the faults of others, and the best poses of the examples."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import Result as Ended

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario import Scenario, load
from nullpose.solver import Result, solve

Run = Callable[..., Ended]
"""Runs a verb in this process: the fixture of the command line's tests."""

EXAMPLES = Path(__file__).parents[2] / "examples"
NODE: dict[str, Any] = {"position_m": [0.0, 0.0, 0.0], "power_w": 1.0}


def small(**tables: Any) -> dict[str, Any]:
    """Return a scenario of one node with these tables too; None takes one away."""
    data = {
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "nodes": [NODE],
    }
    return {key: value for key, value in (data | tables).items() if value is not None}


def faults_of(data: dict[str, Any]) -> dict[str, str]:
    """Return the messages, by path, with which a scenario is refused; none of a sound one."""
    try:
        Scenario.from_dict(data)
    except ScenarioError as error:
        return {fault.path: fault.message for fault in error.faults}
    return {}


def load_faults(path: str | os.PathLike[str]) -> list[Fault]:
    """Return the faults with which a file is refused; the error names the file, and no library."""
    with pytest.raises(ScenarioError) as caught:
        load(path)
    assert caught.value.source == os.fspath(path)
    assert caught.value.__suppress_context__
    return list(caught.value.faults)


def require_fault(make: Callable[[], object], path: str, words: str) -> None:
    """Check that there is one fault, at this path and in these words."""
    with pytest.raises(ScenarioError) as caught:
        make()
    (fault,) = caught.value.faults
    assert fault.path == path
    assert words in fault.message


def star(rng: np.random.Generator, count: int, size_m: float) -> np.ndarray:
    """Return a polygon that runs once around the origin, counter-clockwise, often not convex."""
    gaps = rng.uniform(0.5, 1.0, count)
    angles = np.cumsum(gaps) * 2.0 * np.pi / gaps.sum()
    return size_m * rng.uniform(0.1, 1.0, (count, 1)) * np.column_stack([np.cos(angles), np.sin(angles)])


@cache
def best_found(name: str, *, robust: bool = False) -> Result:
    """Return the best pose found in an example, for tests of what is shown of it."""
    return solve(load(EXAMPLES / f"{name}.toml").still(), robust=robust, certify=False)
