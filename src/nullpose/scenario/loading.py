"""From a file to a scenario."""

from __future__ import annotations

import logging
import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path, PurePath
from typing import Any

import numpy as np

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario.antenna import with_harmonics
from nullpose.scenario.area_files import REACH_M, with_fence, with_zones
from nullpose.scenario.faults import ONLY_LOCAL, Raw, RawTable, refusal
from nullpose.scenario.geo_file import ENDINGS, MOST_BYTES, Feature, features_of
from nullpose.scenario.node_files import ListedNode, nodes_of_csv, nodes_of_features
from nullpose.scenario.overrides import Override, apply_overrides, overridden
from nullpose.scenario.scenario import Scenario
from nullpose.scenario.toml_file import (
    FileKind,
    file_content,
    file_text,
    tables_of,
    uploaded_text,
)
from nullpose.scenario.wording import described

_NODES_KEY, _FENCE_KEY, _ZONES_KEY = "nodes_from", "geofence_from", "no_fly_from"
_NODES_FILE = FileKind("a file of nodes", "nodes.geojson", (*ENDINGS, ".csv"))
_AREA_FILE = FileKind("a file of areas", "zones.geojson", ENDINGS)
_EARLY = re.compile(r"origin\b|airspace\.(?!no_fly\b)|nodes_from\b")
_FENCES = {"geofence_m", "geofence_lat_lon_deg"}
_STEP = re.compile(r"(?=[.\[])")
_MEMBER = re.compile(r"[\w.]+\[\d+\]")
_LOG = logging.getLogger("nullpose")


def load(
    path: str | os.PathLike[str],
    *,
    allow_outside: bool = False,
    overrides: Iterable[str | Override] = (),
    on_note: Callable[[str], object] = _LOG.warning,
) -> Scenario:
    """Read the scenario that a TOML file describes, with what it takes from the files that it names.

    Args:
        path: the file, of 10 MB at most.
        allow_outside: whether the files that it names may be outside its folder.
        overrides: changes such as ``jammers.M.power_w=10``. Those of ``nodes_from``,
            ``airspace.geofence_from`` and ``airspace.no_fly_from`` name files, relative to this one's folder;
            zones are cut to the airspace with its changes.
        on_note: is called with what became of the features of the files, a line each.

    Raises:
        ScenarioError: when a file cannot be read or is faulty; with every fault it has.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> scenario.node_names, scenario.jammers[0].power_w
        (('S1', 'S2'), 1.0)
    """
    source = os.fspath(path)
    files = _NamedFiles(Path(source).parent, allow_outside, on_note)
    try:
        tables, late = _overridden_tables(Path(source), overrides)
        scenario = files.scenario(tables)
    except (RecursionError, OverflowError):
        raise refusal(
            "", "it is nested too deeply to be read, or has a number beyond 1e308", source
        ) from None
    except ScenarioError as error:
        raise ScenarioError(error.faults, error.source or source) from None
    return apply_overrides(scenario, late)


def _overridden_tables(
    path: Path, overrides: Iterable[str | Override]
) -> tuple[RawTable, list[str | Override]]:
    """Read a file's tables, with those changes that decide which files are read and what of them counts.

    Returns:
        The tables, and the changes that are left for the scenario.
    """
    tables, late = tables_of(file_text(path)), list(overrides)
    early = [change for change in late if _EARLY.match(str(change).strip())]
    names_files = any(_named_files(tables).values()) or any(
        "_from" in str(change).split("=")[0] for change in early
    )
    if not early or not names_files:
        return tables, late
    return overridden(tables, early), [change for change in late if change not in early]


def _named_files(tables: Raw) -> RawTable:
    """Pick the names of the files of nodes, fence and zones, by key."""
    airspace = tables.get("airspace")
    airspace = airspace if isinstance(airspace, Mapping) else {}
    return {_NODES_KEY: tables.get(_NODES_KEY)} | {
        f"airspace.{key}": airspace.get(key) for key in (_FENCE_KEY, _ZONES_KEY)
    }


def files_of(path: Path, overrides: Iterable[str | Override] = ()) -> dict[str, Path]:
    """Return the files that a scenario is read from, by what to call them.

    Args:
        path: of a scenario file that loads.
        overrides: its changes.
    """
    tables, _ = _overridden_tables(path, overrides)
    files = _named_files(tables) | {"antenna.file": tables.get("antenna", {}).get("file")}
    return {"the scenario": path} | {key: path.parent / file for key, file in files.items() if file}


def scenario_from_text(content: bytes, name: str) -> Scenario:
    """Read the scenario that an upload describes, which may name no other file.

    Args:
        content: the file's bytes, 10 MB at most.
        name: what to call the file in messages.

    Raises:
        ScenarioError: with every fault of the content.
    """
    try:
        tables = tables_of(uploaded_text(content))
        if _NODES_KEY in tables:
            raise refusal(_NODES_KEY, f"{ONLY_LOCAL}; list the nodes here, under [[nodes]]")
        return Scenario.from_dict(tables)
    except ScenarioError as error:
        raise ScenarioError(error.faults, name) from None


def inside(folder: Path, file: str, allow_outside: bool, place: str = "") -> Path:
    """Locate a file that another one names.

    Args:
        folder: of the file that names it.
        file: as it is named.
        allow_outside: whether it may be anywhere.
        place: where it is named, for messages.

    Raises:
        ScenarioError: it is, through links or not, neither in that folder nor below it.
    """
    # A null character, which no path may hold, is told of when the file is read.
    real, root = os.path.realpath(folder / file.replace("\0", "")), os.path.realpath(folder)
    if not allow_outside and not Path(real).is_relative_to(root):
        raise refusal(
            place,
            f"got {described(file)}, which is outside the folder of the file that names it; put it there, or "
            "allow this by --allow-outside (in Python allow_outside=True)",
        )
    return folder / file


class _NamedFiles:
    """The files that a scenario file names, and where in them the parts of the scenario stand."""

    def __init__(self, folder: Path, allow_outside: bool, on_note: Callable[[str], object]) -> None:
        self._folder, self._allow_outside, self._on_note = folder, allow_outside, on_note
        self._faults: list[Fault] = []
        self._places: dict[str, str] = {}  # in the files, of tables and values by their path in the scenario

    def scenario(self, tables: RawTable) -> Scenario:
        """Read the scenario of raw tables, and refuse it with the faults of all files.

        Raises:
            ScenarioError: with its faults.
        """
        has_zones = _named_files(tables)[f"airspace.{_ZONES_KEY}"] is not None
        if "antenna" in tables:
            tables |= {"antenna": self._antenna(tables["antenna"])}
        if "airspace" in tables:
            tables |= {"airspace": self._airspace(tables["airspace"], tables.get("origin"))}
        if _NODES_KEY in tables and "nodes" not in tables:
            # The nodes take the place of the key, so that faults come in the order of the file.
            tables = {("nodes" if key == _NODES_KEY else key): value for key, value in tables.items()}
            tables["nodes"] = self._nodes(tables["nodes"])
        try:
            scenario = Scenario.from_dict(tables)
        except ScenarioError as error:
            # Nodes that could not be read are not told as missing too.
            repeated = "nodes" if self._faults and tables.get("nodes") == [] else None
            self._faults += [self._placed(fault) for fault in error.faults if fault.path != repeated]
        if self._faults:
            raise ScenarioError(self._faults)
        if has_zones:
            _require_nodes_in_reach(scenario)
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
    def _reading(self, label: str) -> Iterator[None]:
        """Collect the faults of a file, in whose place the rest of the scenario is judged without it."""
        try:
            yield
        except ScenarioError as error:
            self._faults += [_in_file(label, fault) for fault in error.faults]

    def _path(self, file: object, kind: FileKind, place: str = "") -> Path:
        if not isinstance(file, str) or not file.strip():
            raise refusal(
                place, f'got {described(file)}, must be the name of {kind.noun}, as in "{kind.usual_name}"'
            )
        if PurePath(file).suffix.lower() not in kind.endings:
            raise refusal("", f"the name must end in one of {', '.join(kind.endings)}, which tells the kind")
        return inside(self._folder, file, self._allow_outside, place)

    def _features(self, path: Path, kind: FileKind, place: str = "") -> list[Feature]:
        return features_of(file_content(path, kind, self._folder, place, MOST_BYTES), path)

    def _antenna(self, antenna: Any) -> Any:
        """Fill in what the file of an antenna holds."""
        file = antenna.get("file") if isinstance(antenna, dict) else None
        if not isinstance(file, str) or "harmonics" in antenna:
            return antenna
        with self._reading(f"antenna.file: {file}"):
            return with_harmonics(antenna, inside(self._folder, file, self._allow_outside))
        return antenna | {"harmonics": [[1.0]]}

    def _airspace(self, airspace: Any, origin: object) -> Any:
        """Fill in the fence and the zones of other files."""
        if not isinstance(airspace, dict) or not isinstance(airspace.get("no_fly", []), list):
            return airspace
        for key, fill in ((_FENCE_KEY, with_fence), (_ZONES_KEY, with_zones)):
            if key not in airspace or (fill is with_fence and _FENCES & airspace.keys()):
                continue
            file, label = airspace[key], f"airspace.{key}: {airspace[key]}"
            airspace = {other: value for other, value in airspace.items() if other != key}
            with self._reading(label):
                features = self._features(self._path(file, _AREA_FILE), _AREA_FILE)
                airspace, notes, places = fill(airspace, features, origin)
                for note in notes:
                    self._on_note(f"{file}: {note}")
                self._places |= {path: f"{label}: {place}" for path, place in places.items()}
        return airspace

    def _nodes(self, file: object) -> list[Raw]:
        """Read the nodes that another file lists."""
        nodes: list[ListedNode] = []
        unread: list[Fault] = []  # of nodes
        with self._reading(f"{file}"):
            path = self._path(file, _NODES_FILE, _NODES_KEY)
            if path.suffix.lower() == ".csv":
                nodes += nodes_of_csv(file_text(path, _NODES_FILE, self._folder, _NODES_KEY), unread)
            else:
                features = self._features(path, _NODES_FILE, _NODES_KEY)
                nodes += nodes_of_features(features, unread, lambda note: self._on_note(f"{file}: {note}"))
        self._faults += [_in_file(file, fault) for fault in unread]
        for index, node in enumerate(nodes):
            for key, place in node.places.items():
                self._places[f"nodes[{index}].{key}".removesuffix(".")] = f"{file}: {place}"
        return [node.values for node in nodes]


def _require_nodes_in_reach(scenario: Scenario) -> None:
    """Refuse a node near which zones of a file would not count."""
    for name, node in zip(scenario.node_names, scenario.nodes, strict=True):
        away_m = float(np.abs(np.asarray(node.position_m)[:2]).max())
        if away_m > REACH_M:
            raise refusal(
                f"airspace.{_ZONES_KEY}",
                f"its zones count up to {REACH_M / 1e3:g} km east, west, north and south of the origin, and "
                f"node {name} is {away_m / 1e3:.0f} km away; move [origin] to the nodes",
            )


def _in_file(label: object, fault: Fault) -> Fault:
    if fault.path == _NODES_KEY:  # which stands in the scenario's own file
        return fault
    return Fault(f"{label}: {fault.path}" if fault.path else f"{label}", fault.message)
