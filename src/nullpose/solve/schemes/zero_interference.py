"""Zero interference (paper eqs. 3.1 and 3.2): the null always on a jammer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from nullpose.errors import UsageError
from nullpose.family import AxisField, build_family
from nullpose.scenario import Scenario
from nullpose.solve.found import Found
from nullpose.solve.multistart import multistart

__all__ = ["axis_field", "find"]


def axis_field(jammer_position_m: ArrayLike) -> AxisField:
    """Return the field ``u(p) = p_M - p`` (paper eq. 3.1, its length left out).

    Args:
        jammer_position_m: (3,) metres.
    """
    return AxisField.affine(jammer_position_m, -np.eye(3))


def find(scenario: Scenario, *, seed: int, null_jammer: str | None = None) -> Found:
    """Return the best position found with the null on one jammer.

    Args:
        scenario: what to solve; at least one jammer.
        seed: seed of the multistart.
        null_jammer: name of the jammer to null; without it each is tried and the best kept.

    Raises:
        UsageError: no jammer has that name.
    """
    names = scenario.jammer_names
    if null_jammer is not None and null_jammer not in names:
        raise UsageError(f"null jammer: given {null_jammer!r}; the scenario's jammers are {', '.join(names)}")
    family = build_family(scenario)
    tried = [
        (name, multistart(family, axis_field(position_m), seed=seed))
        for name, position_m in zip(names, scenario.jammer_positions_m, strict=True)
        if null_jammer in (None, name)
    ]
    name, best = max(tried, key=lambda entry: entry[1].log_value)
    note = f"null on jammer {name}"
    if len(tried) > 1:
        note += f", the best of {len(tried)}"
    return replace(
        best,
        starts=sum(found.starts for _, found in tried),
        evaluations=sum(found.evaluations for _, found in tried),
        note=note,
    )
