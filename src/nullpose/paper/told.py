"""What measures of claims share: how they tell a level, and how equidistant poses are."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from nullpose.paper.study import JammingStudy
from nullpose.report.geometry import distance_m
from nullpose.schemes import Scheme
from nullpose.study import SweepRow

__all__ = ["NOISE", "PRINTED", "RATIO", "Measured", "apart_m", "told"]

RATIO = "jamming_to_transmission_ratio"
"""Name of P_M/P in evidence."""

PRINTED = Scheme.MAXIMUM_GAIN_PRINTED

NOISE = 1e-9
"""In dB and in metres; what is smaller is rounding, and is told as at most this."""

Measured = dict[str, Any]
"""Verdict, finding, evidence and what is proved, as fields of a claim."""


def told(level: float | None) -> str:
    """Return a level in words.

    Args:
        level: P_M/P; None for none.
    """
    return "no swept level" if level is None else f"P_M/P = {level:.3g}"


def apart_m(study: JammingStudy, rows: Iterable[SweepRow]) -> float:
    """Return by how much the distances to the two nodes differ at most, metres.

    Args:
        study: with the nodes.
        rows: the poses.
    """
    first_m, second_m = study.scenario.node_positions_m
    return max(abs(distance_m(row.pose, first_m) - distance_m(row.pose, second_m)) for row in rows)
