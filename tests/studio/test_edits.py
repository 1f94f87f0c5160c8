"""Editing keeps scenarios sound: what is added, deleted or typed is there, and nothing else changes."""

import numpy as np
import pytest

from nullpose import load
from nullpose.errors import ScenarioError
from nullpose.scenario.loading import scenario_from_text
from nullpose.studio.case import new_scenario
from nullpose.studio.edits import ADDED, entries_of, with_added, with_fence, with_typed, without
from nullpose.studio.state import Key, State
from scenes import EXAMPLES

PAPER = State(scenario=load(EXAMPLES / "paper.toml"))


@pytest.mark.parametrize("name", ["eavesdropper", "field", "no-fly", "robust", "airframe", "relay"])
def test_what_is_typed_unchanged_changes_nothing(name: str) -> None:
    """The texts that are shown, taken as they are, leave the very same view."""
    view = State(scenario=load(EXAMPLES / f"{name}.toml"))
    zones = [("no_fly", i) for i in range(len(view.members("no_fly")))]
    for key in (None, *(key for key, _ in view.points()), *zones):
        assert all(with_typed(view, entry, entry.text) is view for entry in entries_of(view, key))


@pytest.mark.parametrize("what", ["node", "jammer", "no-fly zone"])
def test_what_is_added_can_be_deleted_again(what: str) -> None:
    """It stands where the click was, under a name of its own; without it the scene is as before."""
    more = with_added(PAPER, what, (-12.345, 7.0), 100.0)
    kind = ADDED[what]
    one = more.members(kind)[-1]
    place = one.centre_m if kind == "no_fly" else one.position_m[:2]
    assert place == pytest.approx((-12.345, 7.0), abs=0.006)
    names = [point.name for _, point in more.points()]
    assert len(set(names)) == len(names)
    assert without(more, (kind, len(more.members(kind)) - 1)) == PAPER


def test_what_makes_no_scenario_is_refused() -> None:
    """An eavesdropper where nothing is secret, and a scene without a node."""
    with pytest.raises(ScenarioError, match="secrecy-rate"):
        with_added(PAPER, "eavesdropper", (1.0, 2.0), 100.0)
    secret = State(scenario=load(EXAMPLES / "eavesdropper.toml"))
    assert len(with_added(secret, "eavesdropper", (1.0, 2.0), 100.0).members("eavesdroppers")) == 2
    with pytest.raises(ScenarioError, match="nodes"):
        without(State(scenario=new_scenario()), ("nodes", 0))


def _typed(view: State, key: Key | None, path: str, text: str) -> State:
    (entry,) = (entry for entry in entries_of(view, key) if entry.path == path)
    return with_typed(view, entry, text)


def test_a_tilt_limit_comes_and_goes() -> None:
    """A number limits the tilt, "any" frees it, and the mount alone leaves it free."""
    limited = _typed(PAPER, None, "airframe.tilt_max_deg", "30")
    assert limited.scenario.airframe is not None
    assert np.degrees(limited.scenario.airframe.tilt_max_rad) == pytest.approx(30.0)
    assert _typed(limited, None, "airframe.tilt_max_deg", "any").scenario.axis_band == (0.0, 1.0)
    mounted = _typed(PAPER, None, "airframe.mount_deg", "90").scenario
    assert mounted.airframe is not None
    assert (mounted.airframe.mount_deg, mounted.axis_band) == (90.0, (0.0, 1.0))


@pytest.mark.parametrize(("key", "text"), [("power_w", "-3"), ("name", "S1")])
def test_what_is_not_allowed_is_told_by_path(key: str, text: str) -> None:
    """A negative power, and a name that is taken."""
    with pytest.raises(ScenarioError) as refused:
        _typed(PAPER, ("jammers", 0), f"jammers[0].{key}", text)
    assert [fault.path for fault in refused.value.faults] == [f"jammers[0].{key}"]


def test_a_fence_is_drawn_and_taken_away() -> None:
    """Its corners are those clicked; an empty text takes it away."""
    corners = [(-40.0, -20.0), (40.0, -20.0), (40.0, 70.0)]
    fenced = with_fence(PAPER, corners)
    assert np.allclose(fenced.scenario.airspace.geofence_m, corners)
    assert _typed(fenced, None, "airspace.geofence_m", "") == PAPER


def test_comments_go_with_a_renamed_point_and_not_with_another_of_its_name() -> None:
    """A jammer that is renamed and then moved keeps its comments; one that takes its place has none."""
    head = "[airspace]\naltitude_m = [8.0, 30.0]\n[receiver]\nnoise_w = 1e-3\nreference_gain_db = 0.0\n"
    text = f"""\
{head}[[nodes]]
position_m = [0.0, 0.0, 0.0]
power_w = 1.0

# the roof
[[jammers]]
name = "M1"
position_m = [17.0, 15.0, 4.0]
power_w = 2.0   # measured
"""
    view, key = State(scenario=scenario_from_text(text.encode(), ""), text=text), ("jammers", 0)
    moved = _typed(view, key, "jammers[0].position_m[0]", "18")
    renamed = _typed(moved, key, "jammers[0].name", "roof").moved(key, (19.0, 15.0, 4.0))
    assert renamed.written.text == text.replace('"M1"', '"roof"').replace("[17.0", "[19.0")
    saved = with_added(without(view, key), "jammer", (30.0, 30.0), 50.0).written.text
    assert 'name = "M1"' in saved
    assert "roof" not in saved
    assert "measured" not in saved
