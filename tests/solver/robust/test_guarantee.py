"""What a pose guarantees: a bound that no error breaks, close to the worst that errors do."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation
from sizes import and_slow, chosen, diagonal, few_examples

from nullpose.errors import UsageError
from nullpose.physics import ErrorCase, objective_value, ratios_under
from nullpose.scenario import Scenario
from nullpose.solver.robust import guarantee

SEEDS = st.integers(0, 2**32 - 1)
NULL_ON_JAMMER = (np.array([-13.5, 20.7, 8.0]), np.array([30.5, -5.7, -4.0]))

KINDS = {
    "attitude and ball": {"attitude_deg": 2.0, "extent_m": 3.0},
    "position": {"position_m": 0.5},
    "all three": {"attitude_deg": 2.0, "position_m": 0.5, "extent_m": 3.0},
    "wide ball": {"attitude_deg": 5.0, "extent_m": 6.0},
    "ball and position": {"position_m": 1.0, "extent_m": 3.0},
    "large turns": {"attitude_deg": 50.0, "extent_m": 1.0},
}


def place_above(rng: np.random.Generator) -> np.ndarray:
    """Returns a position high enough for any set of the tests."""
    return np.asarray(rng.uniform([0.0, 0.0, 15.0], [100.0, 100.0, 40.0]))


@pytest.fixture
def scene_of(random_scene: Callable, erring: Callable, listened: Callable) -> Callable[..., Scenario]:
    """Returns a builder: three nodes and two jammers or eavesdroppers with errors of a kind."""

    def build(rng: np.random.Generator, kind: str, *, secret: bool) -> Scenario:
        plain = random_scene(rng, 3, 2, 50.0, altitude_m=(30.0, 40.0))
        return erring(listened(plain) if secret else plain, **KINDS[kind])

    return build


@pytest.mark.parametrize(("kind", "secret"), diagonal([*KINDS], [False, True]))
def test_no_random_error_breaks_it(
    kind: str, secret: bool, scene_of: Callable, draw_errors: Callable, ratios_at: Callable
) -> None:
    """Of 30,000 random errors at each of some poses none takes any ratio below its bound."""
    rng = np.random.default_rng(len(kind))
    for _ in range(3):
        scene = scene_of(rng, kind, secret=secret)
        p, u = place_above(rng), rng.normal(size=3)
        held = guarantee(scene, p, u, accuracy=1e-2)
        errors = draw_errors(rng, scene, held.axis, 30_000)
        least = np.min(ratios_at(scene, p, errors), axis=0)
        lower, worst = (np.array([getattr(one, of) for one in held.ratios]) for of in ("lower", "worst"))
        assert np.all(least >= lower)
        assert np.all(least >= worst * (1.0 - 1e-6))  # nor, in fact, below the worst found


@few_examples(8)
@given(seed=SEEDS)
def test_no_random_error_breaks_it_anywhere(
    seed: int, random_scene: Callable, erring: Callable, draw_errors: Callable, ratios_at: Callable
) -> None:
    """Whatever the scene, the sizes of the errors and the pose, the bound holds and is as close as asked."""
    rng = np.random.default_rng(seed)
    scene = erring(
        random_scene(
            rng, 2, int(rng.integers(0, 4)), 10.0 ** rng.uniform(-1.0, 3.0), altitude_m=(40.0, 50.0)
        ),
        attitude_deg=float(rng.choice([0.0, 0.1, 3.0, 20.0, 80.0])),
        position_m=float(rng.choice([0.0, 0.01, 1.0])),
        extent_m=float(rng.choice([0.0, 0.1, 8.0])),
    )
    p, u = place_above(rng), rng.normal(size=3)
    if seed % 2 and scene.jammers:
        u = scene.jammer_positions_m[0] - p
    accuracy = float(rng.choice([1e-2, 1e-3]))
    held = guarantee(scene, p, u, accuracy=accuracy)
    least = np.min(ratios_at(scene, p, draw_errors(rng, scene, held.axis, 2000)), axis=0)
    for one, smallest in zip(held.ratios, least, strict=True):
        assert one.worst * (1.0 - accuracy) * (1.0 - 1e-9) <= one.lower <= one.worst
        assert one.lower <= smallest * (1.0 + 1e-12)
        assert one.worst <= one.nominal * (1.0 + 1e-9)


@pytest.mark.parametrize("kind", and_slow(["all three"], ["attitude and ball", "ball and position"]))
def test_a_local_search_over_errors_ends_at_it(kind: str, scene_of: Callable, ratios_at: Callable) -> None:
    """A general solver over all errors together never gets below the bound, and gets within 1 % of it."""
    rng = np.random.default_rng(11)
    scene = scene_of(rng, kind, secret=False)
    p, u = place_above(rng), rng.normal(size=3)
    held = guarantee(scene, p, u)
    frame = np.linalg.svd(held.axis[None])[2]
    cone, reach = math.radians(scene.receiver.attitude_error_deg), scene.receiver.position_error_m
    sets_m = scene.jammer_uncertainty_m

    def errors_of(x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        blocks = x.reshape(-1, 3)
        blocks = blocks / np.maximum(1.0, np.linalg.norm(blocks, axis=1, keepdims=True))
        lean = cone * blocks[0, :2]
        angle = float(np.linalg.norm(lean))
        way = lean / angle if angle > 0.0 else lean
        axis = math.cos(angle) * held.axis + math.sin(angle) * (way @ frame[1:])
        return axis[None], reach * blocks[1][None], (sets_m[:, None] * blocks[2:])[None]

    for k, one in enumerate(held.ratios):
        found = math.inf
        for _ in range(20):
            start = rng.normal(size=3 * (2 + len(sets_m)))
            search = minimize(
                lambda x, k=k: float(ratios_at(scene, p, errors_of(x))[0, k]), start, method="BFGS"
            )
            found = min(found, float(search.fun))
        assert one.lower <= found * (1.0 + 1e-12)
        assert found <= one.lower * 1.01


def test_without_errors_it_is_the_nominal_value(random_scene: Callable, listened: Callable) -> None:
    """Where nothing is uncertain the bound, the worst case and the nominal value are one number."""
    rng = np.random.default_rng(5)
    for scene in (plain := random_scene(rng, 3, 2), listened(plain)):
        p, u = place_above(rng), rng.normal(size=3)
        held = guarantee(scene, p, u)
        assert held.worst == held.nominal
        assert held.lower == pytest.approx(held.nominal, rel=1e-8)
        assert held.lower <= held.nominal
        value = math.log2(max(1.0, held.nominal)) if scene.eavesdroppers else held.nominal
        assert value == pytest.approx(float(objective_value(scene, p, held.axis)), rel=1e-9, abs=1e-12)
        assert held.case.is_same(ErrorCase.none(scene))


@pytest.mark.parametrize("which", chosen(["attitude_deg", "position_m", "extent_m"], [0, 2]))
def test_larger_errors_guarantee_less(which: str, random_scene: Callable, erring: Callable) -> None:
    """As one error grows the guaranteed value falls, and tends to the value without that error."""
    rng = np.random.default_rng(3)
    plain = random_scene(rng, 3, 2, 20.0, altitude_m=(40.0, 50.0))
    p, u = place_above(rng), rng.normal(size=3)
    sizes = {"attitude_deg": 1.0, "position_m": 0.2, "extent_m": 1.0}
    held = [
        guarantee(erring(plain, **(sizes | {which: size * sizes[which]})), p, u, accuracy=1e-4)
        for size in (0.0, 1e-6, 0.5, 1.0, 2.0, 4.0, 8.0)
    ]
    worst = np.array([[one.worst for one in each.ratios] for each in held])
    assert np.all(worst[1:] <= worst[:-1] * (1.0 + 1e-7))
    np.testing.assert_allclose(worst[1], worst[0], rtol=1e-5)
    assert np.all(worst[-1] < 0.999 * worst[0])


@few_examples(5)
@given(seed=SEEDS)
def test_turning_the_scene_changes_nothing(seed: int, random_scene: Callable, erring: Callable) -> None:
    """Rotating and shifting everything, balls included, leaves what is guaranteed as it was."""
    rng = np.random.default_rng(seed)
    plain = random_scene(rng, 2, 2, 20.0, altitude_m=(-1e4, 1e4), keep_out_m=0.1).to_dict()
    turn = Rotation.from_quat(rng.normal(size=4))
    shift = rng.uniform(-50.0, 50.0, 3)
    p, u = place_above(rng), rng.normal(size=3)

    def scene(turn: Rotation, shift: np.ndarray) -> tuple[Scenario, np.ndarray, np.ndarray]:
        """Returns the scene and the pose, moved; the airspace, which is not consulted, is far above."""
        moved = dict(plain)
        for kind in ("nodes", "jammers"):
            moved[kind] = [
                one | {"position_m": (turn.apply(one["position_m"]) + shift).tolist()} for one in plain[kind]
            ]
        for each in moved["jammers"]:
            each["uncertainty_m"] = 4.0
        moved["airspace"] = {"altitude_m": [1000.0, 1001.0]}
        moved["receiver"] = plain["receiver"] | {"attitude_error_deg": 3.0, "position_error_m": 0.3}
        return Scenario(**moved), turn.apply(p) + shift, turn.apply(u)

    before = guarantee(*scene(Rotation.identity(), np.zeros(3)))
    after = guarantee(*scene(turn, shift))
    assert after.nominal == pytest.approx(before.nominal, rel=1e-9)
    assert after.worst == pytest.approx(before.worst, rel=1e-6)
    assert after.lower == pytest.approx(before.lower, rel=4e-3)


def test_the_case_is_allowed_and_as_bad_as_told(scene_of: Callable) -> None:
    """The worst case found lies within the errors that the scene allows, and gives the value told."""
    rng = np.random.default_rng(17)
    for kind in KINDS:
        scene = scene_of(rng, kind, secret=False)
        p = place_above(rng)
        held = guarantee(scene, p, rng.normal(size=3))
        for k, one in enumerate(held.ratios):
            case = one.case
            assert case.rotation_rad <= math.radians(scene.receiver.attitude_error_deg) * (1.0 + 1e-9)
            assert np.linalg.norm(case.position_offset_m) <= scene.receiver.position_error_m * (1.0 + 1e-9)
            away_m = np.linalg.norm(case.jammer_offsets_m, axis=1)
            assert np.all(away_m <= scene.jammer_uncertainty_m * (1.0 + 1e-9))
            assert one.worst == pytest.approx(float(ratios_under(scene, p, held.axis, case)[k, 0]), rel=1e-13)
        assert held.worst == pytest.approx(float(objective_value(scene, p, held.axis, held.case)), rel=1e-13)
        assert held.binding.node == held.ratios[np.argmin([one.worst for one in held.ratios])].node


def test_a_null_within_reach_guarantees_nothing(paper: Callable, erring: Callable) -> None:
    """Where an allowed error points the null at a node, its guaranteed SINR is zero, and so told."""
    p = np.array([0.0, 0.0, 20.0])
    turned = erring(paper(1.0), attitude_deg=30.0)
    held = guarantee(turned, p, [math.sin(0.4), 0.0, math.cos(0.4)])
    assert (held.lower, held.worst, held.binding.node) == (0.0, 0.0, "S1")
    moved = erring(paper(1.0), position_m=2.0)
    held = guarantee(moved, p, [math.sin(0.09), 0.0, math.cos(0.09)])
    assert (held.lower, held.worst) == (0.0, 0.0)
    assert float(objective_value(moved, p, held.axis, held.case)) <= 1e-25
    held = guarantee(erring(paper(1.0), attitude_deg=90.0), p, [1.0, 0.0, 0.0])
    assert held.lower == 0.0


def test_any_axis_at_all_leaves_a_secret_ratio(paper: Callable, listened: Callable, erring: Callable) -> None:
    """With attitude errors of 90 degrees the ratio is that of the worst of all axes, found on a grid."""
    scene = erring(listened(paper(1.0)), attitude_deg=90.0)
    p = np.array([5.0, 20.0, 12.0])
    held = guarantee(scene, p, [0.3, 0.2, 1.0])
    axes = np.random.default_rng(0).normal(size=(200_000, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    least = [float(np.min(ratios_under(scene, p, axes, ErrorCase.none(scene))[:, k, 0])) for k in range(2)]
    for one, smallest in zip(held.ratios, least, strict=True):
        assert one.lower <= smallest
        assert one.worst == pytest.approx(smallest, rel=1e-3)


def test_a_drone_that_may_be_at_a_node(paper: Callable, listened: Callable, erring: Callable) -> None:
    """A position error that reaches a node leaves a valid bound, as what is sent can only be heard better."""
    scene = erring(listened(paper(1.0)), position_m=3.0)
    held = guarantee(scene, [0.0, 0.0, 2.0], [1.0, 0.0, 0.0], accuracy=0.1)
    assert 0.0 < held.ratios[0].lower <= held.ratios[0].worst
    plain = erring(paper(1.0), position_m=3.0)
    assert guarantee(plain, [0.0, 0.0, 2.0], [1.0, 0.0, 0.0]).lower == 0.0


def test_finer_bounds_are_nested(paper: Callable, erring: Callable) -> None:
    """A finer accuracy raises the bound and leaves it below the worst case."""
    scene = erring(paper(100.0), attitude_deg=2.0, position_m=0.5, extent_m=3.0)
    held = [guarantee(scene, *NULL_ON_JAMMER, accuracy=accuracy) for accuracy in (1e-1, 1e-2, 1e-3, 1e-4)]
    lower = [each.lower for each in held]
    assert lower == sorted(lower)
    assert held[-1].lower >= held[-1].worst * (1.0 - 1.0001e-4)
    assert np.ptp([each.worst for each in held]) <= 1e-8 * held[0].worst


@pytest.mark.parametrize(
    ("position", "axis", "accuracy", "named"),
    [
        ([0.0, math.nan, 8.0], [0.0, 0.0, 1.0], 1e-2, "position_m"),
        ([0.0, 8.0], [0.0, 0.0, 1.0], 1e-2, "position_m"),
        ([0.0, 0.0, 8.0], [0.0, 0.0, 0.0], 1e-2, "axis"),
        ([0.0, 0.0, 8.0], [0.0, 0.0, 1.0], 0.0, "accuracy"),
        ([0.0, 0.0, 8.0], [0.0, 0.0, 1.0], math.nan, "accuracy"),
    ],
)
def test_what_is_no_pose_is_refused(
    position: list[float], axis: list[float], accuracy: float, named: str, paper: Callable
) -> None:
    """Poses that are none and accuracies out of range are told by name."""
    with pytest.raises(UsageError, match=named):
        guarantee(paper(1.0), position, axis, accuracy=accuracy)


def test_arrays_have_no_guarantee(paper: Callable) -> None:
    """A scene with an array is refused, with what to do."""
    plain = paper(1.0).to_dict()
    scene = Scenario(**(plain | {"array": {"elements": 2, "layout": "linear", "spacing_wavelengths": 0.5}}))
    with pytest.raises(UsageError, match="remove \\[array\\]"):
        guarantee(scene, [0.0, 0.0, 8.0], [0.0, 0.0, 1.0])
