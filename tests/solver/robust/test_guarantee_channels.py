"""What a pose guarantees in a channel: no error gives less, whatever the channel of each point."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.spatial.transform import Rotation
from sizes import chosen, few_examples

from nullpose.errors import UsageError
from nullpose.physics import ErrorCase, ratios_under
from nullpose.scenario import Scenario, apply_overrides, load
from nullpose.solver import solve
from nullpose.solver.robust import guarantee
from nullpose.solver.robust.guarantee import Inner

SIGHT = {"model": "elevation", "environment": "urban", "average": "power"}
CHANNELS = {
    "power law": {"model": "power-law", "exponent": 3.0},
    "weak power law": {"model": "power-law", "exponent": 1.7},
    "power": SIGHT,
    "db": SIGHT | {"environment": "suburban", "average": "db"},
    "guaranteed": SIGHT | {"average": "guaranteed"},
    "power of exponent 2.6": SIGHT | {"exponent": 2.6},
    "db of exponent 1.7": SIGHT | {"environment": "suburban", "average": "db", "exponent": 1.7},
}
STILL = ("power", "db", "power of exponent 2.6", "db of exponent 1.7")
"""Channels in which the drone's position is known."""


def least_ratios(scene: Scenario, position: np.ndarray, errors: tuple[np.ndarray, ...]) -> np.ndarray:
    """Returns the smallest of every ratio under errors, by the plain physics."""
    axes, offsets, moved = errors
    kind = "eavesdropper" if scene.objective == "secrecy-rate" else "jammer"
    none = ErrorCase.none(scene)
    case = replace(none, position_offset_m=offsets, **{f"{kind}_offsets_m": moved})
    return np.asarray(np.min(ratios_under(scene, position, axes, case).reshape(len(axes), -1), axis=0))


def erring_scene(
    rng: np.random.Generator, channel: str, random_scene: Callable, erring: Callable
) -> Scenario:
    """Returns two nodes and two jammers in a channel, the second jammer with one of its own."""
    plain = random_scene(rng, 2, 2, 50.0, altitude_m=(30.0, 40.0))
    extent = float(rng.choice([0.0, 1.0, 4.0]))
    position_m = 0.0 if channel in STILL else float(rng.choice([0.0, 0.3]))
    scene = erring(plain, attitude_deg=float(rng.choice([0.0, 3.0])), position_m=position_m, extent_m=extent)
    jammers = scene.to_dict()["jammers"]
    jammers[1] |= {"channel": str(rng.choice(["free-space", "high-rise"]))}
    if jammers[1]["channel"] == "high-rise":
        jammers[1]["channel"] = CHANNELS["power law"]
    return Scenario(**(scene.to_dict() | {"channel": CHANNELS[channel], "jammers": jammers}))


@pytest.mark.parametrize("channel", CHANNELS)
@few_examples(2)
@given(seed=st.integers(0, 2**32 - 1))
def test_no_random_error_breaks_it(
    channel: str, seed: int, random_scene: Callable, erring: Callable, draw_errors: Callable
) -> None:
    """Of thousands of random errors none takes any ratio below its bound, which is near the worst found."""
    rng = np.random.default_rng(seed)
    scene = erring_scene(rng, channel, random_scene, erring)
    p, u = rng.uniform([0.0, 0.0, 15.0], [100.0, 100.0, 40.0]), rng.normal(size=3)
    if seed % 2:
        u = scene.jammer_positions_m[0] - p
    held = guarantee(scene, p, u, accuracy=3e-2)
    least = least_ratios(scene, p, draw_errors(rng, scene, held.axis, 20_000))
    lower, worst = (np.array([getattr(each, of) for each in held.ratios]) for of in ("lower", "worst"))
    assert np.all(lower <= least * (1.0 + 1e-12))
    assert np.all(lower <= worst)
    assert np.all(worst <= least * 1.01)


@pytest.mark.parametrize("channel", chosen(CHANNELS, [0, 2]))
def test_eavesdroppers_and_no_errors(
    channel: str, random_scene: Callable, erring: Callable, listened: Callable, draw_errors: Callable
) -> None:
    """A secret ratio is guaranteed too, and without errors what is guaranteed is the nominal value."""
    rng = np.random.default_rng(7)
    plain = listened(random_scene(rng, 2, 2, altitude_m=(30.0, 40.0)))
    plain = Scenario(**(plain.to_dict() | {"channel": CHANNELS[channel]}))
    scene = erring(plain, attitude_deg=2.0, extent_m=3.0)
    p, u = np.array([40.0, 50.0, 25.0]), rng.normal(size=3)
    held = guarantee(scene, p, u, accuracy=1e-2)
    least = least_ratios(scene, p, draw_errors(rng, scene, held.axis, 20_000))
    assert np.all(np.array([each.lower for each in held.ratios]) <= least)
    assert held.lower >= 0.98 * held.worst
    certain = guarantee(plain, p, u)
    assert certain.lower == pytest.approx(certain.nominal, rel=1e-8)


def test_exponent_of_two_is_free_space(strong: Scenario) -> None:
    """The power law of free space guarantees what free space does."""
    law = apply_overrides(strong, ["channel={model='power-law', exponent=2.0}"])
    pose = [-13.5, 20.7, 8.0], [30.5, -5.7, -4.0]
    assert guarantee(law, *pose).lower == guarantee(strong, *pose).lower


@pytest.mark.parametrize("channel", ["power law", "power"])
def test_bound_is_above_every_pose(channel: str, strong: Scenario, draw_errors: Callable) -> None:
    """The pose found guarantees no more than the bound, and no random pose near it is above that."""
    scene = Scenario(**(strong.to_dict() | {"channel": CHANNELS[channel]}))
    gain_db = 14.0 if channel == "power law" else 6.0
    scene = apply_overrides(scene, [f"receiver.reference_gain_db={gain_db}"])
    result = solve(scene, robust=True, gap=0.2, time_limit_s=30.0)
    held, bound = result.details.robust, result.objective.upper_bound
    assert bound is not None
    assert held.guaranteed <= held.worst <= bound * (1.0 + 1e-9)
    assert held.guaranteed >= result.details.nominal.guaranteed * (1.0 - 1e-9)
    rng = np.random.default_rng(3)
    for _ in range(60):
        p = np.maximum(held.pose.position_m + rng.normal(size=3), [-np.inf, -np.inf, 8.0])
        u = held.pose.antenna_axis + 0.05 * rng.normal(size=3)
        u /= np.linalg.norm(u)
        assert np.min(least_ratios(scene, p, draw_errors(rng, scene, u, 2000))) <= bound * 1.01


@pytest.mark.parametrize(
    ("example", "changes", "named"),
    [
        ("town", ["receiver.attitude_error_deg=1"], "remove \\[\\[buildings\\]\\]"),
        ("urban", ["receiver.position_error_m=1"], "receiver.position_error_m"),
    ],
)
def test_refused_in_words(example: str, changes: list[str], named: str) -> None:
    """Buildings, and sight by elevation with an error of the position, are refused, with what to do."""
    with pytest.raises(UsageError, match=named):
        solve(apply_overrides(load(f"examples/{example}.toml"), changes), robust=True)


POSE = (np.array([5.0, 20.0, 12.0]), np.array([0.6, 0.0, 0.8]))


def test_one_error_at_a_time_is_the_textbook_case(paper: Callable, erring: Callable) -> None:
    """Without jammers, an attitude error takes the axis straight towards the node: sin^2(gamma - alpha)."""
    scene = erring(paper(1.0), attitude_deg=10.0, jammers=[])
    p, u = POSE
    for k, one in enumerate(Inner(scene).worst(p, u, 1e-4)):
        r = scene.node_positions_m[k] - p
        distance = float(np.linalg.norm(r))
        gamma = math.acos(abs(float(r @ u)) / distance)
        expected = math.sin(gamma - math.radians(10.0)) ** 2 / distance**2 / scene.receiver.noise_power_w
        assert one.worst == pytest.approx(expected, rel=1e-9)
        assert one.lower == pytest.approx(expected, rel=1.1e-4)
        assert one.case.rotation_rad == pytest.approx(math.radians(10.0), rel=1e-9)


def test_every_case_is_for_its_ratio(paper: Callable, erring: Callable, listened: Callable) -> None:
    """Cases move only what their ratio depends on, and name it as the family does."""
    plain = paper(1.0).to_dict()
    plain["jammers"] += [{"name": "M2", "position_m": [40.0, 30.0, 2.0], "power_w": 1.0}]
    scene = erring(listened(type(paper(1.0))(**plain)), extent_m=2.0)
    found = Inner(scene).worst(*POSE)
    pairs = [("S1", "E0"), ("S1", "E1"), ("S2", "E0"), ("S2", "E1")]
    assert [(one.node, one.eavesdropper) for one in found] == pairs
    assert [one.binding.ratio for one in found] == [0, 1, 2, 3]
    for one in found:
        moved = np.linalg.norm(one.case.eavesdropper_offsets_m, axis=1)
        own = scene.eavesdropper_names.index(one.eavesdropper)
        assert moved[own] == pytest.approx(2.0, rel=1e-9)
        assert moved[1 - own] == 0.0
        np.testing.assert_array_equal(one.case.rotation_world, np.eye(3))
        np.testing.assert_array_equal(one.case.position_offset_m, np.zeros(3))


def test_the_sign_of_the_axis_is_irrelevant(strong: object) -> None:
    """An axis and its opposite are one antenna under errors too, and the rotation is the same small one."""
    inner = Inner(strong)  # type: ignore[arg-type]
    p, u = POSE
    for one, other in zip(inner.worst(p, u, 1e-3), inner.worst(p, -u, 1e-3), strict=True):
        assert other.worst == pytest.approx(one.worst, rel=1e-9)
        for case in (one.case, other.case):
            assert Rotation.from_matrix(case.rotation_world).magnitude() <= math.radians(2.0) * (1.0 + 1e-9)
