"""How much of a pose's value is lost if attitude, position or jammers are not as stated."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from nullpose.errors import UsageError
from nullpose.files import PlainTable
from nullpose.objectives import FloatArray, IntArray, Quantity
from nullpose.physics import ErrorCase, ratios_under
from nullpose.physics.array import array_ratios_under
from nullpose.physics.pose import Pose
from nullpose.physics.rotation import rotation_about
from nullpose.scenario import Scenario

_KINDS = "attitude", "position", "jammers", "all"
_SAMPLES = 64  # of each kind of error, over the whole set
_RINGS = np.outer([0.0, 0.3, 0.6, 1.0, 2.0, 4.0], np.exp(1j * np.arange(12) * np.pi / 6.0)).ravel()
"""Places of a jammer round the point below the drone, in heights of the drone over it."""
_SPIRAL = np.sqrt((np.arange(40) + 0.5) / 40.0) * np.exp(2.4j * np.arange(40))
"""Places over a disc of radius 1, one after the other by the golden angle."""
_ACROSS = np.array([-1.0, -0.5, -0.25, 0.25, 0.5, 1.0])
"""Places across a linear array from a jammer, in radii of its disc."""
_LEVEL_M = 1e-3  # below the drone, in place of a node at its height, whose direction meets no ground
_STARTS = 5  # descents of the worst ratios of each kind, and as many of the worst samples
_ROUNDS = 12
_JAMMED = 4  # errors of the drone for which jammers are moved anew, and ways to move them
_STEP = 1e-6  # of a difference quotient, in radii
_STEPS = np.array([1e9, 0.3, 0.03])  # against the slope in each ball, in radii; the first is to the border
_STEEPEST = np.array([0.3, 0.03, 0.003])  # against the whole slope
_ONWARD = np.array([1.0, 4.0])  # times the last two rounds, which leads along a valley
_SETTLED = 1e-4  # gain of a round, in nepers, below which a descent has ended
_LEAST = 1e-300  # ratio that counts for a node in a null, whose logarithm is finite


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
            if not 0.0 <= size <= most:
                raise UsageError(f"{name}: given {size!r}; allowed: 0 to {most:g}")


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

        Args:
            kind: attitude, position, jammers or all.
        """
        before, after = self.nominal, getattr(self, kind)
        if self.quantity.is_rate:
            return float(10.0 * math.log10(2.0) * (before - after))
        return 0.0 if before == after else self.quantity.in_unit(before) - self.quantity.in_unit(after)

    def to_dict(self) -> PlainTable:
        """Write sizes and values as plain data for JSON; None for minus infinity, and for dB of a rate."""
        unit = {"attitude": "deg", "position": "m", "jammers": "m"}
        kinds = {
            kind: {unit[kind]: size} for kind, size in zip(unit, asdict(self.sizes).values(), strict=True)
        }
        return {kind: size | self._value(kind) for kind, size in (kinds | {"all": {}}).items()}

    def _value(self, kind: str) -> dict[str, float | None]:
        value = getattr(self, kind)
        value_db = -math.inf if self.quantity.is_rate else self.quantity.in_unit(value)
        return {"value": value, "value_db": value_db if math.isfinite(value_db) else None}


def sensitivity(scenario: Scenario, pose: Pose, sizes: ErrorSizes | None = None) -> Sensitivity:
    """Search the worst value of a pose over errors of attitude, position and jammers.

    The errors are a ball of rotation vectors, a ball of positions and a disc for each jammer. Samples of
    these sets come first; the best ones descend along the slope of the logarithm of a ratio. The search is
    deterministic, and every value is evaluated by the physics (paper eq. 2.1).

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
    sizes = ErrorSizes() if sizes is None else sizes
    quantity = Quantity.of(scenario)
    worst = _Search(scenario, pose, sizes).worst()
    values = (quantity.of_ratio(float(ratio)) for ratio in worst)
    names = ("nominal", *_KINDS)
    return Sensitivity(quantity=quantity, sizes=sizes, **dict(zip(names, values, strict=True)))


class _Search:
    """Errors as points of a product of unit balls: a rotation vector, an offset, a disc for each jammer."""

    def __init__(self, scenario: Scenario, pose: Pose, sizes: ErrorSizes) -> None:
        self.sizes = sizes
        orientation = pose.orientation(scenario.antenna_record)
        self.ratios_under = partial(ratios_under, scenario, pose.position_m, orientation)
        if scenario.array is not None:
            self.ratios_under = partial(array_ratios_under, scenario, pose)
        point = scenario.objective_record.interferers.removesuffix("s")
        self.offsets, self.unmoved = f"{point}_offsets_m", ErrorCase.none(scenario)
        self.points_m = getattr(scenario, f"{point}_positions_m").reshape(-1, 3)
        self.away_m = pose.position_m - self.points_m
        self.on_cones_m = _on_cones(scenario, pose, self.away_m, sizes.jammers_m)
        sides = [3, 3] + [2] * len(self.points_m)
        self.first = np.cumsum([0, *sides[:-1]])  # coordinate of each ball
        self.ball = np.repeat(np.arange(len(sides)), sides)
        kind = np.minimum(self.ball, 2)
        self.free = np.array([kind == 0, kind == 1, kind == 2])

    def worst(self) -> FloatArray:
        """Search the smallest ratio without errors, then of each kind of error, (5,)."""
        samples, none = self._samples(), np.zeros((1, len(self.ball)))
        jammed, nominal = self._with_worst_jammers(none, _JAMMED), float(np.min(self._ratios(none)))
        jammed = np.concatenate(
            [jammed, self._with_worst_jammers(jammed)]
        )  # then each among the others moved
        alone = [self._descend(np.concatenate([samples, jammed]) * free, free) for free in self.free]
        attitude, position, jammers = (ends for _, ends in alone)
        # all together: from samples, from the worst places of jammers, and from places found for other poses
        drone = np.concatenate([samples * ~self.free[2], attitude[:1] + position[:1]])
        elsewhere = (jammers[:_JAMMED, None] + drone).reshape(-1, len(self.ball))
        worst = np.argsort(np.min(self._ratios(drone + jammed[:1]), axis=1))[:_JAMMED]
        sets, free = (
            (samples, elsewhere, self._with_worst_jammers(drone[worst])),
            np.ones(len(self.ball), bool),
        )
        together = [self._descend(points, free)[0] for points in sets]
        of_kind = [lowest for lowest, _ in alone]
        return np.array([nominal, *np.minimum(nominal, [*of_kind, min(*of_kind, *together)])])

    def _descend(self, points: FloatArray, free: NDArray[np.bool_]) -> tuple[float, FloatArray]:
        """Descend along the slope of the logarithm of a ratio, from the worst of some points.

        Half of the descents end every second round, those with the largest ratios.

        Args:
            points: (n, d).
            free: (d,) the coordinates that change.

        Returns:
            The lowest ratio, and the ends of the descents, (n, d), the lowest first.
        """
        ratios = self._ratios(points)
        row, ratio = _starts(ratios)
        lowest, points = float(np.min(ratios)), points[row]
        values = np.log(np.maximum(_LEAST, ratios[row, ratio]))
        before, last = points.copy(), points.copy()
        going = np.arange(len(points)) if np.any(free) else np.arange(0)
        for done in range(_ROUNDS):
            if not len(going):
                break
            going = going[np.argsort(values[going])][: max(2, 2 * _STARTS >> done // 2)]
            slope = self._slope(points[going], ratio[going], values[going], free)
            tried = self._steps(points[going], slope, before[going])
            found = self._ratios(tried.reshape(-1, len(self.ball))).reshape(*tried.shape[:2], -1)
            lowest = min(lowest, float(np.min(found)))
            of_ratio = np.take_along_axis(found, ratio[going, None, None], axis=2)[..., 0]
            best = np.argmin(of_ratio, axis=1)
            reached = np.log(np.maximum(_LEAST, _of(of_ratio, best)))
            better = reached < values[going] - _SETTLED
            before[going], last[going] = last[going], points[going]
            points[going[better]], values[going[better]] = _of(tried, best)[better], reached[better]
            going = going[better]
        return lowest, points[np.argsort(values)]

    def _steps(self, points: FloatArray, slope: FloatArray, before: FloatArray) -> FloatArray:
        """Step from each point in several ways, (n, steps, d).

        Steps against the slope g, the step ``-2 g / |g|^2`` that takes a ratio with the shape of a squared
        cone to its zero, and more of the last two rounds.
        """
        length = np.maximum(_LEAST, np.linalg.norm(slope, axis=1, keepdims=True))
        in_balls = slope / np.maximum(_LEAST, self._lengths(slope))
        steps = [_STEPS[:, None] * in_balls[:, None], _STEEPEST[:, None] * (slope / length)[:, None]]
        steps += [(2.0 * slope / length / length)[:, None], _ONWARD[:, None] * (before - points)[:, None]]
        return self._projected(points[:, None] - np.concatenate(steps, axis=1))

    def _slope(
        self, points: FloatArray, ratio: IntArray, values: FloatArray, free: NDArray[np.bool_]
    ) -> FloatArray:
        """Evaluate the slope of a ratio's logarithm at each point, zero where nothing is free, (n, d)."""
        slope = np.zeros(points.shape)
        row, column = np.nonzero(np.broadcast_to(free, points.shape))
        shifted = points[row]
        shifted[np.arange(len(row)), column] += _STEP
        logs = np.log(np.maximum(_LEAST, _of(self._ratios(shifted), ratio[row])))
        slope[row, column] = (logs - values[row]) / _STEP
        return slope

    def _ratios(self, points: FloatArray) -> FloatArray:
        """Evaluate every ratio at every point, (n, r)."""
        offsets_m = np.zeros((len(points), len(self.points_m), 3))
        offsets_m[..., :2] = self.sizes.jammers_m * points[:, 6:].reshape(*offsets_m.shape[:2], 2)
        errors: dict[str, FloatArray] = {
            "position_offset_m": self.sizes.position_m * points[:, 3:6],
            "rotation_world": rotation_about(math.radians(self.sizes.attitude_deg) * points[:, :3]),
            self.offsets: offsets_m,
        }
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # a jammer may be at the drone
            ratios = self.ratios_under(replace(self.unmoved, **errors)).reshape(len(points), -1)
        return np.where(np.isnan(ratios), np.inf, ratios)

    def _samples(self) -> FloatArray:
        """Spread points over all balls, half of them on the borders, (n, d)."""
        random = np.random.default_rng(0)
        samples = random.normal(size=(_SAMPLES, len(self.ball)))
        samples /= self._lengths(samples)
        samples[::2] *= random.random((len(samples[::2]), len(self.first)))[:, self.ball] ** 0.4
        return samples

    def _with_worst_jammers(self, points: FloatArray, most: int = 1) -> FloatArray:
        """Move each jammer alone to the worst of many places in its disc, for every point, (m, d).

        Once for each of the ratios that become smallest, so many at most.

        A jammer's power is largest close to below the drone, so that many of the places are there.
        """
        if not (len(self.points_m) and self.sizes.jammers_m > 0.0):
            return points
        below_m = self.away_m[:, :1] + 1j * self.away_m[:, 1:2]
        seen_m = np.concatenate([np.abs(self.away_m[:, 2:]) * _RINGS, self.on_cones_m], axis=1)
        spread = np.broadcast_to(_SPIRAL, (len(below_m), len(_SPIRAL)))
        places = np.concatenate([(below_m + seen_m) / self.sizes.jammers_m, spread], axis=1)
        tried = np.tile(points[:, None, None], (1, *places.shape, 1))
        for jammer, start in enumerate(self.first[2:]):
            tried[:, jammer, :, start] = places[jammer].real
            tried[:, jammer, :, start + 1] = places[jammer].imag
        tried = self._projected(tried)
        ratios = self._ratios(tried.reshape(-1, len(self.ball))).reshape(*tried.shape[:3], -1)
        ratio = np.argsort(np.min(ratios, axis=(1, 2)), axis=1)[:, :most]
        row = np.repeat(np.arange(len(points)), ratio.shape[1])
        place = np.argmin(ratios[row, ..., ratio.ravel()], axis=2)  # (m, jammers)
        worst = np.take_along_axis(tried[row], place[..., None, None], axis=2)[:, :, 0]
        return np.asarray(points[row] + np.sum(worst - points[row, None], axis=1))

    def _projected(self, points: FloatArray) -> FloatArray:
        """Move the part in each ball to its border if it is beyond."""
        return np.asarray(points / np.maximum(1.0, self._lengths(points)))

    def _lengths(self, points: FloatArray) -> FloatArray:
        """Measure the part in each ball, at each of its coordinates, (..., d)."""
        squares = np.add.reduceat(points * points, self.first, axis=-1)
        return np.asarray(np.sqrt(squares)[..., self.ball])


def _on_cones(scenario: Scenario, pose: Pose, away_m: FloatArray, reach_m: float) -> FloatArray:
    """List places in whose direction a linear array hears a node, east + i north of the drone, (k, places).

    They lie on the cone about the array through the node; the node's own direction is among them, in which
    any array hears it.

    Args:
        scenario: nodes and array.
        pose: of the array.
        away_m: (k, 3) from each jammer to the drone.
        reach_m: how far jammers move.
    """
    if scenario.array is None or not len(away_m):
        return np.zeros((len(away_m), 0), complex)
    heading = np.exp(1j * pose.yaw_rad)
    nodes_m = scenario.node_positions_m - pose.position_m
    nodes = (nodes_m[:, 0] + 1j * nodes_m[:, 1]) / heading
    below_m = np.where(nodes_m[:, 2], nodes_m[:, 2], _LEVEL_M)
    slope = nodes.real / np.hypot(nodes.imag, below_m)
    jammers = -(away_m[:, 0] + 1j * away_m[:, 1]) / heading
    across_m = jammers.imag[:, None] + reach_m * _ACROSS
    towards_m = np.abs(away_m[:, 2:] / below_m) * nodes.imag
    across_m = np.concatenate([across_m, towards_m], axis=1)[:, None]
    places = slope[:, None] * np.hypot(across_m, away_m[:, 2:, None]) + 1j * across_m
    return np.asarray(places.reshape(len(away_m), -1) * heading)


def _starts(ratios: FloatArray) -> IntArray:
    """Choose where to descend from: the worst rows, and the worst row of the worst ratios."""
    rows = np.argsort(np.min(ratios, axis=1))[:_STARTS].tolist()
    pairs = {(row, int(np.argmin(ratios[row]))) for row in rows}
    worst = np.argsort(np.min(ratios, axis=0))[:_STARTS].tolist()
    pairs |= {(int(np.argmin(ratios[:, ratio])), ratio) for ratio in worst}
    return np.array(sorted(pairs)).T


def _of(values: FloatArray, column: IntArray) -> FloatArray:
    """Pick the entry of each row that a column names."""
    return np.asarray(values[np.arange(len(values)), column])
