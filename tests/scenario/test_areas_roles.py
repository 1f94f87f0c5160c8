"""Whether a file's area is to be stayed in or out of: a few words decide, and none is read the wrong way."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
import shapely
from geo_files import (
    WRITERS,
    in_metres,
    require_kept_out,
    require_refusal,
    scene,
    write_geojson,
    zones,
    zones_of,
)

from nullpose.errors import ScenarioError
from nullpose.scenario import Scenario, load

SQUARE = shapely.box(14.498, 49.999, 14.502, 50.001)
POND = shapely.box(14.499, 49.9995, 14.4995, 50.0)

IN = [
    {"Type": "Inclusive"},
    {"inclusion": True},
    {"inclusive": 1},
    {"fenceType": "KEEP_IN"},
    {"exclusion": "no"},
]
FREE = [
    {"restriction": "NO_RESTRICTION"},
    {"type": "NO_RESTRICTION"},
    {"restriction": "none"},
    {"allowed": "yes"},
    {"no_fly": False},
]
OUT = [
    {"Type": "Exclusive"},
    {"inclusion": False},
    {"type": "REQ_AUTHORISATION"},
    {"restriction": "PROHIBITED"},
    {"restriction": "CONDITIONAL"},
    {"kind": "no-fly"},
    {"isExclusion": True},
]
UNKNOWN = [
    {"type": "CTR"},
    {"restriction": "maybe"},
    {"inclusion": "perhaps"},
    {"flying_not_permitted": True},
    {"notAllowed": "yes"},
    {"fence_type": 2},
]


def fence_of(folder: Path, features: list[Any]) -> tuple[Scenario, list[str]]:
    """Return the scenario with the fence of a file, and the notes of loading it."""
    write_geojson(folder / "f.geojson", features)
    notes: list[str] = []
    path = scene(folder, 'altitude_m = [10.0, 120.0]\ngeofence_from = "f.geojson"')
    return load(path, on_note=notes.append), notes


@pytest.mark.parametrize("ending", WRITERS)
@pytest.mark.parametrize("words", OUT)
def test_a_ban_is_a_zone_and_no_fence(words: dict[str, Any], ending: str, tmp_path: Path) -> None:
    """In any format."""
    scenario, notes = zones(tmp_path, [(SQUARE, words)], ending)
    require_kept_out(scenario, in_metres(SQUARE))
    assert "not known" not in notes[0]
    with pytest.raises(ScenarioError, match="0 areas beside 1 to stay out of"):
        fence_of(tmp_path, [(SQUARE, words)])


@pytest.mark.parametrize("words", [*IN, *FREE])
def test_a_permission_is_a_fence_and_no_zone(words: dict[str, Any], tmp_path: Path) -> None:
    """By itself among zones it is refused, since what it says would be lost; a fence may have it."""
    assert fence_of(tmp_path, [(SQUARE, words)])[0].airspace.geofence_m is not None
    write_geojson(tmp_path / "z.geojson", [(SQUARE, words)])
    require_refusal(tmp_path, "z.geojson", "an area to stay in" if words in IN else "nothing in it is a zone")


@pytest.mark.parametrize("words", FREE)
def test_where_flying_is_allowed_is_counted_among_zones(words: dict[str, Any], tmp_path: Path) -> None:
    """It forbids nothing, and is not lost in silence."""
    scenario, notes = zones(tmp_path, [(POND, {"type": "PROHIBITED"}), (SQUARE, words)])
    require_kept_out(scenario, in_metres(POND))
    assert notes == ["z.geojson: zones: 1 of 1 in reach (1 polygon); passed over: 1 permission"]


def test_a_fence_among_zones_needs_a_fence(tmp_path: Path) -> None:
    """A file that holds both is named in both keys: its zones are there once, its fence is the fence."""
    features = [(SQUARE, {"inclusion": True}), (POND, {"inclusion": False, "ceiling": 40})]
    scenario, notes = fence_of(tmp_path, features)
    require_kept_out(scenario, in_metres(POND))
    assert notes == [
        "f.geojson: zones: 1 of 1 in reach (1 polygon)",
        'f.geojson: "features[1]" counts at all altitudes; not read: ceiling',
    ]
    both = 'altitude_m = [10.0, 120.0]\ngeofence_from = "f.geojson"\nno_fly_from = "f.geojson"'
    notes.clear()
    airspace = load(scene(tmp_path, both), on_note=notes.append).airspace
    assert (airspace.geofence_m, airspace.no_fly) == (scenario.airspace.geofence_m, scenario.airspace.no_fly)
    assert any("passed over: 1 fence" in note for note in notes)
    write_geojson(tmp_path / "z.geojson", features)
    require_refusal(tmp_path, "z.geojson", "name its file in geofence_from")


@pytest.mark.parametrize("words", UNKNOWN)
def test_a_word_that_is_not_known_is_named(words: dict[str, Any], tmp_path: Path) -> None:
    """It changes nothing: an area of zones forbids, that of a fence allows."""
    ((key, value),) = words.items()
    named = f"not known to allow or to forbid: {key} = {value}"
    scenario, notes = zones(tmp_path, [(SQUARE, words), (POND, words)])
    assert len(scenario.airspace.no_fly) == 2
    assert notes[0].endswith(named)
    assert fence_of(tmp_path, [(SQUARE, words)])[1] == [f"f.geojson: fence: 1 polygon; {named}"]


def test_words_that_contradict_each_other_are_refused(tmp_path: Path) -> None:
    """Neither is taken for the truth."""
    write_geojson(tmp_path / "z.geojson", [(SQUARE, {"inclusion": True, "restriction": "PROHIBITED"})])
    require_refusal(
        tmp_path, "z.geojson", "inclusion = True and restriction = PROHIBITED contradict each other"
    )


def test_what_a_feature_states_beside_its_properties_counts(tmp_path: Path) -> None:
    """Some programs write members of their own there."""
    member = {
        "type": "Feature",
        "inclusion": True,
        "properties": {},
        "geometry": shapely.geometry.mapping(SQUARE),
    }
    text = json.dumps(member)
    (tmp_path / "z.geojson").write_text(text, encoding="utf-8")
    with pytest.raises(ScenarioError, match="inclusion = True"):
        zones_of(tmp_path, "z.geojson")
