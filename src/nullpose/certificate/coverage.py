"""Whether leaves cover their root: a purely combinatorial question, asked in whole numbers."""

from __future__ import annotations

import numpy as np

from nullpose.certificate.certificate import PROFILE, IntArray, Leaves

_DEPTH = slice(0, 10, 2)


def uncovered(leaves: Leaves) -> str:
    """Return where the leaves fail to cover every position and axis of the root, or an empty string.

    A region is covered if one leaf holds it, or if it can be halved across a direction in which every leaf
    in it is finer, and both halves are covered.

    Args:
        leaves: to be checked; depths and indices in range. Those for an antenna that is the same all round
            hold all axes in any one chart; those of a dipole on three faces.
    """
    face = leaves.cell[:, 0]
    # depth and index along x, y, z and the two sides of a cell, which is whole where there is none
    grid = np.concatenate([leaves.box, np.where(face[:, None] < 0, 0, leaves.cell[:, 1:])], axis=1)
    everything, is_profile = np.arange(len(leaves)), bool(np.all(leaves.test == PROFILE))
    todo: list[tuple[IntArray, tuple[int, ...], int, str]] = [(everything, (0,) * 5, -1, "root")]
    while todo:
        members, depth, on_face, path = todo.pop()
        if not len(members):
            return f"the leaves do not cover the root: nothing covers {path}"
        least = grid[members, _DEPTH].min(axis=0)
        if on_face < 0 and np.all(face[members] >= 0):
            charts = set(face[members].tolist()) if is_profile else {0, 1, 2}
            if not is_profile or len(charts) == 1:
                todo += [(members[face[members] == f], depth, f, f"{path}/face{f}") for f in charts]
                continue
        finer = [i for i in range(5 if on_face >= 0 else 3) if least[i] > depth[i]]
        if not finer:
            as_large = np.all(grid[members, _DEPTH] <= depth, axis=1)
            if not np.any(as_large & ((face[members] < 0) | (on_face >= 0))):
                return f"the leaves do not cover the root: no leaf holds {path}, and no cut parts those in it"
            continue
        side = finer[0]
        bit = grid[members, 2 * side + 1] >> (grid[members, 2 * side] - depth[side] - 1) & 1
        deeper = (*depth[:side], depth[side] + 1, *depth[side + 1 :])
        for half in range(2):
            todo.append((members[bit == half], deeper, on_face, f"{path}/{'xyzab'[side]}{half}"))
    return ""
