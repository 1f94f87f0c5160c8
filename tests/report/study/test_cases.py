"""Cases are named as the vehicles that they are, and the right one is measured against."""

import copy
from collections.abc import Callable
from typing import Any

import pytest

from nullpose.report.study.cases import point_words, report_cases, shown_points
from nullpose.study import AIRFRAME_CASES
from nullpose.study.monte_carlo import StudySpec

SCENE: dict[str, Any] = {
    "airspace": {"altitude_m": [8.0, 30.0]},
    "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
    "nodes": [{"position_m": [0.0, 0.0, 0.0], "power_w": 1.0}],
    "jammers": [{"name": "M", "position_m": [9.0, 0.0, 4.0], "power_w": 1.0}],
}

Specify = Callable[..., StudySpec]


@pytest.fixture
def specify() -> Specify:
    """A spec with the cases given and changes to its scene."""

    def spec(*cases: dict[str, Any], scene: dict[str, Any] | None = None, **tables: Any) -> StudySpec:
        whole = copy.deepcopy(SCENE) | (scene or {})
        return StudySpec.from_dict({"scenes": 2, "scene": whole, "cases": list(cases), **tables})

    return spec


def test_vehicles_have_their_phrases(specify: Specify) -> None:
    """The usual ones are named as everywhere, whatever the case is called and however it is stated."""
    cases = report_cases(
        specify(*({"name": f"v{n}", "airframe": c.name} for n, c in enumerate(AIRFRAME_CASES)))
    )
    assert list(cases["phrase"]) == [case.phrase for case in AIRFRAME_CASES]
    stated = report_cases(specify({"name": "x", "airframe": {"tilt_max_deg": 10.0, "mount_deg": 90.0}}))
    assert list(stated.loc["x", ["usual", "phrase"]]) == [
        "tilt-10-horizontal",
        "a 10 degree tilt with a horizontal dipole",
    ]
    other = report_cases(specify({"name": "x", "airframe": {"tilt_max_deg": 20.0, "mount_deg": 45.0}}))
    phrase = "a 20 degree tilt with the dipole mounted at 45 degrees"
    assert list(other.loc["x", ["usual", "phrase"]]) == ["", phrase]


def test_what_is_no_vehicle_is_named_as_the_spec_does(specify: Specify) -> None:
    """Schemes, arrays and poses; a scheme's upright dipole is the level vehicle."""
    cases = report_cases(
        specify(
            {"name": "a", "scheme": "zero-interference"},
            {"name": "b", "scheme": "vertical"},
            {"name": "c", "array": {"elements": 4, "layout": "linear", "spacing_wavelengths": 0.5}},
            {"name": "d", "pose": {"position_m": [0.0, 0.0, 9.0]}},
        )
    )
    assert list(cases["phrase"]) == [
        "the zero interference pose",
        "a level vehicle with a vertical dipole",
        "a level vehicle with an array of 4 with digital combining",
        "the given pose d",
    ]
    assert list(cases["usual"]) == ["", "level-vertical", "", ""]


def test_the_scenes_vehicle(specify: Specify) -> None:
    """Without one of its own a case has the scene's: any attitude, what is stated, or not known if swept."""
    assert report_cases(specify({"name": "a"})).loc["a", "usual"] == "omnidirectional"
    level = {"airframe": {"tilt_max_deg": 0.0}}
    assert report_cases(specify({"name": "a"}, scene=level)).loc["a", "usual"] == "level-vertical"
    swept = specify({"name": "a"}, scene=level, sweep={"airframe.tilt_max_deg": [0.0, 5.0]})
    assert list(report_cases(swept).loc["a", ["usual", "phrase"]]) == ["", "the case a"]


def test_equal_phrases_are_told_apart(specify: Specify) -> None:
    """Two cases with one vehicle carry their names."""
    cases = report_cases(specify({"name": "a"}, {"name": "b", "certify": False}))
    assert list(cases["phrase"]) == ["an omnidirectional vehicle (a)", "an omnidirectional vehicle (b)"]


def test_what_others_are_measured_against(specify: Specify) -> None:
    """The upright level vehicle, another level one, the first; robust cases among themselves."""
    free, tilt = {"name": "free"}, {"name": "tilt", "airframe": "tilt-10-horizontal"}
    flat, upright = ({"name": name, "airframe": name} for name in ("level-horizontal", "level-vertical"))
    for given, expected in (
        ((free, flat, upright), "level-vertical"),
        ((free, tilt, flat), "level-horizontal"),
        ((free, tilt), "free"),
    ):
        sure = {"name": "sure", "airframe": "tilt-30-horizontal", "robust": True}
        cases = report_cases(specify(*given, sure))
        assert set(cases.loc[~cases["robust"], "against"]) == {expected}
        assert set(cases.loc[~cases["robust"], "whole"]) == {"free"}
        assert list(cases.loc["sure", ["against", "whole"]]) == ["sure", ""]


def test_combinations_in_words(specify: Specify) -> None:
    """Values have their units; few of many are shown, the first and the last among them."""
    grid = specify({"name": "a"}, sweep={"receiver.noise_w": [1e-3, 1e-2], "jammers.M.power_w": [2.0, 4.0]})
    assert point_words(grid, 3) == "receiver.noise_w = 0.01 W, jammers.M.power_w = 4 W"
    assert shown_points(grid) == [0, 1, 2, 3]
    many = {"jammers.M.power_w": {"from": 1.0, "to": 100.0, "points": 37, "spacing": "log"}}
    shown = shown_points(specify({"name": "a"}, sweep=many))
    assert (len(shown), shown[0], shown[-1]) == (6, 0, 36)
    nothing = specify({"name": "a"})
    assert (point_words(nothing, 0), shown_points(nothing)) == ("", [0])
