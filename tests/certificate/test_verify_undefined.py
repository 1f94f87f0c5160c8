"""Numbers that overflow, or are not defined, prove nothing: no file has them, but its numbers lead there."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from sizes import and_slow
from tests.certificate.plain import boxes_at, make_leaves, rejected

from nullpose.certificate import Certificate, Leaves, Tree, claimed_axes
from nullpose.certificate.certificate import AFFINE, FAR, KEPT_OUT, OFF_BAND, PROFILE, TOWARDS, WORLD
from nullpose.certificate.channels import excess_at
from nullpose.certificate.plain_tests import borders, kept_out
from nullpose.certificate.pose_value import antenna_axis, exact, ratios_at, value_of
from nullpose.certificate.profile import profiles_of
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.scenario import Scenario

NODES = [{"position_m": [x, 0.0, 0.0], "power_w": 1.0} for x in (0.0, 9.0)]
BASE: dict[str, Any] = {
    "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
    "nodes": NODES,
    "jammers": [{"name": "M", "position_m": [4.0, 3.0, 1.0], "power_w": 1.0}],
}
SQUARE = {"x_m": [-5.0, 15.0], "y_m": [-10.0, 10.0], "altitude_m": [8.0, 30.0]}
BELOW = {"altitude_m": [0.0, 20.0]}
OVER_ALL: dict[str, dict[str, Any]] = {
    "cylinder": {"no_fly": [{"centre_m": [0.0, 0.0], "radius_m": 90.0} | BELOW]},
    "polygon": {"no_fly": [{"polygon_m": [[-90.0, -90.0], [90.0, -90.0], [0.0, 90.0]]} | BELOW]},
    "box": {"no_fly": [{"x_m": [-90.0, 90.0], "y_m": [-90.0, 90.0]} | BELOW]},
    "fence": {"geofence_m": [[-4.0, -8.0], [14.0, -8.0], [5.0, 9.0]]},
    "ball": {"keep_out_m": 19.0},
}
LAWS = [
    {},
    {"channel": {"model": "power-law", "exponent": 3.0}},
    {"channel": {"model": "power-law", "exponent": 1.7}},
    {"channel": {"model": "elevation", "environment": "suburban", "average": "power"}},
]
WHIPS = {"nodes": [node | {"antenna": "dipole"} for node in NODES]}
Scenery = dict[str, Any]
KINDS: dict[str, tuple[str, list[int], list[Scenery]]] = {
    "free": ("optimum", [WORLD, TOWARDS, FAR, KEPT_OUT], [*LAWS, {"antenna": {"null_depth_db": 25.0}}]),
    "band": ("optimum", [WORLD, TOWARDS, OFF_BAND, KEPT_OUT], [{"airframe": {"tilt_max_deg": 20.0}}]),
    "given": ("vertical", [WORLD, TOWARDS, AFFINE, FAR, KEPT_OUT], [*LAWS, WHIPS]),
    "dipoles": ("optimum", [WORLD, TOWARDS, KEPT_OUT], [WHIPS, WHIPS | LAWS[1], WHIPS | LAWS[3]]),
    "mean": ("optimum", [WORLD, TOWARDS, FAR, KEPT_OUT], [{"objective": "sum-rate"}]),
    "profile": ("optimum", [PROFILE], [{"antenna": {"kind": "half-wave"}}]),
}
"""Scheme, tests and scenes of certificates."""


def family_of(scenario: Scenario) -> Family:
    """Return the ratios and the domain of a scenario of any kind."""
    return build_family(scenario, any_antenna=True, any_channel=True, any_objective=True)


def level_value(scheme: str, scenario: Scenario, position_m: np.ndarray) -> float:
    """Return what is maximised at a level pose."""
    ratios, fields = family_of(scenario).ratios, claimed_axes(scenario, scheme, None) or {}
    place, axis = exact(position_m), antenna_axis((0.0, 0.0, 0.0))
    reached = ratios_at(ratios, place, axis, *profiles_of(fields), gains=excess_at(ratios, place))
    return float(value_of(ratios, reached))


def poor(scheme: str, root_m: np.ndarray, leaves: Leaves, scenario: Scenario) -> Certificate:
    """Return a certificate that no pose is better than a level one in a corner at the ceiling."""
    position_m = np.array([13.9, -7.9, 30.0])
    value = level_value(scheme, scenario, position_m)
    leaves = replace(leaves, level=np.full(len(leaves), value))
    return Certificate(
        scenario=scenario,
        scheme=scheme,
        null_jammer=None,
        value=value,
        upper_bound=value,
        position_m=position_m,
        roll_rad=0.0,
        pitch_rad=0.0,
        yaw_rad=0.0,
        trees=tuple(
            Tree(axis=name, root_m=root_m, leaves=leaves)
            for name in claimed_axes(scenario, scheme, None) or {}
        ),
    )


@pytest.mark.parametrize("size", [1e308, 1e154])
@pytest.mark.parametrize("over", list(OVER_ALL))
@pytest.mark.parametrize(
    ("kind", "test"), [("free", KEPT_OUT), ("free", WORLD), ("given", AFFINE), ("profile", PROFILE)]
)
def test_heights_that_overflow_are_below_no_ceiling(kind: str, test: int, over: str, size: float) -> None:
    """A leaf from far below the ground to far above the sky is in no zone, though its middle is no number."""
    scheme, _, sceneries = KINDS[kind]
    root_m = np.array([[-5.0, -10.0, -size], [15.0, 10.0, size]])
    for scenery in sceneries:
        scenario = Scenario.from_dict(BASE | scenery | {"airspace": SQUARE | OVER_ALL[over]})
        for border in range(borders(family_of(scenario))):
            point, cell = border if test == KEPT_OUT else -1, [0 if test == PROFILE else -1, 0, 0, 0, 0]
            leaves = make_leaves(1, test=test, point=point, cell=cell, ball=border)
            assert "root" in rejected(poor(scheme, root_m, leaves, scenario))


@pytest.mark.parametrize("size", [np.nan, np.inf, 1e308])
@pytest.mark.parametrize("over", list(OVER_ALL))
def test_boxes_of_undefined_numbers_are_kept_out_nowhere(over: str, size: float) -> None:
    """Whatever is not known of a box, the drone may be there."""
    family = family_of(Scenario.from_dict(BASE | {"airspace": SQUARE | OVER_ALL[over]}))
    count = 3 * borders(family)
    side, border = np.divmod(np.arange(count), borders(family))
    centre, half = np.tile([5.0, 0.0, 9.0], (count, 1)), np.full((count, 3), 0.1)
    half[np.arange(count), side] = size
    undefined = np.where(np.isfinite(half), centre, half)
    with np.errstate(all="ignore"):
        for middle in (centre, undefined):
            assert not np.any(kept_out(family, border, boxes_at(middle, half)))


ENDS = [1e308, 1.7e308, 1e155, 1e154, 9.99e149, 1e100, 1e9, 30.0, 1.0, 1e-9, 1e-155, 1e-308, 5e-324, 0.0]


def random_root(rng: np.random.Generator) -> np.ndarray:
    """Return a root with sides of any size, each about the airspace's or far larger or smaller."""
    low, high = np.array([-5.0, -10.0, 8.0]), np.array([15.0, 10.0, 30.0])
    ends = rng.choice(ENDS, (2, 3))
    ends = np.where(rng.uniform(size=3) < 0.5, ends, ends[0])
    around = np.where(rng.uniform(size=3) < 0.7, ends * [[-1.0], [1.0]], np.sort(ends, axis=0))
    return np.where(rng.uniform(size=3) < 0.5, [low, high], around)


def random_leaves(rng: np.random.Generator, family: Family, tests: list[int], mixes: int) -> Leaves:
    """Return leaves that cover a root, some tiny, with random tests, zones and multipliers."""
    boxes, chain = [[0] * 6], int(rng.choice([0, 0, 1, 3, 49]))
    side = int(rng.integers(3))
    for _ in range(chain):  # the last one is halved again and again
        box = boxes.pop(int(rng.integers(len(boxes))) if chain < 49 else -1)
        half = [list(box), list(box)]
        for i in range(2):
            half[i][2 * side : 2 * side + 2] = [box[2 * side] + 1, 2 * box[2 * side + 1] + i]
        boxes += half if rng.uniform() < 0.5 else half[::-1]
        side = side if chain == 49 else int(rng.integers(3))
    count, size = len(boxes), 10.0 ** rng.choice([-320.0, -155.0, -3.0, 0.0, 3.0, 155.0, 308.0], 3)
    test = rng.choice(tests, count)
    weights = rng.choice([0.0, 5e-324, 1e-155, 1.0, 1.0, 1e155, 1.7e308], (3, mixes))
    is_profile = tests == [PROFILE]
    return make_leaves(
        count,
        box=boxes,
        cell=np.where(is_profile, [0, 0, 0, 0, 0], [-1, 0, 0, 0, 0]),
        test=test,
        point=np.where(test == KEPT_OUT, rng.integers(borders(family)), rng.integers(-is_profile, 2)),
        mix=rng.integers(3, size=count),
        mixes=tuple(dict(enumerate(row.tolist())) for row in weights),
        ball=rng.integers(-1, borders(family), count),
        ball_multiplier=size[0],
        band=rng.choice([0.0, 1.0, -1.0]) * size[1],
        sides=size[2],
    )


def fuzz(kind: str, seed: int) -> None:
    """Check that a random certificate of a bound that poses exceed is rejected, whatever its numbers."""
    rng = np.random.default_rng([seed, list(KINDS).index(kind)])
    scheme, tests, sceneries = KINDS[kind]
    over = OVER_ALL[str(rng.choice(list(OVER_ALL)))]
    scenario = Scenario.from_dict(
        BASE | sceneries[int(rng.integers(len(sceneries)))] | {"airspace": SQUARE | over}
    )
    family = family_of(scenario)
    some = [int(test) for test in rng.permutation(tests)[: int(rng.integers(1, len(tests) + 1))]]
    leaves = random_leaves(rng, family, some, len(family.ratios.numerator_point))
    with np.errstate(all="ignore"):
        rejected(poor(scheme, random_root(rng), leaves, scenario))


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "profile"])
@pytest.mark.parametrize("count", and_slow([25], [2000]))
def test_random_numbers_prove_no_falsehood(kind: str, count: int) -> None:
    """Roots, depths and multipliers from the least number to the largest, over zones of every kind."""
    for seed in range(count):
        fuzz(kind, seed)


@pytest.mark.parametrize("kind", KINDS)
def test_the_bound_is_false(kind: str) -> None:
    """Some pose that is allowed exceeds what these certificates claim."""
    scheme, _, sceneries = KINDS[kind]
    for scenery in sceneries:
        for over in OVER_ALL.values():
            scenario = Scenario.from_dict(BASE | scenery | {"airspace": SQUARE | over})
            here, there = ([13.9, -7.9, 30.0], [13.9, -7.9, 21.0])
            claimed, more = (level_value(scheme, scenario, np.array(at)) for at in (here, there))
            assert more > claimed * 1.001
