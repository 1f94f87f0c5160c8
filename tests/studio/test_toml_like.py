"""A scenario goes back into the file that it is from, and leaves the rest of it alone."""

import json
import re
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, strategies as st
from sizes import few_examples

from nullpose import load
from nullpose.errors import ScenarioError
from nullpose.scenario import Airframe, Jammer, Node, NoFlyZone, Scenario
from nullpose.scenario.loading import scenario_from_text
from nullpose.studio.edits import entries_of, with_added, with_typed
from nullpose.studio.state import State
from nullpose.studio.toml_like import toml_like

FOLDER = Path(__file__).parents[2] / "examples"
EXAMPLES = sorted(path.stem for path in FOLDER.glob("*.toml") if not path.stem.startswith("study"))
ALONE = [name for name in EXAMPLES if name not in ("geodetic", "frame")]  # those that name no other file

METRES = st.floats(-300.0, 300.0).map(lambda value: round(value, 3))
NAMES = st.text(min_size=1, max_size=12).filter(lambda name: name.isprintable() and name == name.strip())
POWERS_W = st.one_of(st.sampled_from([0.1, 1.0, 2.0]), st.floats(1e-6, 1e3))

Edit = Callable[[Scenario], Scenario]


@cache
def example(name: str) -> tuple[str, Scenario]:
    """Return the text of an example and its scenario."""
    path = FOLDER / f"{name}.toml"
    return path.read_text(), load(path)


def _listed(kind: str, place: int, update: dict[str, object] | None) -> Edit:
    """Change a point of a list, or take it out."""

    def edit(scenario: Scenario) -> Scenario:
        points = list(getattr(scenario, kind))
        if points:
            point = points.pop(place % len(points))
            if update is not None:
                points.insert(place % (len(points) + 1), point.model_copy(update=update))
        return scenario.model_copy(update={kind: tuple(points)})

    return edit


def _added(kind: str, name: str, position_m: Any, power_w: float) -> Edit:
    made = (Node if kind == "nodes" else Jammer)(name=name, position_m=position_m, power_w=power_w)
    return lambda scenario: scenario.model_copy(update={kind: (*getattr(scenario, kind), made)})


def _airspace(**update: Any) -> Edit:
    return lambda scenario: scenario.model_copy(
        update={"airspace": scenario.airspace.model_copy(update=update)}
    )


def _zoned(name: str, x_m: float, y_m: float) -> Edit:
    zone = NoFlyZone(name=name, centre_m=(x_m, y_m), radius_m=3.0)
    return lambda scenario: _airspace(no_fly=(*scenario.airspace.no_fly, zone))(scenario)


def _tilted(tilt_deg: float) -> Edit:
    airframe = Airframe(tilt_max_deg=tilt_deg, mount_deg=90.0)
    return lambda scenario: scenario.model_copy(update={"airframe": airframe})


UPDATES = st.one_of(
    st.none(),
    st.fixed_dictionaries({"position_m": st.tuples(METRES, METRES, st.floats(0.0, 5.0))}),
    st.fixed_dictionaries({"name": NAMES}),
    st.fixed_dictionaries({"power_w": POWERS_W, "power_dbm": st.none()}),
    st.just({"antenna": "dipole", "antenna_axis": (1.0, 0.0, 0.0)}),
)
EDITS = st.one_of(
    st.builds(_listed, st.sampled_from(["nodes", "jammers", "eavesdroppers"]), st.integers(0, 9), UPDATES),
    st.builds(_added, st.sampled_from(["nodes", "jammers"]), NAMES, st.just((1.5, -2.0, 0.0)), POWERS_W),
    st.builds(_zoned, NAMES, METRES, METRES),
    st.sampled_from([_airspace(no_fly=()), _airspace(geofence_m=None)]),
    st.floats(50.0, 300.0).map(lambda x: _airspace(geofence_m=((-x, -x), (x, -x), (0.0, x)))),
    st.floats(6.0, 80.0).map(lambda low_m: _airspace(altitude_m=(low_m, 90.0))),
    st.builds(_tilted, st.floats(1.0, 180.0)),
    st.floats(-30.0, 40.0).map(lambda db: lambda s: State(scenario=s).with_power_db(db).scenario),
)


@pytest.mark.parametrize("name", EXAMPLES)
@few_examples(8)
@given(edits=st.lists(EDITS, min_size=1, max_size=6))
def test_what_is_saved_loads_as_it_was_and_keeps_its_comments(name: str, edits: list[Edit]) -> None:
    """After any edits, by themselves; its heading stays."""
    text, scenario = example(name)
    for edit in edits:
        with suppress(ScenarioError):
            scenario = edit(scenario)
    saved = toml_like(text, scenario)
    assert scenario_from_text(saved.encode(), "saved.toml") == scenario
    heading = text.split("\n\n")[0]
    assert saved.startswith(heading) or heading.startswith("[")
    if name in ALONE and name != "no-fly":
        above = text.split("[[nodes]]")[0].splitlines()
        assert [line for line in above if line.startswith("#") and line not in saved] == []


@pytest.mark.parametrize("name", ALONE)
@pytest.mark.parametrize("ends", ["\n", "\r\n", ""])
def test_what_is_not_changed_is_the_same_text(name: str, ends: str) -> None:
    """To the byte, whatever ends its lines."""
    text, scenario = example(name)
    text = text.replace("\n", ends) if ends else text.rstrip("\n")
    assert toml_like(text, scenario) == text


def test_what_another_file_held_is_in_the_saved_one() -> None:
    """Nodes and the harmonics of a pattern, so that the file loads anywhere."""
    for name, lost in (("geodetic", "nodes_from = "), ("frame", None)):
        text, scenario = example(name)
        saved = toml_like(text, scenario)
        assert scenario_from_text(saved.encode(), "saved.toml") == scenario
        kept = [line for line in text.splitlines() if not (lost and line.startswith(lost))]
        assert [line for line in kept if line not in saved.splitlines()] == []


HAND_MADE = """\
# A scene of my own.
name = 'mine'   # a title

[airspace]   # where it may fly
altitude_m = [8, 30]
geofence_m = [
  [-60, -60],   # the south-west
  [60, -60],
  [0, 90]
]

[receiver]
noise_w = 1e-3
reference_gain_db = 0

# All nodes.
[[nodes]]
position_m = [0, 0, 0]
power_dbm = 30   # one watt
[[nodes]]
# the second
position_m = [0.0, 50.0, 0.0]
power_dbm = 30

# Jammers follow.

# The one on the roof.
[[jammers]]
name = "roof"
position_m = [17, 15, 4]
power_w = 1_000e-3

# the end
"""


def _saved(text: str, *edits: Edit) -> str:
    scenario = scenario_from_text(text.encode(), "")
    for edit in edits:
        scenario = edit(scenario)
    saved = toml_like(text, scenario)
    assert scenario_from_text(saved.encode(), "") == scenario
    return saved


MOVED = _listed("jammers", 0, {"position_m": (17.0, 15.5, 4.0)})
IN_WATTS = _listed("nodes", 0, {"power_w": 0.3, "power_dbm": None})


@pytest.mark.parametrize(
    ("edit", "before", "after"),
    [
        (MOVED, "[17, 15, 4]", "[17, 15.5, 4]"),
        (_airspace(geofence_m=((-60.0, -60.0), (60.0, -61.0), (0.0, 90.0))), "[60, -60]", "[60, -61.0]"),
        (_listed("nodes", 0, {"power_dbm": 20.0}), "power_dbm = 30   # one", "power_dbm = 20.0   # one"),
        (IN_WATTS, "power_dbm = 30   # one", "power_w = 0.3   # one"),
    ],
)
def test_only_what_changed_is_written_anew(edit: Edit, before: str, after: str) -> None:
    """One number of a list, in its place; a corner of a fence over several lines; a power in either unit."""
    assert _saved(HAND_MADE, edit) == HAND_MADE.replace(before, after)


def test_a_point_that_is_gone_takes_its_comments_along() -> None:
    """The comment above it and those within it, but not the one above the list, nor one that stands alone."""
    without = _saved(HAND_MADE, _listed("jammers", 0, None))
    assert "roof" not in without
    assert without.endswith("# Jammers follow.\n\n\n# the end\n")
    first = _saved(HAND_MADE, _listed("nodes", 0, None))
    assert "one watt" not in first
    assert "# All nodes.\n[[nodes]]\n# the second\n" in first
    assert 'name = "S2"' in first


def test_a_new_point_stands_behind_the_others_of_its_kind() -> None:
    """With an empty line before it."""
    edit = _added("nodes", "new", (1.0, 2.0, 0.0), 0.1)
    added = _saved(HAND_MADE, edit)
    block = '[[nodes]]\nname = "new"\nposition_m = [1.0, 2.0, 0.0]\npower_w = 0.1\n'
    head, tail = HAND_MADE.split("\n# Jammers follow.")
    assert added == f"{head}\n{block}\n# Jammers follow.{tail}"
    late = f"{HAND_MADE}\n[[airspace.no_fly]]\ncentre_m = [5, 5]\nradius_m = 3\n"
    assert _saved(late, edit) == late.replace(HAND_MADE, added)


def test_a_town_stays_with_its_channel(tmp_path: Path) -> None:
    """Of a scene that is edited; what a file of buildings held is in the saved text, its comment too."""
    text, scenario = example("town")
    state = State(scenario=scenario, text=text)
    state = with_added(state.moved(("nodes", 0), (-71.0, -3.0, 2.0)), "jammer", (1.0, -50.0), 100.0)
    saved = state.written.text
    assert scenario_from_text(saved.encode(), "saved.toml") == state.scenario
    town = text[text.index("# north-west of") :]
    assert town in saved
    shape = {
        "type": "Polygon",
        "coordinates": [[[14.501, 50.0], [14.502, 50.0], [14.502, 50.001], [14.501, 50.0]]],
    }
    feature = {"type": "Feature", "properties": {"height": 9.0}, "geometry": shape}
    (tmp_path / "town.geojson").write_text(json.dumps(feature))
    origin = "[origin]\nlat_deg = 50.0\nlon_deg = 14.5\nalt_m = 230.0\n\n"
    named = f'{town.split("[[")[0]}[[buildings]]\nbuildings_from = "town.geojson"\nmissing_height_m = 4.0\n'
    text = text.replace("[airspace]", f"{origin}[airspace]", 1).replace(town, named)
    (tmp_path / "town.toml").write_text(text)
    state = State(scenario=load(tmp_path / "town.toml"), text=text).moved(("nodes", 0), (-71.0, -3.0, 2.0))
    saved = state.written.text
    assert scenario_from_text(saved.encode(), "saved.toml") == state.scenario
    assert [building.heights_m for building in state.scenario.buildings] == [(9.0, 9.0)]
    assert [line for line in text.splitlines() if "#" in line and line not in saved.splitlines()] == []


def test_powers_in_dbm_stay_in_dbm() -> None:
    """Those that are typed, those that the slider sets, and that of a point that is added."""
    text, scenario = example("field")
    view = State(scenario=scenario, text=text)
    (power,) = (entry for entry in entries_of(view, ("nodes", 0)) if entry.path == "nodes[0].power_dbm")
    typed = with_typed(view, power, "17.5")
    saved = with_added(typed.with_power_db(3.0), "jammer", (10.0, 20.0), 100.0).written.text
    assert "power_w =" not in saved
    assert "power_dbm = 17.5\n" in saved
    assert re.findall("power_dbm = .*# (?:4|0.5) W", saved) == [
        "power_dbm = 26.0                  # 4 W",
        "power_dbm = 17.0                  # 0.5 W",
    ]


def test_points_may_stand_in_one_list() -> None:
    """What stands behind one that moves stays there; an empty list gives way to tables."""
    head = HAND_MADE.split("\n# All nodes.")[0]
    text = f"""\
jammers = []
nodes = [
  {{ position_m = [0, 0, 0], power_w = 1 }},  # the first
  {{ position_m = [9, 0, 0], power_w = 1 }},  # the second
]
{head}"""
    moved, added = (
        _listed("nodes", 1, {"position_m": (8.0, 0.0, 0.0)}),
        _added("jammers", "M", (1.0, 2.0, 0.0), 2.0),
    )
    saved = _saved(text, moved, added)
    assert "  { position_m = [0, 0, 0], power_w = 1 },  # the first\n" in saved
    assert re.search("8.0, 0.0, 0.0.*},  # the second\n", saved)
    assert saved.endswith('[[jammers]]\nname = "M"\nposition_m = [1.0, 2.0, 0.0]\npower_w = 2.0\n')


def test_without_a_files_text_it_is_the_scenarios_own(paper: Scenario) -> None:
    """So too where the text is of something else."""
    for text in ("", "no scenario", "[airspace]\n"):
        assert toml_like(text, paper) == paper.to_toml()
