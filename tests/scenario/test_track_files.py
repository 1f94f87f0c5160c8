"""Tracks in files of their own: each format states the same motion, and every fault is told at its line."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nullpose.scenario import Scenario, load
from scenes import load_faults

SCENE = """\
[time]
duration_s = 60.0
step_s = 1.0
[airspace]
altitude_m = [8.0, 30.0]
[receiver]
noise_w = 1e-3
reference_gain_db = 0.0
[[nodes]]
{node}
power_w = 1.0
[[jammers]]
name = "M"
power_w = 1.0
{place}
{motion}
"""
ON_EARTH = "lat_deg = 50.0\nlon_deg = 14.5\nalt_m = 230.0\n"
ORIGIN = f"[origin]\n{ON_EARTH}alt_msl_m = 185.0\n"
ROWS = [[0.0, 50.001, 14.501, 232.0], [30.0, 50.002, 14.501, 232.0], [60.0, 50.002, 14.502, 240.0]]
DATES = ["2026-05-01T12:00:00Z", "2026-05-01T14:00:30+02:00", "2026-05-01T12:01:00"]
METRES = [[0.0, 1.0, 2.0, 3.0], [30.0, 4.0, 5.0, 6.0], [60.0, 7.0, 8.0, 9.0]]


def csv_text(header: str, rows: list[list[Any]]) -> str:
    """Return the text of a CSV file."""
    return "\n".join([header, *(",".join(map(str, row)) for row in rows)]) + "\n"


def geojson(times: object = (0.0, 30.0, 60.0), key: str = "times", rows: Any = ROWS, **line: Any) -> str:
    """Return the text of a GeoJSON file with one feature."""
    shape = {"type": "LineString", "coordinates": [[lon, lat, alt] for _, lat, lon, alt in rows]} | line
    feature = {"type": "Feature", "geometry": shape, "properties": {key: times}}
    return json.dumps({"type": "FeatureCollection", "features": [feature]})


def gpx(rows: Any = ROWS, dates: Any = DATES, segments: int = 1) -> str:
    """Return the text of a GPX file, whose altitudes are over the sea."""
    points = "".join(
        f'<trkpt lat="{lat}" lon="{lon}">'
        + ("" if alt is None else f"<ele>{alt - 45.0}</ele>")
        + f"<time>{date}</time></trkpt>"
        for (_, lat, lon, alt), date in zip(rows, dates, strict=True)
    )
    inside = f"<trkseg>{points}</trkseg>" * segments
    return f'<gpx xmlns="http://www.topografix.com/GPX/1/1"><trk>{inside}</trk></gpx>'


def written(folder: Path, file: str, content: str | None, *, place: str = "", is_local: bool = False) -> Path:
    """Write a scene whose jammer follows the track of a file; return its path."""
    if content is not None:
        (folder / file).write_text(content, encoding="utf-8")
    node = "position_m = [9.0, 9.0, 0.0]" if is_local else ON_EARTH
    scene = SCENE.format(node=node, place=place, motion=f'track_from = "{file}"')
    path = folder / "scene.toml"
    path.write_text(scene if is_local else ORIGIN + scene, encoding="utf-8")
    return path


def places_m(scene: Scenario) -> np.ndarray:
    """Return where the jammer is at some instants."""
    return np.array([scene.at(t_s).jammers[0].position_m for t_s in (0.0, 12.0, 30.0, 47.5, 60.0)])


@pytest.mark.parametrize(
    ("file", "content"),
    [
        ("drone.csv", csv_text("t,lat,lon,alt", ROWS)),
        ("drone.csv", csv_text("t_s, lat_deg, lon_deg, alt_m", ROWS) + "\n"),
        (
            "drone.csv",
            csv_text("alt_agl_m,lon,lat,t", [[alt - 230, lon, lat, t] for t, lat, lon, alt in ROWS]),
        ),
        ("drone.csv", csv_text("t,lat,lon,alt_msl_m", [[*row[:3], row[3] - 45.0] for row in ROWS])),
        ("drone.geojson", geojson()),
        ("drone.json", geojson(DATES, "coordTimes")),
        ("drone.gpx", gpx()),
    ],
)
def test_formats_state_the_same_motion(tmp_path: Path, file: str, content: str) -> None:
    """Whatever the file, the jammer is where the track in the scenario file itself leads it."""
    scene = load(written(tmp_path, file, content))
    inline = written(tmp_path, file, None)
    inline.write_text(inline.read_text().replace(f'track_from = "{file}"', f"track = {ROWS}"))
    assert places_m(scene) == pytest.approx(places_m(load(inline)), abs=1e-3)
    copy = tmp_path / "copy.toml"  # what is written names no file
    copy.write_text(scene.to_toml())
    assert load(copy) == scene


@pytest.mark.parametrize("place", ["", "position_m = [1.0, 2.0, 3.0]"])
@pytest.mark.parametrize("header", ["t,x,y,z", "t_s,x_m,y_m,z_m"])
def test_a_track_in_metres(tmp_path: Path, header: str, place: str) -> None:
    """It begins at the place beside it, or states it."""
    path = written(tmp_path, "drone.csv", csv_text(header, METRES), place=place, is_local=True)
    scene = load(path)
    assert places_m(scene)[[0, 2, 4]].tolist() == [row[1:] for row in METRES]
    (tmp_path / "other.csv").write_text(csv_text(header, [[60.0, 1.0, 2.0, 9.0]]))
    if place:
        other = load(path, overrides=["jammers.M.track_from=other.csv"])
        assert other.at(30.0).jammers[0].position_m == (1.0, 2.0, 6.0)


def _changed(index: int, axis: int, value: object, rows: list[list[float]] = METRES) -> list[list[Any]]:
    return [
        [value if (i, j) == (index, axis) else x for j, x in enumerate(row)] for i, row in enumerate(rows)
    ]


FAULTS = [
    (csv_text("t,x,y,z", _changed(1, 2, "nan")), "line 3, column y_m", "got NaN"),
    (csv_text("t,x,y,z", _changed(1, 2, "")), "line 3, column y_m", "got an empty text"),
    (csv_text("t,x,y,z", _changed(1, 0, "noon")), "line 3, column t_s", 'got the text "noon"'),
    (csv_text("t,x,y,z", [METRES[0], [4.0, 5.0], METRES[2]]), "line 3", "got 2 values, must be 4"),
    (csv_text("t,x,y,z", [METRES[0], ["", "", "", ""], METRES[2]]), "line 3", "a gap in the track"),
    (csv_text("t,x,y,z", [METRES[0], METRES[2], METRES[1]]), "line 4, column t_s", "must be later"),
    (csv_text("t,x,y,z", METRES[:2]), "line 3, column t_s", "must go on to duration_s = 60"),
    (csv_text("t,x,y,z", METRES[1:]), "line 2, column t_s", "state the place at t = 0 too"),
    (csv_text("x,y,z", [row[1:] for row in METRES]), "line 1", 'the column "t" is missing'),
    (csv_text("t,x,y", [row[:3] for row in METRES]), "line 1", "given without z_m"),
    (csv_text("t,x,y,z,speed", [[*row, 1] for row in METRES]), "line 1", "unknown column"),
    (csv_text("t,x,y,z", []), "", "no line below the header"),
    (csv_text("t,x,y,z", [[t_s, 1, 1, 1] for t_s in range(10_001)]), "", "more than 10000"),
    (csv_text("t,x,y,z", [[0, 9, 9, 0], METRES[2]]), "line 2", "the place of nodes[0] already"),
    ("", "line 1", "the file is empty"),
    (None, "", "there is no such file"),
]


@pytest.mark.parametrize(("content", "place", "words"), FAULTS)
def test_faults_in_a_table_have_their_line(
    tmp_path: Path, content: str | None, place: str, words: str
) -> None:
    """One message, with the file, the line and the column."""
    (fault,) = load_faults(written(tmp_path, "drone.csv", content, is_local=True))
    assert fault.path == ": ".join(filter(None, ["jammers[0].track_from", "drone.csv", place]))
    assert words in fault.message


LINE = "features[0].geometry"
EXCHANGED = [ROWS[0], ROWS[1], [60.0, 14.502, 50.002, 240.0]]


@pytest.mark.parametrize(
    ("file", "content", "place", "words"),
    [
        ("a.json", geojson(key="when"), "features[0].properties.coordTimes", "must be a list of 3 times"),
        ("a.json", geojson([0, 60]), "features[0].properties.times", "must be a list of 3 times"),
        ("a.json", geojson([0, None, 60]), "features[0].properties.times[1]", "got nothing"),
        ("a.json", geojson([0, DATES[0], 60]), "features[0].properties.times[0]", "must be a date and time"),
        ("a.json", geojson(DATES[::-1]), "features[0].properties.times[1]", "must be later"),
        ("a.json", geojson(rows=_changed(1, 3, float("nan"), ROWS)), f"{LINE}.coordinates[1][2]", "got NaN"),
        ("a.json", geojson(coordinates=[[14.5, 50.0]] * 3), LINE, "there are no altitudes"),
        ("a.json", geojson(type="Point", coordinates=[14.5, 50.0, 1.0]), "", "it has 0 lines"),
        ("a.json", geojson(rows=EXCHANGED), f"{LINE}.coordinates[2]", "latitude and longitude exchanged?"),
        ("a.gpx", gpx(segments=2), "", "it has 2 track segments"),
        ("a.gpx", gpx(dates=[DATES[0], "", DATES[2]]), "trkpt[1].time", "must be a date and time"),
        ("a.gpx", gpx(rows=_changed(1, 3, None, ROWS)), "trkpt[1].ele", "got an empty text"),
        ("a.gpx", gpx(rows=_changed(1, 1, "north", ROWS)), "trkpt[1].lat", 'got the text "north"'),
        ("a.gpx", gpx(rows=[], dates=[]), "", "got an empty list"),
        ("a.gpx", "a track", "", "this is not GPX"),
        ("a.kml", "", "", "the name must end in one of .csv, .geojson, .json, .gpx"),
    ],
)
def test_faults_in_geographic_files_have_their_place(
    tmp_path: Path, file: str, content: str, place: str, words: str
) -> None:
    """One message, with the file and the member of its track."""
    (fault,) = load_faults(written(tmp_path, file, content))
    assert fault.path == ": ".join(filter(None, ["jammers[0].track_from", file, place]))
    assert words in fault.message


def test_a_track_is_stated_as_the_place_beside_it(tmp_path: Path) -> None:
    """Places in degrees beside one in metres are refused, and the reverse."""
    beside = "position_m = [1.0, 2.0, 3.0]"
    (fault,) = load_faults(written(tmp_path, "a.json", geojson(), place=beside, is_local=True))
    assert "its places are by lat_deg, lon_deg, alt_m" in fault.message
    beside = "lat_deg = 50.001\nlon_deg = 14.501\nalt_agl_m = 2.0"
    (fault,) = load_faults(written(tmp_path, "a.csv", csv_text("t,x,y,z", METRES), place=beside))
    assert "its places are by x_m, y_m, z_m" in fault.message
    (fault,) = load_faults(written(tmp_path, "a.json", geojson(), place=beside))
    assert "is by alt_agl_m, lat_deg, lon_deg" in fault.message


def test_a_file_goes_with_no_other_motion(tmp_path: Path) -> None:
    """A point with a file of its track and a velocity or a track is refused for that alone."""
    for other in ("velocity_m_s = [1.0, 0.0, 0.0]", f"track = {METRES}"):
        place = f"position_m = [1.0, 2.0, 3.0]\n{other}"
        path = written(tmp_path, "drone.csv", csv_text("t,x,y,z", METRES), place=place, is_local=True)
        (fault,) = load_faults(path)
        assert fault.path == "jammers[0]"
        assert "track_from are given, at most one is allowed" in fault.message


def test_a_file_outside_the_folder_is_refused(tmp_path: Path) -> None:
    """As any file that a scenario names; unless that is allowed."""
    (tmp_path / "inner").mkdir()
    (tmp_path / "drone.csv").write_text(csv_text("t,x,y,z", METRES))
    path = written(tmp_path / "inner", "../drone.csv", None, is_local=True)
    (fault,) = load_faults(path)
    assert "outside the folder" in fault.message
    assert load(path, allow_outside=True).at(30.0).jammers[0].position_m == (4.0, 5.0, 6.0)
