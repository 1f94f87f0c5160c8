"""From a proof's rows to leaves: dyadic boxes, cells and multipliers as the verifier takes them."""

from types import SimpleNamespace

import numpy as np

from nullpose import load
from nullpose.certificate.certificate import FAR, WORLD
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.solver.certificate_from_proof import leaves_of
from nullpose.solver.kernels.bounds import node

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
