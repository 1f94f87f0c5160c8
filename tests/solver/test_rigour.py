"""How sure a bound is: beside the status, and never lifted in silence."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nullpose import Scenario, SolveError, UsageError, apply_overrides, load, solve
from nullpose.scenario import Array
from nullpose.solver import Rigour, solve_many
from nullpose.solver.certificate_from_proof import verified
from nullpose.solver.rigour import bound_above

ENOUGH_S = 600.0


@pytest.fixture(scope="module")
def paper() -> Scenario:
    """Returns the paper's scene."""
    return load("examples/paper.toml")


def test_a_bound_below_its_value_is_no_bound() -> None:
    """Rounding is evened out; a bound that is lower by more raises, and says whose fault it is."""
    assert bound_above(1.0, 1.0 - 1e-12) == 1.0
    assert bound_above([1.0, 2.0], [3.0, np.inf]).tolist() == [3.0, np.inf]
    with pytest.raises(SolveError, match=r"bound 0\.99\d* is below the value 1\.0 .* fault of nullpose"):
        bound_above([1.0, 1.0], [2.0, 1.0 - 1e-8])


def test_one_dipole_is_verifiable_and_then_verified(paper: Scenario) -> None:
    """A solution with a proof of its own is verifiable; the verifier's word makes it verified."""
    solution = solve(paper, gap=1e-3, time_limit_s=ENOUGH_S)
    assert solution.rigour is Rigour.VERIFIABLE
    checked = verified(solution)
    assert (checked.rigour, checked.to_dict()["rigour"]) == (Rigour.VERIFIED, "verified")
    assert checked.objective.value == solution.objective.value


def test_what_is_not_proved_has_no_rigour(paper: Scenario) -> None:
    """Without a proof there is none to be sure of, or to verify."""
    solution = solve(paper, certify=False)
    assert solution.rigour is Rigour.NONE
    with pytest.raises(UsageError, match="nothing was proved"):
        verified(solution)


def test_a_bound_of_another_case_is_floating_point() -> None:
    """Maximum gain for three nodes has the optimum's bound, and no certificate."""
    field = load("examples/field.toml")
    three = field.model_copy(update={"nodes": field.nodes[:3]})
    solution = solve(three, "maximum-gain", time_limit_s=ENOUGH_S)
    assert solution.rigour is Rigour.FLOATING_POINT
    with pytest.raises(UsageError, match="maximum-gain has none in this scenario"):
        verified(solution)


def test_arrays_and_many_scenes_are_floating_point(paper: Scenario) -> None:
    """What has no certificate says so."""
    level = paper.model_copy(update={"array": Array(elements=2, layout="linear", spacing_wavelengths=0.5)})
    assert solve(level, gap=1e-2).objective.rigour is Rigour.FLOATING_POINT
    assert solve_many([paper], gap=1e-2).rigour is Rigour.FLOATING_POINT
    assert solve_many([paper], certify=False).rigour is Rigour.NONE


def test_a_rejected_certificate_is_told(paper: Scenario) -> None:
    """A bound that the verifier does not accept is floating-point, with the verifier's reason."""
    solution = solve(paper, gap=1e-2, time_limit_s=ENOUGH_S)
    (proof,) = solution.proofs
    doubtful = replace(solution, proofs=(replace(proof, leaves=proof.leaves[:-1]),))
    checked = verified(doubtful)
    assert checked.rigour is Rigour.FLOATING_POINT
    assert "rejected" in checked.reason


def test_strong_jamming_is_verified(paper: Scenario) -> None:
    """From 1e10 to 1e16 times the noise at the keep-out, what is certified is verified."""
    for noise_w in (1e-10, 1e-12, 1e-13, 1e-16):
        quiet = apply_overrides(paper, [f"receiver.noise_w={noise_w}"])
        solution = solve(quiet, time_limit_s=ENOUGH_S)
        assert solution.status == "certified"
        assert verified(solution).rigour is Rigour.VERIFIED, verified(solution).reason


def one_node_secrecy(eavesdropper_m: tuple[float, float, float]) -> Scenario:
    """Returns one node at the origin and one eavesdropper, the drone from 2 m up."""
    return Scenario.from_dict(
        {
            "objective": "secrecy-rate",
            "airspace": {"altitude_m": [2.0, 30.0]},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "transmitter": {"power_w": 1.0},
            "nodes": [{"position_m": [0.0, 0.0, 1.5]}],
            "eavesdroppers": [{"position_m": list(eavesdropper_m), "noise_w": 1e-3}],
        }
    )


@pytest.mark.parametrize("eavesdropper_m", [(17.0, 15.0, 1.5), (3.0, -2.0, 1.5), (0.5, 0.0, 1.5)])
def test_one_node_secrecy_is_verified(eavesdropper_m: tuple[float, float, float]) -> None:
    """Where distances alone close the gap, the root is cut for the bound that is stated."""
    solution = solve(one_node_secrecy(eavesdropper_m), gap=1e-2, time_limit_s=ENOUGH_S)
    assert solution.status == "certified"
    assert verified(solution).rigour is Rigour.VERIFIED


def test_enormous_ratios_are_verified(paper: Scenario) -> None:
    """A bound of about 1e15 is said in a sentence as well."""
    loud = apply_overrides(paper, ["receiver.noise_w=1e-13", "jammers.M.power_w=1e-13"])
    loud = apply_overrides(loud, ["nodes.S1.power_w=1e5", "nodes.S2.power_w=1e5"])
    solution = solve(loud, time_limit_s=ENOUGH_S)
    assert solution.objective.value > 1e14
    assert verified(solution).rigour is Rigour.VERIFIED
