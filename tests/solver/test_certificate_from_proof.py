"""From a proof to a certificate: dyadic boxes, cells and multipliers as the verifier takes them."""

from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest

from nullpose import load
from nullpose.certificate import verify
from nullpose.certificate.certificate import FAR, WORLD
from nullpose.errors import UsageError
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.scenario import Airframe, Eavesdropper, Scenario, Transmitter
from nullpose.solver import Result, solve
from nullpose.solver.certificate_from_proof import certificate_of, leaves_of
from nullpose.solver.kernels.bounds import node

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


FAMILY = build_family(load("examples/paper.toml"))


def proof_of(
    rows: np.ndarray, low: tuple = (-8.0, 0.0, 8.0), high: tuple = (8.0, 32.0, 30.0)
) -> SimpleNamespace:
    """Return what stands for a proof: a root and rows."""
    return SimpleNamespace(leaves=rows, root=np.array([low, high]))


def row_of(box: tuple[int, ...], proof: SimpleNamespace, **columns: float) -> np.ndarray:
    """Return a row whose box is a dyadic part of a proof's root."""
    row = np.zeros(node.COLUMNS)
    side = (proof.root[1] - proof.root[0]) / 2.0 ** np.array(box[::2])
    row[node.HALF : node.HALF + 3] = 0.5 * side
    row[node.CENTRE : node.CENTRE + 3] = proof.root[0] + side * (np.array(box[1::2]) + 0.5)
    row[node.LEVEL], row[node.FACE], row[node.BALL] = 1.0, -1.0, -1.0
    row[node.KIND], row[node.COUNT], row[node.WEIGHT] = WORLD, 1.0, 1.0
    for name, value in columns.items():
        row[getattr(node, name)] = value
    return row


def test_boxes_become_dyadic() -> None:
    """Depth and index are found back from centres and half sides, at any depth."""
    rng = np.random.default_rng(1)
    proof = proof_of(np.empty(0))
    boxes = []
    for _ in range(200):
        depth = rng.integers(0, 31, 3)
        index = [int(rng.integers(1 << int(d))) for d in depth]
        boxes.append(tuple(int(x) for pair in zip(depth, index, strict=True) for x in pair))
    proof.leaves = np.array([row_of(box, proof) for box in boxes])
    assert leaves_of(proof, AxisField.free(), FAMILY).box.tolist() == [list(box) for box in boxes]


def test_cells_become_dyadic() -> None:
    """Face, depth and index of a cell's sides are found back; without a cell they are -1 and 0."""
    proof = proof_of(np.empty(0))
    rows, cells = [row_of((0,) * 6, proof)], [[-1, 0, 0, 0, 0]]
    rng = np.random.default_rng(2)
    for _ in range(50):
        face, *depth = int(rng.integers(3)), int(rng.integers(12)), int(rng.integers(12))
        index = [int(rng.integers(1 << d)) for d in depth]
        row = row_of((0,) * 6, proof, FACE=face)
        for side in range(2):
            width = 2.0 ** -depth[side] * 2.0
            row[node.CELL + 2 * side] = -1.0 + width * index[side]
            row[node.CELL + 2 * side + 1] = -1.0 + width * (index[side] + 1)
        rows.append(row)
        cells.append([face, depth[0], index[0], depth[1], index[1]])
    proof.leaves = np.array(rows)
    assert leaves_of(proof, AxisField.free(), FAMILY).cell.tolist() == cells


def test_equal_mixes_are_shared() -> None:
    """Rows with the same multipliers point to one mix; those of distance tests to none."""
    proof = proof_of(np.empty(0))
    rows = [row_of((0,) * 6, proof) for _ in range(4)]
    rows[1][node.COUNT], rows[1][node.INDEX + 1], rows[1][node.WEIGHT] = 2.0, 3.0, 0.25
    rows[1][node.WEIGHT + 1] = 0.75
    rows[3][node.KIND], rows[3][node.ANCHOR] = FAR, 2.0
    proof.leaves = np.array(rows)
    leaves = leaves_of(proof, AxisField.free(), FAMILY)
    assert leaves.mix.tolist() == [0, 1, 0, -1]
    assert leaves.mixes == ({0: 1.0}, {0: 0.25, 3: 0.75})
    assert leaves.point.tolist() == [-1, -1, -1, 2]
