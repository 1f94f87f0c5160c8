"""How much of a pose's value is lost if attitude, position or jammers are not as stated."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from nullpose.errors import checked, require_usage
from nullpose.files import PlainTable
from nullpose.objectives import FloatArray, Quantity
from nullpose.physics import ErrorCase, ratios_under
from nullpose.physics.array import array_ratios_under
from nullpose.physics.pose import Pose
from nullpose.physics.rotation import rotation_about
from nullpose.scenario import Scenario

_KINDS = "attitude", "position", "jammers", "all"
_SAMPLES = 300  # of all errors together
_STARTS = 3, 3, 8, 8  # descents for each kind of error
_TURNS = 2  # of descents; before each, what points have in a ball may be replaced
_PLACES = 40  # of samples that are tried in its place
_ROUNDS = 16
_STEP = 1e-6  # of a difference quotient, in radii
_STEPS = 20  # of random lengths in each ball
_NEWTON = np.array([0.3, 1.0, 3.0])  # times the step to where a slope is expected to vanish
_SETTLED = 1e-4  # gain of a round, in nepers, below which a descent has ended
_FLAT = 1e-2  # cosine between a step and the slope's change, below which nothing is learned from it
_LEAST = 1e-300  # ratio that counts for a node in a null, whose logarithm is finite


@checked
@dataclass(frozen=True, slots=True, kw_only=True)
class ErrorSizes:
    """The largest errors that are tried.

    Args:
        attitude_deg: angle between the actual and the commanded attitude, degrees, about any axis.
        position_m: distance between the actual and the commanded position, metres.
        jammers_m: distance of each jammer from its stated position, along the ground, metres. Under a
            secrecy rate the eavesdroppers are moved.

    Raises:
        UsageError: a size is negative, not finite or too large.
    """

    attitude_deg: float = 1.0
    position_m: float = 1.0
    jammers_m: float = 10.0

    def __post_init__(self) -> None:
        for name, most in (("attitude_deg", 180.0), ("position_m", 1e7), ("jammers_m", 1e7)):
            size = getattr(self, name)
            require_usage(0.0 <= size <= most, f"{name}: given {size!r}; allowed: 0 to {most:g}")


@dataclass(frozen=True, slots=True, kw_only=True)
class Sensitivity:
    """The smallest value found when attitude, position, jammers or all of them are off: an estimate.

    A search found these values, so that the true worst may be lower;
    :func:`nullpose.solver.robust.guarantee` proves a lower bound.

    Args:
        quantity: the quantity of the values.
        sizes: the largest errors.
        nominal: the value without errors: a power ratio, or bits/s/Hz.
        attitude: the smallest value found with an error of the attitude.
        position: with an error of the position.
        jammers: with jammers (or eavesdroppers) elsewhere.
        all: with all of these errors together.
    """

    quantity: Quantity
    sizes: ErrorSizes
    nominal: float
    attitude: float
    position: float
    jammers: float
    all: float

    def loss_db(self, kind: str = "all") -> float:
        """Evaluate the loss of the ratio behind the value, dB; 1 bit/s/Hz of a rate is 3 dB.

        Of a sum of rates it is the mean loss, by weights.

        Args:
            kind: attitude, position, jammers or all.
        """
        before, after = self.nominal, getattr(self, kind)
        if self.quantity.is_rate:
            return float(10.0 * math.log10(2.0) * (before - after) / self.quantity.scale)
        return 0.0 if before == after else self.quantity.in_unit(before) - self.quantity.in_unit(after)

    def to_dict(self) -> PlainTable:
        """Write sizes and values as plain data for JSON; None for minus infinity, and for dB of a rate."""
        sizes = [
            {"deg": self.sizes.attitude_deg},
            {"m": self.sizes.position_m},
            {"m": self.sizes.jammers_m},
            {},
        ]
        values = [getattr(self, kind) for kind in _KINDS]
        has_db = [value > 0.0 and not self.quantity.is_rate for value in values]
        values_db = [self.quantity.in_unit(x) if has else None for x, has in zip(values, has_db, strict=True)]
        return {
            kind: size | {"value": value, "value_db": value_db}
            for kind, size, value, value_db in zip(_KINDS, sizes, values, values_db, strict=True)
        }


@checked
def sensitivity(scenario: Scenario, pose: Pose, sizes: ErrorSizes | None = None) -> Sensitivity:
    """Search the worst value of a pose over errors of attitude, position and jammers.

    The errors are a ball of rotation vectors, a ball of positions and a disc for each jammer. The worst of
    random samples get the worst of many places in one ball after the other, and descend along the slope of
    the logarithm of the smallest ratio. The search is deterministic, and every value is evaluated by the
    physics (paper eq. 2.1).

    Args:
        scenario: nodes, jammers or eavesdroppers, receiver; its airspace and stated errors are not consulted.
        pose: the pose.
        sizes: the largest errors; 1 degree, 1 m and 10 m if left out.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> found = nullpose.sensitivity(scenario, nullpose.solve(scenario).pose)
        >>> round(found.loss_db("attitude"), 2), round(found.loss_db("all"), 2)
        (0.04, 4.13)
    """
    require_usage(
        scenario.objective_record.of_nodes is None,
        "sensitivity: given an objective that is a function in Python; allowed: one that a file can state",
    )
    sizes, quantity = sizes or ErrorSizes(), Quantity.of(scenario)
    worst = [quantity.of_ratio(float(ratio)) for ratio in _Search(scenario, pose, sizes).worst()]
    return Sensitivity(quantity=quantity, sizes=sizes, **dict(zip(("nominal", *_KINDS), worst, strict=True)))


class _Search:
    """Errors as points of a product of unit balls: a rotation vector, an offset, a disc for each jammer."""

    def __init__(self, scenario: Scenario, pose: Pose, sizes: ErrorSizes) -> None:
        self.sizes, self.random = sizes, np.random.default_rng(0)
        self.ratios_under = partial(
            ratios_under, scenario, pose.position_m, pose.orientation(scenario.antenna_record)
        )
        if scenario.array is not None:
            self.ratios_under = partial(array_ratios_under, scenario, pose)
        self.offsets, self.unmoved = f"{scenario.interferer}_offsets_m", ErrorCase.none(scenario)
        sides = [3, 3] + [2] * len(scenario.interferers)
        self.first = np.cumsum([0, *sides[:-1]])  # coordinate of each ball
        self.ball = np.repeat(np.arange(len(sides)), sides)

    def worst(self) -> FloatArray:
        """Search the smallest ratio without errors, then of each kind of error, (5,)."""
        kind, samples = np.minimum(self.ball, 2), self.random.normal(size=(_SAMPLES, len(self.ball)))
        samples /= self._lengths(samples)  # to the borders, and half of them inside
        samples[::2] *= self.random.random((_SAMPLES // 2, len(self.first)))[:, self.ball] ** 0.4
        free = np.array([kind == 0, kind == 1, kind == 2, kind >= 0])
        drawn = np.where(free[:, None], samples, 0.0)
        starts = [
            each[rows[:most]]
            for each, rows, most in zip(drawn, np.argsort(self._logs(drawn), axis=1), _STARTS, strict=True)
        ]
        free, points = np.repeat(free, _STARTS, axis=0), np.concatenate(starts)
        for places in np.split(samples[: _TURNS * _PLACES], _TURNS):
            points, logs = self._descend(self._placed(points, free, np.vstack([points, places])), free)
        lowest = np.minimum.reduceat(logs, np.cumsum([0, *_STARTS[:-1]]))
        nominal = self._logs(np.zeros(len(kind)))
        return np.exp([nominal, *np.minimum(nominal, [*lowest[:3], np.min(lowest)])])

    def _placed(self, points: FloatArray, free: NDArray[np.bool_], samples: FloatArray) -> FloatArray:
        """Replace what points have in one ball after the other by the worst of some places in it, (n, d)."""
        for ball, first in enumerate(self.first):
            row = np.nonzero(free[:, first])[0]
            tried = np.where(self.ball == ball, samples, points[row, None])
            tried[:, 0] = points[row]
            points[row] = _lowest(tried, self._logs(tried))[0]
        return points

    def _descend(self, points: FloatArray, free: NDArray[np.bool_]) -> tuple[FloatArray, FloatArray]:
        """Descend along the slope of the logarithm of the smallest ratio to points, (n, d), and it, (n,)."""
        logs, going = self._logs(points), np.arange(len(points))
        slope = self._slope(points, logs, free)
        # the step -2 g / |g|^2 takes a ratio with the shape of a squared cone to its zero
        metric = 2.0 * np.eye(points.shape[1]) / np.maximum(_LEAST, _dot(slope, slope))[..., None]
        for _ in range(_ROUNDS):
            tried = self._steps(points[going], slope[going], metric[going])
            ends, lowest = _lowest(tried, self._logs(tried))
            moved, better = ends - points[going], lowest < logs[going] - _SETTLED
            points[going], logs[going] = ends, lowest
            going, moved = going[better], moved[better]
            if not len(going):
                break
            before, slope[going] = slope[going], self._slope(points[going], logs[going], free[going])
            metric[going] = _learned(metric[going], moved, slope[going] - before)
        return points, logs

    def _steps(self, points: FloatArray, slope: FloatArray, metric: FloatArray) -> FloatArray:
        """Step from each point in several ways, (n, steps, d); the first is not to step.

        Steps against the slope in each ball, to the border or of random lengths, and quasi-Newton steps.
        """
        lengths = 10.0 ** self.random.uniform(-3.0, 1.0, (len(points), _STEPS, len(self.first)))
        lengths[:, :2] = [[0.0], [1e9]]  # stay, and to the border
        in_balls = slope / np.maximum(_LEAST, self._lengths(slope))
        newton = np.swapaxes(metric @ slope[..., None], 1, 2)
        ends = points[:, None] - np.concatenate(
            [lengths[:, :, self.ball] * in_balls[:, None], _NEWTON[:, None] * newton], axis=1
        )
        return np.asarray(ends / np.maximum(1.0, self._lengths(ends)))  # to the border if beyond

    def _slope(self, points: FloatArray, logs: FloatArray, free: NDArray[np.bool_]) -> FloatArray:
        """Evaluate the slope of the logarithm at each point, zero where nothing is free, (n, d)."""
        slope, (row, column) = np.zeros(points.shape), np.nonzero(free)
        shifted = points[row] + _STEP * np.eye(points.shape[1])[column]
        slope[row, column] = (self._logs(shifted) - logs[row]) / _STEP
        return slope

    def _logs(self, points: FloatArray) -> FloatArray:
        """Evaluate the logarithm of the smallest ratio at every point, (...)."""
        errors: dict[str, FloatArray] = {
            "position_offset_m": self.sizes.position_m * points[..., 3:6],
            "rotation_world": rotation_about(math.radians(self.sizes.attitude_deg) * points[..., :3]),
            self.offsets: self.sizes.jammers_m
            * np.insert(points[..., 6:].reshape(*points.shape[:-1], -1, 2), 2, 0.0, axis=-1),
        }
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # a jammer may be at the drone
            ratios = self.ratios_under(replace(self.unmoved, **errors)).reshape(*points.shape[:-1], -1)
        ratios = np.where(np.isnan(ratios), np.inf, ratios)
        return np.asarray(np.log(np.maximum(_LEAST, np.min(ratios, axis=-1))))

    def _lengths(self, points: FloatArray) -> FloatArray:
        """Measure the part in each ball, at each of its coordinates, (..., d)."""
        return np.asarray(np.sqrt(np.add.reduceat(points * points, self.first, axis=-1))[..., self.ball])


def _lowest(points: FloatArray, logs: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Pick the point of each row with the lowest logarithm, and that."""
    pick = np.arange(len(logs)), np.argmin(logs, axis=1)
    return points[pick], logs[pick]


def _dot(first: FloatArray, second: FloatArray) -> FloatArray:
    """Multiply vectors of each row, (n, 1)."""
    return np.asarray(np.sum(first * second, axis=1, keepdims=True))


def _learned(metric: FloatArray, moved: FloatArray, change: FloatArray) -> FloatArray:
    """Update inverses of second derivatives by how a step changed the slope (BFGS), (n, d, d).

    Source: J. Nocedal and S. Wright, "Numerical Optimization" (2nd ed., Springer, 2006), eq. 6.17.
    """
    curvature, least = _dot(moved, change), _FLAT * np.sqrt(_dot(moved, moved) * _dot(change, change))
    share = np.where(curvature > least, 1.0 / np.maximum(_LEAST, curvature), 0.0)[..., None]
    rest = np.eye(moved.shape[1]) - share * moved[:, :, None] * change[:, None]
    return np.asarray(rest @ metric @ np.swapaxes(rest, 1, 2) + share * moved[:, :, None] * moved[:, None])
