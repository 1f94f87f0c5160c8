"""Files of tracks: CSV, a line for each row, a GeoJSON LineString with times, and GPX."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

import shapely

from nullpose.files import PlainTable
from nullpose.scenario.faults import described, refusal, require
from nullpose.scenario.geo_file import features_of
from nullpose.scenario.kml import root_of
from nullpose.scenario.node_files import LOCAL, cells_of_row, number_of, table_of_csv
from nullpose.scenario.shapes import parts_of
from nullpose.scenario.toml_file import decoded
from nullpose.scenario.track import place_of_start
from nullpose.scenario.units import ALTITUDE_KEYS, GEODETIC_KEYS, PLACE_KEYS

TRACK_ENDINGS = (".csv", ".geojson", ".json", ".gpx")
"""How the names of files of tracks end."""
_COLUMNS = ("t_s", *LOCAL, *GEODETIC_KEYS, *ALTITUDE_KEYS[1:])
_SHORT = {"t": "t_s", "x": "x_m", "y": "y_m", "z": "z_m", "lat": "lat_deg", "lon": "lon_deg", "alt": "alt_m"}
_TIMES = ("coordTimes", "times")


class ListedTrack(NamedTuple):
    """A raw track, and where its numbers stand in its file.

    Args:
        keys: that state the place of a row: x_m, y_m and z_m, or lat_deg, lon_deg and an altitude.
        rows: as a scenario file would state them.
        places: by their path below the point, such as ``track[3][1]``.
    """

    keys: Sequence[str]
    rows: list[list[object]]
    places: Mapping[str, str]

    def beside(self, table: PlainTable) -> PlainTable:
        """List the keys that the track adds to a raw point: itself, and the place of its start at t = 0.

        Raises:
            ScenarioError: the point states its place in another way.
        """
        places, keys = table.keys() & PLACE_KEYS, self.keys if self.keys[0] != LOCAL[0] else ()
        require(
            not places or places - {"position_m"} == set(keys),
            "",
            f"its places are by {', '.join(self.keys)}, but the place beside it is by "
            f"{', '.join(sorted(places))}; state both in one way, or remove the place",
        )
        track: PlainTable = {"track": self.rows}
        if places or (place := place_of_start(track)) is None:
            return track
        return track | (dict(zip(keys, place, strict=True)) if keys else {"position_m": place})


def track_of(path: Path, content: bytes) -> ListedTrack:
    """Read the track that a file holds.

    Args:
        path: whose ending tells the format, one of ``TRACK_ENDINGS``.
        content: of the file.

    Raises:
        ScenarioError: it holds none, or more than one.
    """
    read = {".csv": _track_of_csv, ".gpx": _track_of_gpx}.get(path.suffix.lower())
    return _track_of_geojson(content, path) if read is None else read(content)


def _track_of_csv(content: bytes) -> ListedTrack:
    header, lines = table_of_csv(decoded(content), _COLUMNS, _SHORT)
    require("t_s" in header, "line 1", 'the column "t" is missing, must have the times in seconds; add it')
    require(lines, "", "there is no line below the header, must be one for each time")
    keys = [key for key in _COLUMNS if key in header]
    for line, row in lines:
        require(any(row), f"line {line}", "the row is empty, a gap in the track; fill it in, or remove it")
    wheres = [f"line {line}" for line, _ in lines]
    cells = [cells_of_row(where, header, row) for where, (_, row) in zip(wheres, lines, strict=True)]
    names = [[f"{where}, column {key}" for key in keys] for where in wheres]
    return _track(keys[1:], [[row[key] for key in keys] for row in cells], names, wheres)


def _track_of_geojson(content: bytes, path: Path) -> ListedTrack:
    found = [(each, part) for each in features_of(content, path) for part in parts_of(each.geometry)]
    lines = [(each, part) for each, part in found if part.geom_type == "LineString"]
    require(len(lines) == 1, "", f"it has {len(lines)} lines, must have one LineString, the track")
    feature, line = lines[0]
    require(line.has_z, f"{feature.place}.geometry", "there are no altitudes; add them to the coordinates")
    corners = shapely.get_coordinates(line, include_z=True).tolist()
    key = next((key for key in _TIMES if key in feature.properties), _TIMES[0])
    times, place = feature.properties.get(key), f"{feature.place}.properties.{key}"
    if not isinstance(times, list) or len(times) != len(corners):
        must = f"must be a list of {len(corners)} times, one for each of the coordinates"
        raise refusal(place, f"got {described(times)}, {must}")
    times_s = _seconds(times, [f"{place}[{index}]" for index in range(len(times))])
    rows = [[t_s, lat, lon, alt] for t_s, (lon, lat, alt) in zip(times_s, corners, strict=True)]
    wheres = [f"{feature.place}.geometry.coordinates[{index}]" for index in range(len(rows))]
    names = [[f"{place}[{i}]", *(f"{where}[{axis}]" for axis in (1, 0, 2))] for i, where in enumerate(wheres)]
    return _track(GEODETIC_KEYS, rows, names, wheres)


def _track_of_gpx(content: bytes) -> ListedTrack:
    segments = root_of(content, "gpx").findall(".//{*}trkseg")
    require(
        len(segments) == 1, "", f"it has {len(segments)} track segments (trkseg), must be one; join or remove"
    )
    points = segments[0].findall("{*}trkpt")
    wheres = [f"trkpt[{index}]" for index in range(len(points))]
    times_s = _seconds([each.findtext("{*}time", "") for each in points], [f"{each}.time" for each in wheres])
    texts = [(each.get("lat", ""), each.get("lon", ""), each.findtext("{*}ele", "")) for each in points]
    rows = [[t_s, *map(number_of, each)] for t_s, each in zip(times_s, texts, strict=True)]
    names = [[f"{where}.{key}" for key in ("time", "lat", "lon", "ele")] for where in wheres]
    return _track(("lat_deg", "lon_deg", "alt_msl_m"), rows, names, wheres)


def _track(
    keys: Sequence[str], rows: list[list[object]], names: list[list[str]], wheres: list[str]
) -> ListedTrack:
    places = {
        **{f"track[{i}][{j}]": name for i, row in enumerate(names) for j, name in enumerate(row)},
        **{f"track[{i}]": where for i, where in enumerate(wheres)},
        **(dict.fromkeys(PLACE_KEYS, wheres[0]) if rows else {}),
    }
    return ListedTrack(keys, rows, places)


def _seconds(times: Sequence[object], wheres: Sequence[str]) -> list[object]:
    """Return times as they are, or of dates the seconds since the first."""
    if not any(isinstance(each, str) for each in times):
        return [*times]
    moments = []
    for text, where in zip(times, wheres, strict=True):
        try:
            moment = datetime.fromisoformat(str(text).strip())
        except ValueError:
            raise refusal(
                where, f"got {described(text)}, must be a date and time as 2026-05-01T12:00:00Z"
            ) from None
        moments.append(moment if moment.tzinfo else moment.replace(tzinfo=UTC))
        require(
            moments[-1] >= moments[0],
            where,
            f'"{text}" is before the first time, must be later: a track goes forward in time; sort it',
        )
    return [(moment - moments[0]).total_seconds() for moment in moments]
