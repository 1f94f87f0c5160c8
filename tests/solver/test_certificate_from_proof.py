"""From a proof to a certificate: dyadic boxes, cells and multipliers as the verifier takes them."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.certificate import verify
from nullpose.errors import UsageError
from nullpose.scenario import Airframe, Eavesdropper, Scenario, Transmitter
from nullpose.solver import Result, solve
from nullpose.solver.certificate_from_proof import certificate_of

ENOUGH_S = 600.0


def solved(scenario: Scenario, scheme: str = "optimum", gap: float = 1e-2) -> Result:
    """Return a solution with its proof, however long the kernels take to be compiled."""
    return solve(scenario, scheme, gap=gap, time_limit_s=ENOUGH_S)


def test_the_certificate_is_of_the_solution(paper: Callable) -> None:
    """Claim, pose and provenance are the solution's, and the verifier accepts it."""
    for scheme in ("optimum", "vertical", "maximum-gain", "zero-interference"):
        solution = solved(paper(1.0), scheme)
        certificate = certificate_of(solution)
        assert certificate.scenario is solution.scenario
        assert (certificate.scheme, certificate.null_jammer) == (scheme, None)
        assert certificate.value == solution.objective.value
        assert certificate.upper_bound == solution.objective.upper_bound
        assert certificate.position_m.tolist() == list(solution.pose.position_m)
        assert certificate.provenance == dict(solution.provenance)
        assert len(certificate.trees[0].leaves) == len(solution.proofs[0].leaves)
        assert verify(certificate).proved


def test_an_unfinished_proof_has_a_certificate(paper: Callable) -> None:
    """The bound from distances alone, and that of any limit, can be checked too."""
    for node_limit in (1, 10, 100, 1000):
        solution = solve(paper(1.0), gap=1e-8, node_limit=node_limit, time_limit_s=ENOUGH_S)
        assert solution.objective.upper_bound > solution.objective.value
        assert verify(certificate_of(solution)).proved


@pytest.mark.parametrize("altitude_m", [(8.0, 30.0), (8.0, 8.0)])
def test_a_bound_from_distances_has_leaves_that_show_it(altitude_m: tuple, scene: Callable) -> None:
    """Above a lone node the distance says it all: the certificate must prove the bound that is stated."""
    solution = solve(scene([(0, 0, 0)], altitude_m=altitude_m), time_limit_s=ENOUGH_S)
    assert verify(certificate_of(solution)).proved


@pytest.mark.parametrize(
    "airframe",
    [
        {"preset": "level"},
        {"preset": "level", "mount_deg": 90.0},
        {"preset": "hexarotor-tilted-30"},
        {"tilt_max_deg": 10.0, "mount_deg": 70.0},
    ],
)
def test_certificates_of_airframes(airframe: dict, paper: Callable) -> None:
    """The pose that is reported is one that the vehicle takes, and the bound is proved for its axes."""
    scenario = paper(1.0).model_copy(update={"airframe": Airframe(**airframe)})
    solution = solved(scenario)
    certificate = certificate_of(solution)
    assert (certificate.roll_rad, certificate.pitch_rad) == (solution.pose.roll_rad, solution.pose.pitch_rad)
    assert certificate.yaw_rad == solution.pose.yaw_rad
    assert verify(certificate).proved


def test_certificates_of_rates_hold_ratios(paper: Callable) -> None:
    """Value and bound of a rate are written as two to the power of it."""
    stated = paper(1.0)
    scenario = Scenario(
        objective="secrecy-rate",
        airspace=stated.airspace,
        receiver=stated.receiver,
        transmitter=Transmitter(power_w=1.0),
        nodes=tuple(node.model_copy(update={"power_w": None}) for node in stated.nodes),
        eavesdroppers=(Eavesdropper(position_m=(17.0, 15.0, 4.0)),),
    )
    solution = solved(scenario)
    certificate = certificate_of(solution)
    assert np.log2(certificate.value) == pytest.approx(solution.objective.value, abs=1e-12)
    assert np.log2(certificate.upper_bound) == pytest.approx(solution.objective.upper_bound, abs=1e-12)
    assert verify(certificate).proved


def test_no_proof_no_certificate(paper: Callable, random_scene: Callable) -> None:
    """Without a bound, or for a scheme whose axes are no field, there is none, and the reason is told."""
    with pytest.raises(UsageError, match="nothing was proved"):
        certificate_of(solve(paper(1.0), certify=False))
    three = solve(
        random_scene(np.random.default_rng(3), 3, 1), "maximum-gain", gap=0.1, time_limit_s=ENOUGH_S
    )
    with pytest.raises(UsageError, match="maximum-gain has none in this scenario"):
        certificate_of(three)
