"""The files that a scenario file names: nodes, fence, zones, buildings and the antenna's pattern."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import cache, partial
from pathlib import Path, PurePath
from typing import TypeAlias, TypeVar

import numpy as np

from nullpose.antenna.from_file import with_profile
from nullpose.errors import Fault, ScenarioError
from nullpose.files import PlainTable
from nullpose.scenario.antenna import with_harmonics
from nullpose.scenario.area_files import FENCES, REACH_M, Filled, with_fence, with_zones
from nullpose.scenario.building_files import buildings_of
from nullpose.scenario.buildings import Building
from nullpose.scenario.faults import described, raise_all, refusal, require
from nullpose.scenario.geo_file import ENDINGS, MOST_BYTES, Feature, features_of
from nullpose.scenario.geo_json import HOME
from nullpose.scenario.ground_points import ALIKE
from nullpose.scenario.node_files import nodes_of_csv, nodes_of_features
from nullpose.scenario.origin import POINT_LISTS, Origin
from nullpose.scenario.scenario import Scenario
from nullpose.scenario.toml_file import FileKind, file_content, file_text, inside
from nullpose.scenario.track import MOTION
from nullpose.scenario.track_files import TRACK_ENDINGS, track_of

_NODES_KEY, _FENCE_KEY, _ZONES_KEY = "nodes_from", "geofence_from", "no_fly_from"
_BUILDINGS_KEY, _TRACK_KEY = "buildings_from", "track_from"
_NODES_FILE = FileKind("a file of nodes", "nodes.geojson", (*ENDINGS, ".csv"))
_TRACK_FILE = FileKind("a file of a track", "drone.csv", TRACK_ENDINGS)
_AREA_FILE = FileKind("a file of areas", "zones.geojson", (*ENDINGS, ".plan"))
_STEP = re.compile(r"(?=[.\[])")
_MEMBER = re.compile(r"[\w.]+\[\d+\]")
_Found = TypeVar("_Found")
_Read: TypeAlias = tuple[PlainTable, tuple[str, ...]]


class NamedFiles:
    """The files that a scenario file names, and where in them the parts of the scenario stand."""

    def __init__(self, folder: Path, allow_outside: bool, on_note: Callable[[str], object]) -> None:
        self._folder, self._allow_outside = folder, allow_outside
        self._on_note = cache(on_note)  # once of a file that several name
        self._faults: list[Fault] = []
        self._keys: list[str] = []  # that name files of zones and buildings
        self._places: dict[str, str] = {}  # in the files, of tables and values by their path in the scenario

    def scenario(self, tables: PlainTable) -> Scenario:
        """Read the scenario of raw tables, and refuse it with the faults of all files.

        Raises:
            ScenarioError: with its faults.
        """
        origin = origin if isinstance(origin := tables.get("origin"), dict) else {}
        if "antenna" in tables:
            antenna = self._with_file(
                tables["antenna"], "antenna", "file", "harmonics", with_harmonics, [[1.0]]
            )
            tables |= {"antenna": antenna}
        airspace = tables.get("airspace")
        if isinstance(airspace, dict) and isinstance(airspace.get("no_fly", []), list):
            if "origin" not in tables and (origin := self._home(airspace)):
                tables |= {"origin": origin}
            tables |= {"airspace": self._airspace(airspace, Origin._sound_part(origin))}
        if isinstance(buildings := tables.get("buildings"), list):
            tables |= {"buildings": self._buildings(buildings, Origin._sound_part(origin))}
        if _NODES_KEY in tables and "nodes" not in tables:
            # The nodes take the place of the key, so that faults come in the order of the file.
            tables = {("nodes" if key == _NODES_KEY else key): value for key, value in tables.items()}
            tables["nodes"] = self._nodes(tables["nodes"])
        failures = len(self._faults)
        tables |= _each_point(tables, self._with_track)
        if len(self._faults) > failures:
            raise_all(self._faults)  # nothing else is known of such a point
        with_profiles = partial(
            self._with_file, key="antenna_file", product="antenna_profile", read=with_profile, instead=ALIKE
        )
        tables |= _each_point(tables, with_profiles)
        try:
            scenario = Scenario.from_dict(tables)
        except ScenarioError as error:
            # Nodes that could not be read are not told as missing too.
            repeated = "nodes" if self._faults and tables.get("nodes") == [] else None
            self._faults += [self._placed(fault) for fault in error.faults if fault.path != repeated]
        raise_all(self._faults)
        for key in self._keys[:1]:
            _require_nodes_in_reach(scenario, key)
        return scenario

    def _placed(self, fault: Fault) -> Fault:
        """Give a scenario's fault its place in the file that the value is from."""
        message = _MEMBER.sub(lambda member: self._places.get(member[0], member[0]), fault.message)
        steps = _STEP.split(fault.path)
        for count in range(len(steps), 0, -1):
            if place := self._places.get("".join(steps[:count])):
                return Fault("".join([place, *steps[count:]]), message)
        return Fault(fault.path, message)

    @contextmanager
    def _reading(self, label: str, joint: str = ": ") -> Iterator[None]:
        """Collect the faults of a file, in whose place the rest of the scenario is judged without it."""
        try:
            yield
        except ScenarioError as error:
            self._faults += [_in_file(label, fault, joint) for fault in error.faults]

    def _path(self, file: object, kind: FileKind, place: str = "") -> Path:
        if not isinstance(file, str) or not file.strip():
            raise refusal(
                place, f'got {described(file)}, must be the name of {kind.noun}, as in "{kind.usual_name}"'
            )
        require(
            PurePath(file).suffix.lower() in kind.endings,
            "",
            f"the name must end in one of {', '.join(kind.endings)}, which tells the kind; convert others, "
            "as QGIS and ogr2ogr do",
        )
        return inside(self._folder, file, self._allow_outside, place)

    def _features(self, path: Path, kind: FileKind, place: str = "") -> list[Feature]:
        return features_of(file_content(path, kind, self._folder, place, MOST_BYTES), path)

    def _with_file(
        self, table: object, place: str, key: str, product: str, read: Callable[..., _Read], instead: object
    ) -> object:
        """Fill in what the file of an antenna holds.

        Args:
            table: the raw antenna, or ground point.
            place: its path.
            key: that names the file.
            product: the key for what the file holds.
            read: from the table and the path of the file to the table filled in, and notes.
            instead: what stands for what cannot be read.
        """
        if not isinstance(table, dict) or not isinstance(file := table.get(key), str) or product in table:
            return table
        with self._reading(f"{place}.{key}: {file}"):
            filled, notes = read(table, inside(self._folder, file, self._allow_outside))
            self._note(file, notes)
            return filled
        return table | {product: instead}

    def _with_track(self, table: object, place: str) -> object:
        """Put the track of a file in place of the key of a raw point that names it."""
        if not isinstance(table, dict) or MOTION.taken(table) != [(_TRACK_KEY,)]:
            return table
        rest = {key: value for key, value in table.items() if key != _TRACK_KEY}
        label = f"{place}.{_TRACK_KEY}: {table[_TRACK_KEY]}"
        with self._reading(label):
            path = self._path(table[_TRACK_KEY], _TRACK_FILE)
            track = track_of(path, file_content(path, _TRACK_FILE, self._folder))
            self._places |= {f"{place}.track": label} | {
                f"{place}.{key}": f"{label}: {where}"
                for key, where in track.places.items()
                if key not in rest
            }
            return rest | track.beside(rest)
        return rest

    def _filled(
        self, key: str, file: object, fill: Callable[[list[Feature]], Filled[_Found]]
    ) -> _Found | None:
        """Read the keys that a file of areas fills in, and tell what became of it; None where it is at fault.

        Args:
            key: where it is named.
            file: its name.
            fill: from its features to what they fill in, notes, and their places by path in the scenario.
        """
        with self._reading(f"{key}: {file}"):
            found, notes, places = fill(self._features(self._path(file, _AREA_FILE), _AREA_FILE))
            self._note(file, notes)
            self._places |= {path: f"{key}: {file}: {place}" for path, place in places.items()}
            return found
        return None

    def _note(self, file: object, notes: Iterable[str]) -> None:
        for note in notes:
            self._on_note(f"{file}: {note}")

    def _home(self, airspace: PlainTable) -> PlainTable:
        """Return the home of a plan that holds the areas, as an origin; nothing without one."""
        plans = [
            name for key in (_FENCE_KEY, _ZONES_KEY) if (name := str(airspace.get(key))).endswith(".plan")
        ]
        for plan in plans[:1]:
            with suppress(ScenarioError):  # which is told where the areas are read
                features = self._features(self._path(plan, _AREA_FILE), _AREA_FILE)
                homes = [each.properties["origin"] for each in features if each.place == HOME]
                self._note(plan, [f"its home is the origin: {home}" for home in homes])
                return dict(*homes)
        return {}

    def _airspace(self, airspace: PlainTable, origin: Origin) -> PlainTable:
        """Fill in the fence and the zones of other files."""
        for key, fill in ((_FENCE_KEY, with_fence), (_ZONES_KEY, with_zones)):
            if key in airspace and not (key == _FENCE_KEY and FENCES & airspace.keys()):
                rest = {other: value for other, value in airspace.items() if other != key}
                whole = partial(fill, airspace=rest, origin=origin)
                self._keys += [f"airspace.{key}"] * (key == _ZONES_KEY)
                airspace = self._filled(f"airspace.{key}", airspace[key], whole) or rest
        return airspace

    def _buildings(self, tables: list[object], origin: Origin) -> list[object]:
        """Put the buildings of other files in place of the tables that name these."""
        whole: list[object] = []
        names = {str(table.get("name")) for table in tables if isinstance(table, dict)}
        for index, table in enumerate(tables):
            place = f"buildings[{index}]"
            if not isinstance(table, dict) or _BUILDINGS_KEY not in table:
                self._places[f"buildings[{len(whole)}]"] = place
                whole.append(table)
            else:
                self._keys.append(f"{place}.{_BUILDINGS_KEY}")
                with self._reading(place, "."):
                    rules = Building.from_dict(table)
                    fill = partial(buildings_of, rules=rules, origin=origin, names=names, first=len(whole))
                    whole += self._filled(self._keys[-1], rules.buildings_from, fill) or []
        return whole

    def _nodes(self, file: object) -> list[PlainTable]:
        """Read the nodes that another file lists."""
        with self._reading(f"{file}"):
            path = self._path(file, _NODES_FILE, _NODES_KEY)
            nodes, unread, notes = (
                nodes_of_csv(file_text(path, _NODES_FILE, self._folder, _NODES_KEY))
                if path.suffix.lower() == ".csv"
                else nodes_of_features(self._features(path, _NODES_FILE, _NODES_KEY))
            )
            self._note(file, notes)
            self._faults += [_in_file(file, fault) for fault in unread]
            for index, node in enumerate(nodes):
                for key, place in node.places.items():
                    self._places[f"nodes[{index}].{key}".removesuffix(".")] = f"{file}: {place}"
            return [node.values for node in nodes]
        return []


def _each_point(tables: PlainTable, read: Callable[[object, str], object]) -> PlainTable:
    """Return the points of a raw scenario, each as read, with its place for messages."""
    kinds = {kind: tables[kind] for kind in (*POINT_LISTS, "destination") if kind in tables}
    return {
        kind: [read(each, f"{kind}[{index}]") for index, each in enumerate(points)]
        if isinstance(points, list)
        else read(points, kind)
        for kind, points in kinds.items()
    }


def _require_nodes_in_reach(scenario: Scenario, key: str) -> None:
    """Refuse a node near which zones or buildings of a file would not count."""
    nouns = "zones" if key.endswith(_ZONES_KEY) else "buildings"
    for name, node in zip(scenario.node_names, scenario.nodes, strict=True):
        away_m = float(np.abs(np.asarray(node.position_m)[:2]).max())
        require(
            away_m <= REACH_M,
            key,
            f"its {nouns} count up to {REACH_M / 1e3:g} km east, west, north and south of the origin, "
            f"and node {name} is {away_m / 1e3:.0f} km away; move [origin] to the nodes",
        )


def _in_file(label: object, fault: Fault, joint: str = ": ") -> Fault:
    if fault.path == _NODES_KEY:  # which stands in the scenario's own file
        return fault
    return Fault(f"{label}{joint}{fault.path}" if fault.path else f"{label}", fault.message)
