"""Sensitivity: the values found under errors are as low as those of thousands of random errors."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from sizes import and_slow, chosen

import nullpose
from nullpose.errors import UsageError
from nullpose.physics import ErrorCase, Pose, ratios_under
from nullpose.physics.array import array_ratios_under
from nullpose.physics.rotation import rotation_about
from nullpose.scenario import Scenario
from nullpose.solver import ErrorSizes, sensitivity

KINDS = ("attitude", "position", "jammers", "all")


def random_cases(scenario, sizes, kind, random, count=2000):
    """Return random errors of a kind, half of them as large as allowed."""

    def inside(dimensions, size):
        vectors = random.normal(size=(count, dimensions))
        radius = np.where(random.random(count) < 0.5, 1.0, random.random(count) ** (1.0 / dimensions))
        return size * radius[:, None] * vectors / np.linalg.norm(vectors, axis=1, keepdims=True)

    points = scenario.objective_record.interferers
    moved = np.zeros((count, len(getattr(scenario, points)), 3))
    for index in range(moved.shape[1]):
        moved[:, index, :2] = inside(2, sizes.jammers_m if kind in ("jammers", "all") else 0.0)
    still = ErrorCase.none(scenario)
    offsets = {
        "jammers": still.jammer_offsets_m,
        "eavesdroppers": still.eavesdropper_offsets_m,
        points: moved,
    }
    return ErrorCase(
        position_offset_m=inside(3, sizes.position_m if kind in ("position", "all") else 0.0),
        rotation_world=rotation_about(
            inside(3, np.radians(sizes.attitude_deg) if kind in ("attitude", "all") else 0.0)
        ),
        jammer_offsets_m=offsets["jammers"],
        eavesdropper_offsets_m=offsets["eavesdroppers"],
    )


def random_scene(seed):
    """Return a scene with dipoles, whips or an array, and sizes of errors."""
    random = np.random.default_rng(seed)
    kind = ("dipole", "whips", "leak", "half-wave", "array")[seed % 5]

    def point(power):
        whip = {"antenna": "dipole"} if kind == "whips" and random.random() < 0.7 else {}
        position_m = [*random.uniform(0.0, 200.0, 2).tolist(), float(random.uniform(0.0, 4.0))]
        return {"position_m": position_m, "power_w": float(power)} | whip

    extra = {
        "leak": {"antenna": {"kind": "dipole", "null_depth_db": 20.0}},
        "half-wave": {"antenna": {"kind": "half-wave"}},
        "array": {"array": {"elements": 4, "layout": "linear", "spacing_wavelengths": 0.5}},
    }
    scenario = Scenario.from_dict(
        {
            "airspace": {"altitude_m": [8.0, 60.0]},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "nodes": [point(1.0) for _ in range(random.integers(1, 6))],
            "jammers": [point(10.0 ** random.uniform(-1.0, 2.0)) for _ in range(random.integers(1, 4))],
            **extra.get(kind, {}),
        }
    )
    sizes = (ErrorSizes(), ErrorSizes(attitude_deg=4.0, position_m=3.0, jammers_m=100.0))[seed // 5 % 2]
    return scenario, sizes


@pytest.mark.parametrize("seed", and_slow(range(5), range(5, 20)))
def test_no_random_error_is_worse_by_more_than_a_twentieth_of_a_decibel(seed):
    """Of 2,000 random errors of each kind none gives a smaller value, to .05 dB."""
    scenario, sizes = random_scene(seed)
    random, pose = np.random.default_rng(seed), nullpose.solve(scenario, certify=False).pose
    ratios = partial(ratios_under, scenario, pose.position_m, pose.orientation(scenario.antenna_record))
    if scenario.array is not None:
        ratios = partial(array_ratios_under, scenario, pose)
    found = sensitivity(scenario, pose, sizes)
    for kind in KINDS:
        lowest = np.min(ratios(random_cases(scenario, sizes, kind, random)))
        assert getattr(found, kind) <= lowest * 10.0**0.005


@pytest.mark.parametrize("seed", chosen(range(5), [0, 1, 4]))
def test_more_errors_never_give_a_larger_value(seed):
    """All errors together are at least as bad as each kind; each kind is at least as bad as none."""
    scenario, sizes = random_scene(seed)
    random = np.random.default_rng(seed)
    pose = Pose([*random.uniform(0.0, 200.0, 2), 30.0], *random.uniform(-1.0, 1.0, 3))
    found = sensitivity(scenario, pose, sizes)
    assert found.all <= min(found.attitude, found.position, found.jammers)
    assert max(found.attitude, found.position, found.jammers) <= found.nominal
    assert found == sensitivity(scenario, pose, sizes)


def test_without_errors_nothing_is_lost(paper):
    """Errors of size zero leave the value of the objective."""
    scenario = paper()
    result = nullpose.solve(scenario)
    none = ErrorSizes(attitude_deg=0.0, position_m=0.0, jammers_m=0.0)
    found = sensitivity(scenario, result.pose, none)
    assert found.all == pytest.approx(result.objective.value, rel=1e-12)
    assert found.loss_db() == pytest.approx(0.0, abs=1e-9)


def test_a_node_at_the_arrays_height_is_no_fault():
    """Whose direction meets no ground on which a jammer could be."""
    point = {"power_w": 1.0}
    scenario = Scenario.from_dict(
        {
            "airspace": {"altitude_m": [8.0, 8.0]},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "array": {"elements": 4, "layout": "linear", "spacing_wavelengths": 0.5},
            "nodes": [{"position_m": [0.0, 0.0, 8.0]} | point, {"position_m": [50.0, 0.0, 0.0]} | point],
            "jammers": [{"position_m": [20.0, 30.0, 1.0]} | point],
        }
    )
    found = sensitivity(scenario, Pose([30.0, 0.0, 8.0], 0.0, 0.0, 0.0))
    assert 0.0 < found.all <= found.jammers <= found.nominal


def test_a_jammer_elsewhere_shows_that_a_pose_stands_on_a_null():
    """A level drone straight above the jammer's whip loses tens of dB when the jammer is 200 m away."""
    whip = {"antenna": "dipole"}
    places = [(0, 0, 1), (300, 40, 1), (120, 260, 1), (-90, 180, 1), (210, -150, 1)]
    scenario = Scenario.from_dict(
        {
            "airspace": {"altitude_m": [30.0, 120.0]},
            "receiver": {"noise_dbm": -95.0, "frequency_hz": 2.4e9},
            "airframe": {"tilt_max_deg": 0.0},
            "nodes": [{"position_m": at, "power_w": 0.1} | whip for at in places],
            "jammers": [{"position_m": [90.0, 60.0, 2.0], "power_w": 10.0} | whip],
        }
    )
    result = nullpose.solve(scenario)
    found = sensitivity(scenario, result.pose, ErrorSizes(jammers_m=200.0))
    assert found.loss_db("jammers") > 20.0
    assert found.loss_db("all") >= found.loss_db("jammers")


def test_jammers_that_move_together_do_their_worst():
    """Two jammers that leave the null on opposite sides: the search finds no more than that case gives."""
    scenario = Scenario.from_dict(
        {
            "airspace": {"altitude_m": [17.0, 19.0]},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "nodes": [
                {"position_m": [45.7, 106.6, 2.3], "power_w": 1.644},
                {"position_m": [166.9, 194.0, 0.7], "power_w": 0.4748},
            ],
            "jammers": [
                {"position_m": [156.6, 47.5, 3.0], "power_w": 10930.0},
                {"position_m": [111.5, 33.1, 2.7], "power_w": 40680.0},
            ],
        }
    )
    pose = Pose([267.33, 87.54, 17.53], *np.radians([-19.46, 83.86, 0.0]))
    moved_m = [(22.824, -19.465, 0.0), (0.69, 29.989, 0.0)]
    case = replace(ErrorCase.none(scenario), jammer_offsets_m=moved_m)
    ratios = ratios_under(scenario, pose.position_m, pose.orientation(scenario.antenna_record), case)
    found = sensitivity(scenario, pose, ErrorSizes(attitude_deg=2.0, position_m=0.5, jammers_m=30.0))
    assert found.all <= found.jammers <= 1.001 * np.min(ratios) < 0.02 * found.nominal


def test_an_eavesdropper_elsewhere_costs_secrecy():
    """Under a secrecy rate the eavesdroppers are moved, and a rate is never below zero."""
    result = nullpose.solve(nullpose.load("examples/eavesdropper.toml"))
    found = result.sensitivity
    assert 0.0 <= found.all <= found.jammers < found.nominal
    assert found.nominal == pytest.approx(result.objective.value)
    assert result.to_dict()["sensitivity"]["all"]["value_db"] is None


@pytest.mark.parametrize("sizes", [{"attitude_deg": -1.0}, {"position_m": float("nan")}, {"jammers_m": 1e9}])
def test_sizes_of_errors_are_checked(sizes):
    """A size that is negative, no number or beyond all reason is refused by its name."""
    with pytest.raises(UsageError, match=next(iter(sizes))):
        ErrorSizes(**sizes)
