"""Numbers that overflow, or are not defined, prove nothing: no file has them, but its numbers lead there."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
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


def poor(scheme: str, root_m: np.ndarray, leaves: Leaves, scenario: Scenario) -> Certificate:
    """Return a certificate that no pose is better than a level one in a corner at the ceiling."""
    position_m, ratios = np.array([13.9, -7.9, 30.0]), family_of(scenario).ratios
    fields = claimed_axes(scenario, scheme, None) or {}
    place, axis = exact(position_m), antenna_axis((0.0, 0.0, 0.0))
    reached = ratios_at(ratios, place, axis, *profiles_of(fields), gains=excess_at(ratios, place))
    value = float(value_of(ratios, reached))
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
        trees=tuple(Tree(axis=name, root_m=root_m, leaves=leaves) for name in fields),
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
