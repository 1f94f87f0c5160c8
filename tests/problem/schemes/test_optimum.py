"""The optimum pose of the paper's scene, against the values known from several independent solvers."""

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from nullpose.solver import Scheme, Status, solve

KNOWN = Path(__file__).parents[2] / "reference" / "paper_scenario" / "known_answers.csv"


def known(scheme: Scheme) -> list[tuple[float, float, float]]:
    """Returns (jamming ratio, dB, half a unit of its last digit) of a scheme, errata corrected."""
    with KNOWN.open(encoding="utf-8", newline="") as lines:
        _units, *rows = csv.DictReader(lines)
    answers = []
    for row in rows:
        if row["scheme"] == scheme and row["jamming_ratio"]:
            text = row["corrected_db"] or row["min_sinr_db"]
            answers.append((float(row["jamming_ratio"]), float(text), 0.5 * 10.0 ** -len(text.split(".")[1])))
    assert answers
    return answers


@pytest.mark.parametrize("scheme", [Scheme.OPTIMUM, Scheme.MAXIMUM_GAIN, Scheme.VERTICAL])
def test_the_known_answers(scheme: Scheme, paper: Callable) -> None:
    """Every value known for a scheme is met to all of its digits."""
    for ratio, value_db, half_digit in known(scheme):
        found_db = solve(paper(ratio), scheme).objective.value_db
        assert found_db == pytest.approx(value_db, abs=1.02 * half_digit), ratio


@pytest.mark.parametrize("ratio", [1e-3, 0.03, 1.0, 30.0, 1e3, 1e6, 1e9])
def test_zero_interference_is_known_for_every_power(ratio: float, paper: Callable) -> None:
    """Zero interference is 0.8123549 dB at (-2.690, 23.215, 8), whatever the jamming power."""
    solution = solve(paper(ratio), Scheme.ZERO_INTERFERENCE)
    assert solution.objective.value_db == pytest.approx(0.8123549, abs=6e-8)
    np.testing.assert_allclose(solution.pose.position_m, [-2.690, 23.215, 8.0], atol=6e-4)


def test_the_optimum_falls_to_zero_interference(paper: Callable) -> None:
    """As the jamming grows the optimum falls to zero interference, with the reciprocal of the power."""
    ratios = np.array([1e2, 1e3, 1e4, 1e5, 1e6])
    values = np.array([solve(paper(ratio)).objective.value for ratio in ratios])
    silent = solve(paper(1.0), Scheme.ZERO_INTERFERENCE).objective.value
    assert np.all(np.diff(values) < 0.0)
    excess = (values - silent) * ratios
    np.testing.assert_allclose(excess[1:], excess[-1], rtol=1e-2)


@pytest.mark.parametrize("altitude_m", [(8.0, 30.0), (0.0, 30.0), (8.0, 8.0)])
def test_one_node_alone_is_closed_form(altitude_m: tuple[float, float], scene: Callable) -> None:
    """One node and no jammer: broadside, from as near as floor and keep-out allow, P / (sigma^2 d^2)."""
    value = solve(scene([(0, 0, 0)], altitude_m=altitude_m)).objective.value
    assert value == pytest.approx(1e3 / max(altitude_m[0], 1.0) ** 2, rel=1e-9)


@pytest.mark.parametrize("ratio", [1e-3, 0.1, 1.0, 10.0, 1e3, 1e6])
@pytest.mark.parametrize("scheme", Scheme)
def test_the_paper_is_certified(scheme: Scheme, ratio: float, paper: Callable) -> None:
    """Each of the paper's cases is closed to a millionth at every strength of the jamming."""
    solution = solve(paper(ratio), scheme)
    assert (solution.status, solution.reason) == (Status.CERTIFIED, "")
    assert 0.0 <= solution.objective.relative_gap <= 1e-6
