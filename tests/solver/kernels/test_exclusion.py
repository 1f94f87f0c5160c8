"""What the branch and bound excludes: no pose of an excluded box, cell and band reaches the level.

Thousands of small boxes: the best of many poses drawn and improved in a box is a level that must not be
excluded, with whatever multipliers; levels above it show that the test is not an idle one.
"""

from collections import Counter
from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from sizes import and_slow, diagonal

from nullpose.problem.airspace import airspace_zones
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family
from nullpose.scenario import Airspace
from nullpose.solver.kernels.bounds.branch import branch
from nullpose.solver.kernels.bounds.node import (
    AFFINE,
    BALL,
    BAND,
    CELL,
    CENTRE,
    COLUMNS,
    COUNT,
    FACE,
    FAR,
    HALF,
    INDEX,
    KIND,
    LEVEL,
    NU,
    OFF_BAND,
    SIDE,
    WEIGHT,
)
from nullpose.solver.kernels.bounds.records import Goal

JUST_BELOW = 1.0 - 1e-9


@dataclass(frozen=True, kw_only=True)
class Case:
    """A family with its airspace, an axis field, and a node: a box, perhaps with a cell of axes.

    Args:
        family: ratios and domain.
        airspace: what the domain was made of.
        field: the axes.
        row: the node.
        near: an axis of field and cell.
    """

    family: Family
    airspace: Airspace
    field: AxisField
    row: np.ndarray
    near: np.ndarray

    def is_excluded(self, level: float) -> bool:
        """Returns whether the node is excluded at a level; its row keeps kind and multipliers."""
        problem = self.family.ratios, self.family.domain, self.field.arrays
        goal, (stack, leaves) = Goal(np.inf, np.zeros(COLUMNS), 0.0), np.empty((2, 16, COLUMNS))
        stack[0], axis = self.row, np.empty(3)
        _, top, filled, boxes, _ = branch(*problem, level, goal, stack, 1, leaves, 0, 1, axis, axis)
        assert boxes == 1
        assert (filled > 0) == (top == 0)
        examined = leaves[0] if filled else stack[top - 1]  # or a part of it
        self.row[LEVEL:FACE], self.row[SIDE:] = examined[LEVEL:FACE], examined[SIDE:]
        return bool(filled)

    def values(self, positions: np.ndarray, axes: np.ndarray) -> np.ndarray:
        """Returns the smallest ratio at poses, (n, 3) and (n, 3); minus infinity where one is not allowed."""
        family = self.family
        seen = axes[:, None]
        if len(family.ratios.turn):
            seen = np.einsum("jab,nb->nja", family.ratios.turn, axes)
        r = family.ratios.points_m - positions[:, None]
        links = np.sum(np.cross(seen, r) ** 2, axis=-1) / np.sum(r**2, axis=-1) ** 2
        entries = family.ratios.denominator_weight * links[:, family.ratios.denominator_point]
        spans = zip(family.ratios.denominator_start[:-1], family.ratios.denominator_start[1:], strict=True)
        jamming = np.stack([np.sum(entries[:, a:b], axis=1) for a, b in spans], axis=1)
        below = (family.ratios.denominator_isotropic + jamming)[:, family.ratios.denominator_of]
        above = (
            family.ratios.numerator_isotropic
            + family.ratios.numerator_weight * links[:, family.ratios.numerator_point]
        )
        ratios = above / below
        allowed = self.airspace.clearance_m(positions) >= 0.0
        away = np.linalg.norm(family.domain.keep_out_points_m - positions[:, None], axis=-1)
        allowed &= np.min(away, axis=1, initial=np.inf) >= family.domain.keep_out_m
        allowed &= self.holds(axes)
        return np.where(allowed, ratios.min(axis=1), -np.inf)

    def holds(self, axes: np.ndarray) -> np.ndarray:
        """Returns which unit axes lie in the node's cell."""
        face = int(self.row[FACE])
        if face < 0:
            return np.ones(len(axes), dtype=bool)
        with np.errstate(divide="ignore", invalid="ignore"):
            scaled = axes / axes[:, face, None]
        inside = np.ones(len(axes), dtype=bool)
        for side in range(2):
            low, high = self.row[CELL + 2 * side : CELL + 2 * side + 2]
            coordinate = scaled[:, (face + 1 + side) % 3]
            inside &= (coordinate >= low) & (coordinate <= high)
        return inside

    def axes(self, wanted: np.ndarray, positions: np.ndarray) -> np.ndarray:
        """Returns the axes of the field nearest to some, (n, 3), at positions."""
        if not self.field.is_free:
            wanted = self.field.offset + positions @ self.field.matrix.T
            return wanted / np.linalg.norm(wanted, axis=1, keepdims=True)
        unit = wanted / np.linalg.norm(wanted, axis=1, keepdims=True)
        height = np.sqrt(np.clip(unit[:, 2] ** 2, *self.field.band))
        across = unit[:, :2] / np.linalg.norm(unit[:, :2], axis=1, keepdims=True)
        level = np.sqrt(1.0 - height**2)[:, None] * across
        return np.column_stack([level, np.copysign(height, unit[:, 2])])

    def best(self, rng: np.random.Generator) -> float:
        """Returns the best value that poses drawn in the node come to, and changes of the best of them."""
        centre, half = self.row[CENTRE:HALF], self.row[HALF:LEVEL]
        p = centre + half * rng.uniform(-1.0, 1.0, (600, 3))
        p[::3] = np.where(rng.uniform(size=(200, 3)) < 0.5, p[::3], centre + half * np.sign(p[::3] - centre))
        wild = rng.normal(size=(600, 3))
        u = np.where(rng.uniform(size=(600, 1)) < 0.4, wild, self.near)
        u = self.axes(u + 10.0 ** rng.uniform(-4.0, 0.0, (600, 1)) * rng.normal(size=(600, 3)), p)
        values = self.values(p, u)
        size = 1.0
        for _ in range(12):
            lead = np.argsort(-values)[:40]
            p, u, values = p[lead], u[lead], values[lead]
            size *= 0.5
            new_p = np.repeat(p, 5, axis=0) + size * half * rng.normal(size=(len(p) * 5, 3))
            new_p = np.clip(new_p, centre - half, centre + half)
            steps = 0.3 * size * 10.0 ** rng.uniform(-3.0, 0.0, (len(new_p), 1))
            new_u = self.axes(np.repeat(u, 5, axis=0) + steps * rng.normal(size=(len(new_p), 3)), new_p)
            p, u = np.vstack([p, new_p]), np.vstack([u, new_u])
            values = np.concatenate([values, self.values(new_p, new_u)])
        return float(values.max())


def some_family(rng: np.random.Generator, kind: str) -> dict:
    """Returns the ratios: with one denominator, with several as rates have, or with turned axes besides."""
    ratios = int(rng.choice([1, 1, 2, 3, 4, 5]))
    groups = 1 if kind == "shared" or (kind == "turned" and rng.uniform() < 0.3) else int(rng.integers(2, 4))
    each = int(rng.integers(0 if groups == 1 else 1, 3))
    points = ratios + groups * each
    arrays = {
        "points_m": rng.uniform([0.0, 0.0, 0.0], [60.0, 60.0, 5.0], (points, 3)),
        "numerator_isotropic": np.zeros(ratios) if kind == "shared" else np.ones(ratios),
        "numerator_weight": 10.0 ** rng.uniform(2.0, 4.0, ratios),
        "numerator_point": np.arange(ratios),
        "denominator_of": rng.integers(0, groups, ratios),
        "denominator_isotropic": np.ones(groups),
        "denominator_start": each * np.arange(groups + 1),
        "denominator_point": ratios + np.arange(groups * each),
        "denominator_weight": 10.0 ** rng.uniform(1.0, 5.0, groups * each),
    }
    if kind == "turned":
        angles = 10.0 ** rng.uniform(-2.0, 0.3)
        arrays["turn"] = Rotation.from_rotvec(angles * rng.normal(size=(points, 3))).as_matrix()
    return arrays


def some_airspace(rng: np.random.Generator, border: str) -> Airspace:
    """Returns an airspace with a zone or fence, or with neither."""
    angles = 2.0 * np.pi * (np.arange(6) + rng.uniform(0.1, 0.9, 6)) / 6.0
    around = rng.uniform(5.0, 25.0, (6, 1)) * np.column_stack([np.cos(angles), np.sin(angles)])
    star = [tuple(corner) for corner in (rng.uniform(20.0, 40.0, 2) + around).tolist()]
    if border == "fence":
        return Airspace(altitude_m=(8.0, 30.0), geofence_m=star)
    if border == "zone":
        zone: dict = {"polygon_m": star}
        if rng.uniform() < 0.4:
            zone = {"centre_m": star[0], "radius_m": rng.uniform(3.0, 15.0)}
        if rng.uniform() < 0.4:
            zone["altitude_m"] = (0.0, rng.uniform(9.0, 28.0))
        return Airspace(altitude_m=(8.0, 30.0), no_fly=(zone,))
    return Airspace(altitude_m=(8.0, 30.0))


def some_field(rng: np.random.Generator, kind: str, family: Family) -> AxisField:
    """Returns an axis field of a kind."""
    if kind == "free":
        return AxisField.free()
    if kind == "band":
        low = rng.choice([0.0, rng.uniform(0.0, 0.9)])
        return AxisField.within(low, rng.choice([1.0, low + (1.0 - low) * 10.0 ** rng.uniform(-3.0, -0.1)]))
    if kind == "cone":
        return AxisField.within(*[rng.choice([0.5, 1e-4, 10.0 ** rng.uniform(-6.0, -0.01)])] * 2)
    if kind == "level":
        return AxisField.within(0.0, 0.0)
    if kind == "vertical":
        return AxisField.vertical()
    if kind == "towards":
        disturbers_m = family.ratios.points_m[family.ratios.denominator_point]
        return AxisField.towards(disturbers_m[0] if len(disturbers_m) else [30.0, 30.0, 1.0])
    return AxisField.broadside([3.0, 5.0, 0.0], [40.0, 20.0, 3.0])


def some_case(rng: np.random.Generator, *, family: str, field: str, border: str, celled: bool) -> Case:
    """Returns a random case: a box of 1 mm to 5 m, near a border if there is one."""
    arrays = some_family(rng, family)
    airspace = some_airspace(rng, border)
    zones = airspace_zones(airspace)
    balls_m = arrays["points_m"][:2] + np.array([0.0, 0.0, 9.0]) if border == "ball" else np.zeros((0, 3))
    whole = Family(
        **arrays,
        low_m=airspace.lower_m,
        high_m=airspace.upper_m,
        keep_out_points_m=balls_m,
        keep_out_m=4.0,
        **zones,
    )
    axes = some_field(rng, field, whole)
    row = np.zeros(COLUMNS)
    row[HALF:LEVEL] = 10.0 ** rng.uniform(-3.0, 0.7) * rng.uniform(0.2, 1.0, 3)
    centres = rng.uniform([0.0, 0.0, 8.0], [60.0, 60.0, 30.0], (1 if border == "none" else 30, 3))
    clear = np.min([airspace.clearance_m(centres), np.full(len(centres), 99.0)], axis=0)
    if border == "ball":
        clear = np.min(np.linalg.norm(balls_m - centres[:, None], axis=-1), axis=1) - 4.0
    row[CENTRE:HALF] = centres[np.argmin(np.abs(clear))]
    row[FACE], row[BALL] = -1.0, -1.0
    case = Case(family=whole, airspace=airspace, field=axes, row=row, near=np.array([1.0, 0.0, 0.0]))
    near = case.axes(rng.normal(size=(1, 3)), row[None, CENTRE:HALF])[0]
    if celled and axes.is_free:
        face = int(np.argmax(np.abs(near)))
        row[FACE] = face
        for side in range(2):
            width = 2.0 ** -rng.integers(0, 9)
            at = near[(face + 1 + side) % 3] / near[face]
            low = np.floor((at + 1.0) / (2.0 * width)) * 2.0 * width - 1.0
            level_face = field == "level" and (face + 1 + side) % 3 == 2
            row[CELL + 2 * side : CELL + 2 * side + 2] = (
                (-1.0, 1.0) if level_face else (low, min(1.0, low + 2.0 * width))
            )
    return replace(case, near=near)


def shuffle_multipliers(case: Case, rng: np.random.Generator) -> None:
    """Puts random multipliers into a case's row, of any size."""
    row, ratios = case.row, len(case.family.ratios.numerator_point)
    used = int(rng.integers(1, ratios + 1))
    row[COUNT], row[NU] = used, 0.0
    row[INDEX : INDEX + used] = rng.permutation(ratios)[:used]
    row[WEIGHT : WEIGHT + used] = rng.dirichlet(np.ones(used))
    row[SIDE : SIDE + 2] = row[LEVEL] * 10.0 ** rng.uniform(-3.0, 2.0, 2) * (rng.uniform(size=2) < 0.7)
    row[BAND] = row[LEVEL] * 10.0 ** rng.uniform(-3.0, 2.0) * rng.integers(-1, 2)


def check(case: Case, rng: np.random.Generator) -> tuple[bool, int]:
    """Checks that the best pose met in a node is not excluded; returns whether a level above it is, and how.

    The level just below the best is asked for with the multipliers that were found for the one above, and
    with random ones.
    """
    best = case.best(rng)
    if not best > 0.0:  # no allowed position was met
        return False, -1
    assert not case.is_excluded(best * JUST_BELOW)
    above = case.is_excluded(best * (1.0 + 10.0 ** rng.uniform(-2.0, 0.0)))
    kind = int(case.row[KIND])
    assert not case.is_excluded(best * JUST_BELOW)
    case.is_excluded(best * (1.0 + 10.0 ** rng.uniform(-7.0, -3.0)))
    assert not case.is_excluded(best * JUST_BELOW)
    for _ in range(2):
        shuffle_multipliers(case, rng)
        assert not case.is_excluded(best * JUST_BELOW)
    return above, kind


FREE = ["free", "band", "cone", "level"]
AFFINE_FIELDS = ["vertical", "towards", "broadside"]


@pytest.mark.parametrize(("cases", "share", "by_sum"), and_slow([(24, 0.5, 0.25)], [(64, 0.6, 0.4)]))
@pytest.mark.parametrize(
    ("family", "border"), diagonal(["shared", "groups", "turned"], ["none", "ball", "zone", "fence"])
)
def test_the_best_pose_of_a_box_is_not_excluded(
    family: str, border: str, cases: int, share: float, by_sum: float
) -> None:
    """Whatever the axes, the cell, the denominators, the turns and the borders; and much is excluded."""
    rng = np.random.default_rng([["shared", "groups", "turned"].index(family), len(border), ord(border[0])])
    for fields in (FREE, AFFINE_FIELDS):
        met, excluded = 0, Counter[int]()
        for number in range(cases):
            case = some_case(
                rng, family=family, field=fields[number % len(fields)], border=border, celled=number % 8 > 3
            )
            is_excluded, kind = check(case, rng)
            met += kind >= 0
            excluded[kind] += is_excluded
        assert met >= 0.375 * cases
        assert excluded.total() >= share * met
        if fields is AFFINE_FIELDS:
            assert excluded[AFFINE] >= share * met
        else:
            assert excluded.total() - excluded[FAR] - excluded[OFF_BAND] >= by_sum * met
