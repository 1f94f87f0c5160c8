"""What a solve may be asked for, and the words in which the rest is refused."""

import math
from typing import Any

import pytest

from nullpose.errors import UsageError
from nullpose.solver.options import SolveOptions, default_gap

NAN, INF = math.nan, math.inf
REFUSED: list[tuple[str, str, list[Any]]] = [
    ("gap", "gap", [0.0, 0.99e-9, 10.01, -1.0, NAN, INF, -INF]),
    ("time_limit_s", "time limit", [0.0, -1.0, NAN, -INF]),
    ("node_limit", "node limit", [0, -1, 1.5, 1.0, True, "9", None]),
    ("threads", "threads", [0, 1.5]),
    ("seed", "seed", [-1, 1.5, True]),
]


def test_gaps_by_default() -> None:
    """Up to 3 nodes a millionth, up to 20 a ten-thousandth, a thousandth beyond."""
    gaps = {1: 1e-6, 3: 1e-6, 4: 1e-4, 20: 1e-4, 21: 1e-3, 1000: 1e-3}
    assert {nodes: default_gap(nodes) for nodes in gaps} == gaps


@pytest.mark.parametrize(("key", "name", "values"), REFUSED, ids=[key for key, _, _ in REFUSED])
def test_what_cannot_be_met_is_refused(key: str, name: str, values: list[Any]) -> None:
    """Numbers out of range, and what is no number."""
    for value in values:
        with pytest.raises(UsageError, match=f"{name}: given"):
            SolveOptions(**{key: value})


@pytest.mark.parametrize("allowed", [{"gap": 1e-8}, {"gap": 10.0}, {"time_limit_s": INF}, {"node_limit": 1}])
def test_the_ends_of_a_range_belong_to_it(allowed: dict[str, Any]) -> None:
    """The finest and the widest gap, endless time, one box."""
    assert SolveOptions(**allowed)
