"""The optimum pose of the paper's scene, against the values known from several independent solvers."""

from collections.abc import Callable

import numpy as np
import pytest
from paper_schemes import maximum_gain_sinr, zero_interference_sinr
from scipy.optimize import differential_evolution

from nullpose.physics import antenna_gain, sinr
from nullpose.scenario import Scenario
from nullpose.solver import Scheme, Status, solve


def upright_sinr(scene: Scenario, positions: np.ndarray) -> np.ndarray:
    """Return eq. 2.1 for a vertical dipole."""
    return sinr(scene, positions, np.array([0.0, 0.0, 1.0]))


FIELD = ((-30.0, 30.0), (0.0, 50.0), (8.0, 30.0))


@pytest.mark.parametrize(
    ("scheme", "closed_form", "ratio", "bounds"),
    [
        *((Scheme.MAXIMUM_GAIN, maximum_gain_sinr, ratio, FIELD) for ratio in (0.1, 1.0, 3.0, 10.0)),
        (Scheme.ZERO_INTERFERENCE, zero_interference_sinr, 100.0, FIELD),
        (Scheme.VERTICAL, upright_sinr, 0.1, ((-30.0, 30.0), (10.0, 40.0), (8.0, 9.0))),
        # from about P_M/P = 1 on the optimum is a needle, millimetres wide, beside the jammer's vertical
        (Scheme.VERTICAL, upright_sinr, 1.0, ((16.95, 17.05), (14.95, 15.05), (8.0, 9.0))),
        (Scheme.VERTICAL, upright_sinr, 10.0, ((16.99, 17.01), (14.99, 15.01), (8.0, 9.0))),
    ],
)
def test_the_paper_by_differential_evolution(
    scheme: Scheme, closed_form: Callable, ratio: float, bounds: tuple, paper: Callable
) -> None:
    """Differential evolution on the paper's closed form comes to the same value."""
    scene = paper(ratio)
    options = {"vectorized": True, "updating": "deferred", "popsize": 30, "maxiter": 600, "tol": 1e-12}
    searched = differential_evolution(
        lambda positions: -np.log(np.min(closed_form(scene, positions.T), axis=-1)), bounds, seed=1, **options
    )
    found = solve(scene, scheme)
    assert found.objective.value == pytest.approx(np.exp(-searched.fun), rel=1e-9)
    axis = found.pose.antenna_axis
    to_nodes = antenna_gain(found.pose.position_m, axis, scene.node_positions_m)
    to_jammer = antenna_gain(found.pose.position_m, axis, scene.jammer_positions_m)
    assert scheme != Scheme.MAXIMUM_GAIN or to_nodes == pytest.approx([1.0, 1.0], rel=1e-12)
    assert scheme != Scheme.ZERO_INTERFERENCE or to_jammer[0] < 1e-30
    assert found.note == ("null on jammer M1" if scheme == Scheme.ZERO_INTERFERENCE else "")


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


@pytest.mark.parametrize("ratio", [1e-3, 0.1, 1.0, 10.0, 1e3, 1e6])
@pytest.mark.parametrize("scheme", Scheme)
def test_the_paper_is_certified(scheme: Scheme, ratio: float, paper: Callable) -> None:
    """Each of the paper's cases is closed to a millionth at every strength of the jamming."""
    solution = solve(paper(ratio), scheme)
    assert (solution.status, solution.reason) == (Status.CERTIFIED, "")
    assert 0.0 <= solution.objective.relative_gap <= 1e-6
