"""Wrong arguments of every public function are refused by name, in an error of nullpose."""

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import nullpose
from nullpose import ErrorSizes, Pose, Poses, Scenario, plot
from nullpose.errors import checked

PAPER = nullpose.load("examples/paper.toml")
MOVING = nullpose.load("examples/moving_jammer.toml")
POSE = Pose([0.0, 25.0, 8.0], 0.0, 0.0)
ARRAYS: dict[str, Any] = {"noise_w": 1e-3, "altitude_m": (8, 30)}
FAST: dict[str, Any] = {"certify": False}
JAMMER = "jammers.M.power_w"
ALWAYS_WRONG = (5, "x", (1, 2), {"a": 1}, np.zeros((2, 2)), float("nan"), 1e160, object())

TABLES = (
    *("Airframe", "Airspace", "Antenna", "Array", "Eavesdropper", "Jammer", "Node"),
    *("NoFlyZone", "Origin", "Receiver", "Transmitter"),
)
OF_POSES = ("evaluate", "min_sinr", "min_margin", "min_secrecy_rate", "pose_frames", "sensitivity")
Calls = list[tuple[Callable[[Any], object], tuple[object, ...]]]


def of_table(table: Any) -> Calls:
    """Returns the calls that make a table."""
    return [(table, ALWAYS_WRONG), (table.from_dict, ALWAYS_WRONG)]


def of_pose(function: Callable[..., object]) -> Calls:
    """Returns the calls of a function of a scenario and a pose."""
    return [
        (lambda wrong: function(wrong, POSE), (None, *ALWAYS_WRONG)),
        (lambda wrong: function(PAPER, wrong), (None, *ALWAYS_WRONG)),
        (lambda wrong: function(PAPER, POSE, unit=wrong), ("dB",)),
        (lambda _: function(), (None,)),
    ]


# by the public name, the calls of it, each with what is put in the place of an argument that may not be so
CALLS: dict[str, Calls] = {
    "load": [(nullpose.load, (None, 5, (1, 2)))],
    "apply_overrides": [
        (lambda wrong: nullpose.apply_overrides(wrong, ["name=x"]), ALWAYS_WRONG),
        (lambda wrong: nullpose.apply_overrides(PAPER, wrong), (None, 5, [5], (1, 2), np.zeros(2))),
    ],
    "Scenario": [
        (Scenario, ALWAYS_WRONG),
        (Scenario.from_dict, ALWAYS_WRONG),
        (lambda wrong: Scenario.from_arrays(wrong, **ARRAYS), (None, *ALWAYS_WRONG)),
        (lambda wrong: Scenario.from_arrays([[0, 0, 0]], wrong, **ARRAYS), ALWAYS_WRONG),
        (lambda wrong: Scenario.from_arrays([[0, 0, 0]], **ARRAYS, airspace=wrong), (5, "x", [1])),
        (lambda wrong: Scenario.from_arrays([[0, 0, 0]], **ARRAYS | {"noise_w": wrong}), (None, "x", [1])),
        (lambda wrong: Scenario.from_arrays([[0, 0, 0]], **ARRAYS | {"altitude_m": wrong}), (None, 5, "x")),
        (lambda wrong: Scenario.from_arrays([[0, 0, 0]], **ARRAYS, node_power_dbm=wrong), ("x", [1, 2])),
    ],
    **{name: of_table(getattr(nullpose, name)) for name in TABLES},
    **{name: of_pose(getattr(nullpose, name)) for name in OF_POSES},
    "Pose": [
        (lambda wrong: Pose(wrong, 0.0, 0.0), (None, *ALWAYS_WRONG, [0, 0, 1e160])),
        (lambda wrong: Pose([0, 0, 8], wrong, 0.0), (None, "x", (1, 2), {}, float("nan"), object())),
        (lambda wrong: Pose([0, 0, 8], 0.0, 0.0, 0.0, wrong), (None, "x", (1, 2), {}, float("inf"))),
        (lambda wrong: Pose.from_axis([0, 0, 8], wrong), (None, *ALWAYS_WRONG, [0, 0, 0])),
        (lambda wrong: Pose.from_axis(wrong, [0, 0, 1]), (None, *ALWAYS_WRONG)),
        (lambda wrong: Pose(position=wrong), ([0, 0, 8],)),
    ],
    "Poses": [
        (lambda wrong: Poses(wrong, 0.0, 0.0), (None, 5, "x", {}, [[0, 0, 1e160]], np.zeros((2, 2)))),
        (lambda wrong: Poses([0, 0, 8], wrong, 0.0), (None, "x", {}, float("nan"), np.zeros((2, 2)))),
        (lambda wrong: Poses([0, 0, 8], 0.0, 0.0, 0.0, wrong), (None, "x", {}, (1, 2))),
        (lambda wrong: Poses.from_axis([0, 0, 8], wrong), (None, 5, "x", (1, 2), {}, [0, 0, 0])),
    ],
    "ErrorSizes": [(lambda wrong: ErrorSizes(attitude_deg=wrong), (None, "x", {}, -1.0, 1e160, np.zeros(2)))],
    "solve": [
        (lambda wrong: nullpose.solve(wrong, **FAST), (None, *ALWAYS_WRONG)),
        (lambda wrong: nullpose.solve(PAPER, wrong, **FAST), (None, *ALWAYS_WRONG)),
        *(
            (lambda wrong, key=key: nullpose.solve(PAPER, **FAST | {key: wrong}), ("x", (), {}, -1, 1e-160))
            for key in ("gap", "node_limit", "threads", "seed")
        ),
        (lambda wrong: nullpose.solve(PAPER, **FAST, time_limit_s=wrong), (None, "x", {}, 0.0, float("nan"))),
        (lambda wrong: nullpose.solve(PAPER, gapp=wrong), (1e-3,)),
        (lambda wrong: nullpose.solve(PAPER, node_limit=1, on_progress=wrong), (5, "x")),
    ],
    "compare": [
        (lambda wrong: nullpose.compare(wrong, **FAST), (None, *ALWAYS_WRONG)),
        (lambda wrong: nullpose.compare(PAPER, schemes=wrong, **FAST), (None, 5, "x", ["x"], [5])),
    ],
    "solve_many": [
        (lambda wrong: nullpose.solve_many(wrong, **FAST), (None, *ALWAYS_WRONG, [PAPER, 5])),
        (lambda wrong: nullpose.solve_many([PAPER], airframes=wrong, **FAST), (5, "x", [5], {})),
    ],
    "solve_trajectory": [
        (nullpose.solve_trajectory, (None, *ALWAYS_WRONG, PAPER)),
        (lambda wrong: nullpose.solve_trajectory(MOVING, wrong), (None, *ALWAYS_WRONG)),
        *(
            (lambda wrong, key=key: nullpose.solve_trajectory(MOVING, **{key: wrong}), ("x", {}, -1.0))
            for key in ("gap_db", "time_limit_s", "window_s")
        ),
    ],
    "guarantee": [
        (lambda wrong: nullpose.guarantee(wrong, [0, 25, 8], [0, 0, 1]), (None, *ALWAYS_WRONG)),
        (lambda wrong: nullpose.guarantee(PAPER, wrong, [0, 0, 1]), (None, *ALWAYS_WRONG)),
        (lambda wrong: nullpose.guarantee(PAPER, [0, 25, 8], wrong), (None, *ALWAYS_WRONG)),
    ],
    "certificate_of": [(nullpose.certificate_of, (None, *ALWAYS_WRONG))],
    "verify": [(nullpose.verify, (None, *ALWAYS_WRONG))],
    "evaluate_against": [(lambda wrong: nullpose.evaluate_against(wrong, [POSE]), (None, *ALWAYS_WRONG))],
    "value_map": [(nullpose.value_map, (None, *ALWAYS_WRONG))],
    "compare_airframes": [(nullpose.compare_airframes, (None, *ALWAYS_WRONG))],
    "least_tilt": [
        (nullpose.least_tilt, (None, *ALWAYS_WRONG)),
        (lambda wrong: nullpose.least_tilt(PAPER, share=wrong), (None, *ALWAYS_WRONG)),
    ],
    "sweep": [
        (lambda wrong: nullpose.sweep(wrong, JAMMER, [1.0]), (None, *ALWAYS_WRONG)),
        (lambda wrong: nullpose.sweep(PAPER, wrong, [1.0], **FAST), (None, *ALWAYS_WRONG)),
        (lambda wrong: nullpose.sweep(PAPER, JAMMER, wrong, **FAST), (None, 5, "x", ["x"], float("nan"))),
    ],
    "poses_from_csv": [(nullpose.poses_from_csv, (None, 5, "no-such.csv", (1, 2)))],
    "show": [(nullpose.show, (None, *ALWAYS_WRONG))],
    **{f"plot.{name}": [(getattr(plot, name), (None, *ALWAYS_WRONG))] for name in plot.__all__},
}  # fmt: skip
NOT_CALLED = {"json_schema"}  # which takes nothing


@pytest.mark.parametrize("name", CALLS)
def test_wrong_arguments_are_refused(name: str) -> None:
    """Whatever is put in the place of an argument, the error is one of nullpose and has words."""
    for call, wrongs in CALLS[name]:
        for wrong in wrongs:
            with pytest.raises(nullpose.NullposeError) as caught:
                call(wrong)
            assert str(caught.value)


def test_no_public_function_is_left_out() -> None:
    """Each is in the table above."""
    functions = {name for name in nullpose.__all__ if inspect.isfunction(getattr(nullpose, name))}
    assert functions - NOT_CALLED <= CALLS.keys()


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (
            lambda: nullpose.solve(PAPER, time_limit=1),
            "time_limit: unknown option; did you mean time_limit_s?",
        ),
        (lambda: nullpose.min_sinr(PAPER, (0, 25, 8)), r"pose: given \(0, 25, 8\); allowed: Pose | Poses"),
        (lambda: nullpose.min_sinr("paper.toml", POSE), r"try Scenario\.from_file\('paper.toml'\)"),
        (
            lambda: nullpose.solve_many([PAPER, "x"]),
            r"scenarios: given \[.*'x'\]; allowed: Sequence\[Scenario",
        ),
        (lambda: Pose([0, 0, 8]), "missing a required argument: 'roll_rad'; allowed: position_m, roll_rad"),
        (
            lambda: Pose([1e160, 0, 8], 0, 0),
            r"position_m: given \[1e\+160, .*allowed: three finite numbers, metres, up to 1e\+100",
        ),
    ],
)
def test_refusals_say_what_is_allowed(call: Callable[[], object], words: str) -> None:
    """The argument, what was given, what is allowed, and what may be meant."""
    with pytest.raises(nullpose.UsageError, match=words):
        call()


def test_a_fault_of_the_program_stays_one() -> None:
    """Where all arguments fit, an error is not put down to them."""

    @checked
    def broken(number: float) -> float:
        return [][0] / number

    with pytest.raises(IndexError):
        broken(1.0)
    with pytest.raises(nullpose.WrongTypeError, match="number: given 'x'; allowed: float"):
        broken("x")
