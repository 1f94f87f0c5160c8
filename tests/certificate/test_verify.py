"""The verifier accepts the solver's certificates of every kind, and says why it rejects others."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.certificate.plain import accepted, certified, rejected, with_leaves, with_tree

from nullpose.certificate import Certificate, verify
from nullpose.certificate.certificate import AFFINE, FAR, KEPT_OUT, TOWARDS
from nullpose.scenario import Scenario, apply_overrides, load

PAPER = Path(__file__).parents[2] / "examples" / "paper.toml"
SCHEMES = ["optimum", "zero-interference", "maximum-gain", "vertical"]


@pytest.mark.parametrize("power_w", [1e-3, 0.1, 1.0, 100.0, 1e6])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_papers_scenario_is_proved(scheme: str, power_w: float) -> None:
    """Every case of the paper, from hardly any jamming to a deafening one."""
    scenario = apply_overrides(load(PAPER), [f"jammers.M.power_w={power_w!r}"])
    certificate = certified(scenario, scheme)
    assert certificate.upper_bound <= certificate.value * 1.0011
    assert "proved: in this scenario no position" in accepted(certificate)


def test_the_default_gap_is_proved() -> None:
    """The paper's optimum to one part in a million."""
    certificate = certified(load(PAPER), gap=1e-6)
    assert certificate.upper_bound <= certificate.value * 1.0000011
    accepted(certificate)


@pytest.mark.parametrize(("nodes", "jammers"), [(5, 1), (5, 2), (8, 1), (8, 3)])
def test_many_nodes_are_proved(nodes: int, jammers: int, random_scene: Callable) -> None:
    """Random scenes where forms may have a duality gap."""
    accepted(certified(random_scene(10 * nodes + jammers, nodes, jammers)))


def test_cells_are_proved(celled: Certificate) -> None:
    """A certificate with cells of axes passes, and needs each of its faces and the sides' multipliers."""
    leaves = celled.trees[0].leaves
    accepted(celled)
    kept = np.delete(np.arange(len(leaves)), int(np.flatnonzero(leaves.face == 2)[-1]))
    assert "face2" in rejected(with_tree(celled, leaves=leaves.chosen(kept)))
    assert "is not excluded" in rejected(with_leaves(celled, sides=1e3 * leaves.sides))


def test_multipliers_of_balls_count(walled: Certificate) -> None:
    """Keep-out balls with a multiplier are proved, and needed: without them the same leaves fail."""
    leaves = walled.trees[0].leaves
    assert np.any(leaves.ball_multiplier > 0.0)
    assert np.any(leaves.test == KEPT_OUT)
    accepted(walled)
    without = with_leaves(walled, ball_multiplier=np.zeros(len(leaves)))
    assert "is not excluded" in rejected(without)
    assert "is not excluded" in rejected(with_leaves(walled, ball=np.full(len(leaves), -1)))


AIRSPACES = [
    {"x_m": (-50.0, 60.0), "y_m": (-20.0, 30.0)},
    {"x_m": (20.0, 60.0), "y_m": (30.0, 90.0), "altitude_m": (12.0, 20.0)},
    {"altitude_m": (8.0, 8.0)},
    {"x_m": (-50.0, 60.0), "y_m": (10.0, 10.0), "altitude_m": (9.0, 9.0)},
    {"x_m": (3.0, 3.0), "y_m": (10.0, 10.0), "altitude_m": (9.0, 9.0)},
    {"altitude_m": (-5.0, 100.0)},
]


# in the last airspace maximum gain has no axis in line with both nodes, and no proof closes there
@pytest.mark.parametrize(
    ("scheme", "airspace"),
    [
        (scheme, one)
        for scheme in SCHEMES
        for one in AIRSPACES
        if (scheme, one) != ("maximum-gain", AIRSPACES[-1])
    ],
)
def test_every_airspace_is_proved(scheme: str, airspace: dict, paper: Callable) -> None:
    """Bounded airspaces, planes, lines, a single position, and one below the ground."""
    accepted(certified(paper(**airspace), scheme, gap=1e-2))


def test_several_jammers_need_a_tree_each(random_scene: Callable) -> None:
    """Zero interference is proved for every jammer, or for the one that was to be nulled."""
    scenario = random_scene(3, 3, 2)
    both = certified(scenario, "zero-interference")
    one = certified(scenario, "zero-interference", null_jammer="M2")
    assert [tree.axis for tree in both.trees] == ["null M1", "null M2"]
    assert [tree.axis for tree in one.trees] == ["null M2"]
    assert "whose null is on a jammer" in accepted(both)
    assert "whose null is on jammer M2" in accepted(one)
    for trees in (both.trees[:1], both.trees[::-1][:1], (), (*both.trees, both.trees[0])):
        assert "needs a tree for each of" in rejected(replace(both, trees=trees))
    assert accepted(replace(both, trees=both.trees[::-1]))
    assert "needs a tree for each of" in rejected(replace(one, null_jammer="M1"))
    assert "has no certificate" in rejected(replace(one, null_jammer="M3"))


def test_a_null_jammer_goes_with_zero_interference_only(paper: Callable) -> None:
    """A proof of the optimum is none of a pose whose null is on a jammer."""
    certificate = certified(paper(), gap=0.1)
    assert "null jammer 'M1' has no certificate" in rejected(replace(certificate, null_jammer="M1"))
    assert "'no such' has no certificate" in rejected(replace(certificate, scheme="no such"))


def test_the_pose_is_checked(paper: Callable) -> None:
    """Each way in which a pose can fail is told."""
    certificate = certified(paper(x_m=(-50.0, 60.0)), "vertical", gap=0.1)
    p = certificate.position_m
    for shift, words in (
        ((0.0, 0.0, -0.1), "z = 7.9"),
        ((0.0, 0.0, 100.0), "outside the airspace"),
        ((200.0, 0.0, 0.0), "x = "),
        ((1e-3, 0.0, 0.0), "smallest SINR is"),
    ):
        assert words in rejected(replace(certificate, position_m=p + np.array(shift)))
    assert "not one that the scheme allows" in rejected(replace(certificate, roll_rad=1e-5))
    assert "beyond 4 rad" in rejected(replace(certificate, yaw_rad=7.0))
    assert "smallest SINR is" in rejected(replace(certificate, value=certificate.value * (1.0 - 1e-9)))
    assert "the bound is below" in rejected(replace(certificate, upper_bound=certificate.value * 0.999))
    assert "positive and finite" in rejected(replace(certificate, value=-1.0))
    accepted(replace(certificate, value=certificate.value * (1.0 - 1e-11)))
    accepted(replace(certificate, yaw_rad=1.234))


def test_a_pose_in_a_keep_out_ball_is_rejected(walled: Certificate) -> None:
    """A pose a centimetre too near to a ground point is not allowed."""
    points = walled.scenario.node_positions_m
    nearest = points[np.argmin(np.linalg.norm(points - walled.position_m, axis=1))]
    way = nearest - walled.position_m
    shift = np.array([*(way[:2] / np.linalg.norm(way[:2])), 0.0]) * (np.linalg.norm(way) - 26.5 + 0.05)
    assert "closer than keep_out_m" in rejected(replace(walled, position_m=walled.position_m + shift))


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ({"level": lambda x: x * 1.01}, "its level is above the bound"),
        ({"level": lambda x: -x}, "its level is not positive"),
        ({"test": lambda x: x + 5}, "its test is unknown"),
        ({"test": lambda x: x * 0 + AFFINE}, "the tree's is free"),
        ({"point": lambda x: x + 100}, "its point does not exist"),
        ({"point": lambda x: x * 0 - 1}, "its point does not exist"),
        ({"mix": lambda x: x + 10**6}, "its multipliers do not exist"),
        ({"mix": lambda x: x * 0 - 1}, "its multipliers do not exist"),
        ({"ball": lambda x: x + 100}, "its keep-out ball or zone does not exist"),
        ({"ball_multiplier": lambda x: -x}, "a multiplier is negative"),
        ({"sides": lambda x: x - 1.0}, "a multiplier is negative"),
        ({"cell": lambda x: x * 0 + np.array([3, 0, 0, 0, 0])}, "its cell does not exist"),
        ({"box": lambda x: x + np.array([51, 0, 0, 0, 0, 0])}, "its depth is out of range"),
        ({"box": lambda x: x - [60, 0, 0, 0, 0, 0]}, "its depth is out of range"),
        ({"box": lambda x: x + np.array([0, 2**40, 0, 0, 0, 0])}, "its index is out of range"),
        ({"box": lambda x: x - [0, 2**40, 0, 0, 0, 0]}, "its index is out of range"),
    ],
)
def test_numbers_out_of_range_are_named(columns: dict, words: str, walled: Certificate) -> None:
    """The first leaf whose numbers cannot be is named with what is wrong."""
    message = rejected(with_leaves(walled, **columns))
    assert words in message
    assert "tree 'free': leaf " in message


@pytest.mark.parametrize("mix", [{}, {0: -0.1, 1: 1.1}, {2: 1.0}, {0: 1.0, 10**30: 1.0}])
def test_multipliers_that_cannot_be_are_named(mix: dict, walled: Certificate) -> None:
    """No ratio, one that is not there, or a negative weight."""
    mixes = (mix, *walled.trees[0].leaves.mixes[1:])
    assert "multipliers 0: " in rejected(with_leaves(walled, mixes=mixes))


def test_huge_numbers_end_in_words(paper: Callable, walled: Certificate) -> None:
    """Numbers near the largest there are overflow into a rejection, not into an exception."""
    size = 1e300
    for certificate in (walled, certified(paper(keep_out_m=26.5), "vertical", gap=0.1)):
        leaves = certificate.trees[0].leaves
        whole = np.full(len(leaves), size)
        if certificate is walled:  # of the other, pieces pass that need no ball
            held = with_leaves(certificate, ball=leaves.ball * 0, ball_multiplier=whole)
            assert "is not excluded" in rejected(held)
        wide = np.array([[-1.0] * 3, [1.0] * 3])
        assert "is too large" in rejected(with_tree(certificate, root_m=wide * size))
        assert "is not excluded" in rejected(with_tree(certificate, root_m=wide * 9e149))
        mixes = tuple(dict.fromkeys(mix, size) for mix in leaves.mixes)
        assert verify(with_leaves(certificate, mixes=mixes)).message
        kept_out = with_leaves(
            certificate, level=whole, test=leaves.test * 0 + KEPT_OUT, point=leaves.point * 0
        )
        assert "leaf 0" in rejected(replace(kept_out, upper_bound=size))


def test_a_root_that_is_too_small_is_rejected(walled: Certificate) -> None:
    """A face moved in leaves out positions; an inverted box holds none."""
    root_m = walled.trees[0].root_m.copy()
    root_m[0, 1] = walled.position_m[1] + 1.0
    assert "the root box ends at y" in rejected(with_tree(walled, root_m=root_m))
    assert "the root box is empty" in rejected(with_tree(walled, root_m=walled.trees[0].root_m[::-1].copy()))


def test_a_failing_leaf_is_placed(walled: Certificate) -> None:
    """The message says which leaf fails, where it is, at what level and by which test."""
    level = walled.trees[0].leaves.level.copy()
    row = int(np.flatnonzero(walled.trees[0].leaves.test <= TOWARDS)[3])
    level[row] *= 0.5
    message = rejected(with_leaves(walled, level=level))
    assert f"leaf {row} (x, y, z: " in message
    assert f"{level[row]:.12g}" in message
    assert "by its test (free axis" in message


def test_leaves_that_fail_by_a_hair_are_cut(walled: Certificate) -> None:
    """Two leaves joined into their parent pass if the parts that the verifier tries by itself do."""
    leaves = walled.trees[0].leaves
    out = (leaves.test == FAR) & (leaves.box[:, 0] > 0)
    accepted(with_leaves(walled, level=leaves.level * np.where(out, 1.0 - 1e-13, 1.0)))


def test_another_scenario_is_not_proved(paper: Callable) -> None:
    """The leaves of one scene do not prove another's bound, even with the pose's value corrected."""
    certificate = certified(paper(1.0), gap=1e-2)
    other: Scenario = paper(0.01)
    assert "smallest SINR" in rejected(replace(certificate, scenario=other))
    weaker = certified(other, gap=1e-2)
    assert rejected(replace(weaker, trees=certificate.trees))
