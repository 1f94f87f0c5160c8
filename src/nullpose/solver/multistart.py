"""The multistart search of a family under an axis field."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from itertools import permutations
from typing import NamedTuple

import numpy as np

from nullpose.errors import SolveError, require
from nullpose.objectives import FloatArray
from nullpose.problem.airspace import loosened
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family
from nullpose.problem.records import Domain
from nullpose.solver.compiling import limit_clock
from nullpose.solver.kernels.compiler.interpreted import ended_when

BORDER_M = 4e-10
"""How far borders are moved where what is allowed is of no width [m]: less than what counts as on them."""
NO_POSITION = (
    "no position was found in what the airspace leaves, which is very small or narrow; widen the airspace or "
    "the gaps between zones, or reduce keep_out_m"
)
"""What is said where no position was met."""
NOT_RECEIVED = (
    "no position was found at which every node is received; widen the airspace or reduce keep_out_m"
)
"""What is said where some were."""
_CLIMBS = (1e-4, 1e-5, 1e-6, 1e-4, 1e-6)
_CLIMB_STEPS = 300
_ALL = 1_000_000  # landmarks
_PAIRED = 4  # interferers whose lines are looked at


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Incumbent:
    """A pose found by a search.

    Args:
        position_m: (3,) metres.
        axis: (3,) antenna axis, of any length.
        log_value: the logarithm of the smallest ratio there, as the search saw it.
        multipliers: (r,) multipliers of the ratios, or of pairs, at the optimum, summing to one; equal where
            not known.
        starts: local searches run.
        evaluations: poses evaluated.
    """

    position_m: FloatArray
    axis: FloatArray
    log_value: float
    multipliers: FloatArray
    starts: int
    evaluations: int


class SearchSettings(NamedTuple):
    """How hard the multistart tries.

    Args:
        coarse: positions judged in each round.
        polished: the best of them that are polished in each round.
        rounds: most rounds.
        patience: rounds without improvement after which it stops.
        landmarks: the best landmarks that are polished before the rounds.
    """

    coarse: int = 96
    polished: int = 24
    rounds: int = 12
    patience: int = 2
    landmarks: int = _ALL


_LIGHT = SearchSettings(coarse=8, polished=1, rounds=1, patience=1, landmarks=2)
_LIGHT_OF_MEAN = SearchSettings(coarse=32, polished=4, rounds=1, patience=1, landmarks=8)
_NO_SEARCH = SearchSettings(coarse=0, polished=0, rounds=-1, patience=0)


def search_settings(proof_follows: bool, field: AxisField, is_mean: bool = False) -> SearchSettings:
    """Return the settings of a search: light if a proof follows, which repairs what the search misses.

    Args:
        proof_follows: whether one does.
        field: the axes; if a position gives the axis, the best place may be a needle over a landmark.
        is_mean: whether a mean is maximised, which has more local maxima.
    """
    if not proof_follows:
        return SearchSettings()
    if is_mean:
        return _LIGHT_OF_MEAN
    return _LIGHT if field.is_free else _LIGHT._replace(landmarks=_ALL)


def landmarks(family: Family, most: int = 16) -> FloatArray:
    """Return positions worth a start of their own, (m, 3), some of which no grid would hit.

    Over the points' centre and over each interferer: the vertical case under strong jamming is a needle
    straight above the jammer, which begins at its keep-out ball. On the line of each two
    interferers, beside their balls: there one axis has its null on both.

    Args:
        family: the ratios and their domain.
        most: points of a kind that are taken at most.
    """
    ratios, floor_m, clear_m = family.ratios, family.domain.low_m[2], 1.02 * family.domain.keep_out_m
    nodes = ratios.points_m[ratios.numerator_point]
    of_pairs = ratios.numerator_point[ratios.pairs[:, 1]]
    numbers = set((of_pairs if len(of_pairs) else ratios.denominator_point).tolist())
    interferers = ratios.points_m[sorted(numbers)[:most]]
    over = np.concatenate([nodes.sum(axis=0, keepdims=True) / len(nodes), interferers, nodes[:most]])
    over[:, 2] = np.maximum(floor_m, over[:, 2] + clear_m)
    over[0, 2] = floor_m
    beside = []
    for first, second in permutations(interferers[:_PAIRED], 2):
        apart_m = np.linalg.norm(second - first)
        if apart_m > 0.0:  # one point may stand for several that see different axes
            direction = (second - first) / apart_m
            beside += [first + clear_m * direction, first - clear_m * direction]
    return np.vstack([over, *beside]) if beside else over


def _corners(domain: Domain, most: int = 1000) -> FloatArray:
    """Return corners of zones and fence on the lowest and the highest altitude, (m, 3)."""
    corners = domain.zone_edges[:: 1 + 2 * len(domain.zone_edges) // most, :2]
    return np.vstack([np.insert(corners, 2, end[2], axis=1) for end in (domain.low_m, domain.high_m)])


@cache
def _shift_of(seed: int) -> FloatArray:
    """Return the offset of the low-discrepancy sequence, (3,), that a seed stands for.

    Args:
        seed: a whole number of at least 0.
    """
    return np.random.default_rng(seed).uniform(size=3)


def multistart(
    family: Family,
    axis_field: AxisField,
    *,
    seed: int,
    settings: SearchSettings | None = None,
    deadline: float = math.inf,
    near: FloatArray | None = None,
) -> Incumbent:
    """Return the best pose that a multistart finds: coarse positions, the promising ones polished.

    Deterministic for a given seed, unless Python runs it at the deadline: then the quickest search is made.
    Not a proof: see :class:`nullpose.solver.Status`.

    Args:
        family: the ratios and their domain.
        axis_field: which axes are allowed.
        seed: start of the low-discrepancy sequence.
        settings: how hard to try.
        deadline: on ``limit_clock``.
        near: (m, 3) positions close to which the best may be, metres.

    Raises:
        SolveError: no position of the domain gave every ratio a positive value.
    """
    with ended_when(lambda: limit_clock() > deadline):
        return _multistart(family, axis_field, seed, settings or SearchSettings(), near)
    return _multistart(family, axis_field, seed, _LIGHT, near)


def _multistart(
    family: Family, axis_field: AxisField, seed: int, settings: SearchSettings, near: FloatArray | None
) -> Incumbent:
    places = landmarks(family) if near is None else np.vstack([near, landmarks(family)])
    found = _run(family, axis_field, places, seed, settings)
    if not math.isfinite(found.log_value):  # what is allowed may be of no width: a point, a line or a wall
        places = np.vstack([places, _corners(family.domain)])
        found = _run(loosened(family, BORDER_M), axis_field, places, seed, settings)
        reason = NOT_RECEIVED if found.evaluations else NO_POSITION
        require(SolveError, math.isfinite(found.log_value), reason)
    return found


def climb(
    family: Family,
    axis_field: AxisField,
    position_m: FloatArray,
    axis: FloatArray,
    *,
    mu: float = _CLIMBS[0],
    steps: int = _CLIMB_STEPS,
) -> Incumbent:
    """Return the local maximum that a pose leads to.

    Args:
        family: the ratios and their domain.
        axis_field: which axes are allowed.
        position_m: (3,) metres, in the domain.
        axis: (3,) unit axis.
        mu: first barrier weight, in units of the log ratio.
        steps: most steps.
    """
    return _run(
        family, axis_field, np.empty((0, 3)), 0, _NO_SEARCH, (mu,), steps, (position_m.copy(), axis.copy())
    )


def _run(
    family: Family,
    axis_field: AxisField,
    places: FloatArray,
    seed: int,
    settings: SearchSettings,
    climbs: tuple[float, ...] = _CLIMBS,
    steps: int = _CLIMB_STEPS,
    pose: tuple[FloatArray, FloatArray] | None = None,
) -> Incumbent:
    from nullpose.solver.kernels.compiler.jit import entry_of
    from nullpose.solver.kernels.search.search import search_and_climb

    position_m, axis = pose or (np.zeros(3), np.array([0.0, 0.0, 1.0]))
    ratios = family.ratios
    multipliers = np.empty(len(ratios.pairs) or len(ratios.numerator_point))
    log_value, starts, evaluations = entry_of(search_and_climb)(
        ratios,
        family.domain,
        axis_field.arrays,
        places,
        _shift_of(seed),
        settings,
        np.array(climbs),
        steps,
        position_m,
        axis,
        multipliers,
    )
    return Incumbent(
        position_m=position_m,
        axis=axis,
        log_value=log_value,
        multipliers=multipliers,
        starts=starts,
        evaluations=evaluations,
    )
