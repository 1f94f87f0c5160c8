"""Specs small enough to be run many times."""

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from nullpose.study.monte_carlo import StudySpec

ROOT = Path(__file__).parents[3]
EXAMPLE = ROOT / "examples" / "study.toml"

TABLES: dict[str, Any] = {
    "name": "small",
    "seed": 3,
    "scenes": 12,
    "gap": 1e-2,
    "scene": {
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
    },
    "nodes": {
        "layout": "rectangle",
        "count": 2,
        "x_m": [-20.0, 20.0],
        "y_m": [0.0, 50.0],
        "power_w": 1.0,
    },
    "jammers": {
        "layout": "disc",
        "name": "M",
        "count": 1,
        "centre_m": [0.0, 25.0],
        "radius_m": 60.0,
        "height_m": 4.0,
        "power_w": {"log_uniform": [0.1, 10.0]},
    },
}

Tables = Callable[..., dict[str, Any]]


@pytest.fixture(scope="session")
def tables() -> Tables:
    """The small spec as plain data, with changes by dotted path; None takes a key away."""

    def changed(**changes: Any) -> dict[str, Any]:
        whole = copy.deepcopy(TABLES)
        for path, value in changes.items():
            *parents, key = path.split("__")
            table = whole
            for parent in parents:
                table = table.setdefault(parent, {})
            if value is None:
                table.pop(key, None)
            else:
                table[key] = value
        return whole

    return changed


@pytest.fixture(scope="session")
def spec(tables: Tables) -> Callable[..., StudySpec]:
    """The small spec with changes by dotted path."""
    return lambda **changes: StudySpec.from_dict(tables(**changes))


@pytest.fixture(scope="session")
def quick(spec: Callable[..., StudySpec]) -> Callable[..., StudySpec]:
    """A study whose scenes take less than a millisecond: a pose that is given."""
    pose = {"name": "hover", "pose": {"position_m": [0.0, 25.0, 10.0], "roll_deg": 90.0}}
    return lambda **changes: spec(**{"cases": [pose], **changes})
