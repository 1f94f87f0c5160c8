"""Whether leaves cover their root: a purely combinatorial question, asked in whole numbers."""

from __future__ import annotations

import numpy as np

from nullpose.certificate.certificate import IntArray, Leaves

__all__ = ["uncovered"]

_DEPTH, _INDEX = slice(0, 10, 2), slice(1, 10, 2)


def uncovered(leaves: Leaves) -> str:
    """Return where the leaves fail to cover every position and axis of the root, or an empty string.

    A region is covered if one leaf holds it, or if it can be halved across a direction in which every leaf
    in it is finer, and both halves are covered.

    Args:
        leaves: to be checked; depths and indices in range.
    """
    # depth and index along x, y, z and the two sides of a cell
    grid = np.concatenate([leaves.box, leaves.cell[:, 1:]], axis=1)
    face = leaves.cell[:, 0]
    everything = np.arange(len(leaves))
    todo: list[tuple[IntArray, tuple[int, ...], int, str]] = [(everything, (0,) * 5, -1, "root")]
    while todo:
        members, depth, on_face, path = todo.pop()
        if not len(members):
            return f"nothing covers {path}"
        least = grid[members, _DEPTH].min(axis=0)
        if on_face < 0 and np.all(face[members] >= 0):
            todo += [(members[face[members] == f], depth, f, f"{path}/face{f}") for f in range(3)]
            continue
        finer = [i for i in range(5 if on_face >= 0 else 3) if least[i] > depth[i]]
        if not finer:
            if not holds(grid[members], face[members], depth, on_face):
                return f"no leaf holds {path}, and no cut separates those in it"
            continue
        side = finer[0]
        bit = grid[members, 2 * side + 1] >> (grid[members, 2 * side] - depth[side] - 1) & 1
        deeper = (*depth[:side], depth[side] + 1, *depth[side + 1 :])
        for half in range(2):
            todo.append((members[bit == half], deeper, on_face, f"{path}/{'xyzab'[side]}{half}"))
    return ""


def holds(grid: IntArray, face: IntArray, depth: tuple[int, ...], on_face: int) -> bool:
    """Return whether one of the leaves is at least as large as the region that they share a path to."""
    coarse = np.all(grid[:, _DEPTH][:, :3] <= np.array(depth[:3]), axis=1)
    every_axis = face < 0
    if on_face >= 0:
        every_axis |= np.all(grid[:, _DEPTH][:, 3:] <= np.array(depth[3:]), axis=1)
    return bool(np.any(coarse & every_axis))
