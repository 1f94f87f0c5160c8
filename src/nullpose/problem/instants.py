"""The family of a scene in motion at several instants: one pose serves all of them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate

import numpy as np

from nullpose.objectives import FloatArray, IntArray, Ratios
from nullpose.problem.family import Family
from nullpose.scenario import Scenario

_INDICES = {  # of which array of another field each counts the rows
    "numerator_point": "points_m",
    "denominator_point": "points_m",
    "denominator_of": "denominator_isotropic",
}
_STARTS = {
    "denominator_start": "denominator_point",
    "shadows_of_point": "shadow_start",
    "shadow_start": "shadow_sides",
}


def still_scenes(scenario: Scenario) -> list[Scenario]:
    """List the still scenes of a scene in motion, one for each of its instants; a still scene alone."""
    return [scenario] if scenario.time is None else [scenario.at(float(t_s)) for t_s in scenario.instants_s]


def join_instants(families: Sequence[Family], chosen: Sequence[int]) -> Family:
    """Join the ratios of some instants, whose smallest is that of a pose held at all of them.

    The points of every instant are kept clear of, whether it is chosen or not.

    Args:
        families: of the scene at every instant, with equally many ratios of which the smallest is maximised.
        chosen: indices of the instants whose ratios count.
    """
    ratios = [families[i].ratios for i in chosen]
    fields = {name: _joined(ratios, name) for name in Ratios._fields if name not in ("leak", "offset")}
    domain, balls = families[0].domain, [family.domain.keep_out_points_m for family in families]
    kept_out_m = np.unique(np.vstack(balls), axis=0)
    return Family(**fields, leak=ratios[0].leak, **domain._replace(keep_out_points_m=kept_out_m)._asdict())


def _joined(ratios: Sequence[Ratios], name: str) -> FloatArray | IntArray:
    """Join an array of the ratios of several instants; what counts rows of another counts on."""
    parts = [getattr(each, name) for each in ratios]
    if (rows := _INDICES.get(name) or _STARTS.get(name)) is None:
        return np.concatenate(parts)
    lengths = [len(getattr(each, rows)) - (rows == "shadow_start") for each in ratios]
    before = accumulate(lengths, initial=0)
    if name in _INDICES:
        return np.concatenate([part + first for part, first in zip(parts, before, strict=False)])
    begins = [part[:-1] + first for part, first in zip(parts, before, strict=False)]
    return np.append(np.concatenate(begins), sum(lengths))
