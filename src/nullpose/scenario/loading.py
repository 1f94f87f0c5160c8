"""From a file to a scenario."""

from __future__ import annotations

import logging
import os
import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path, PurePath
from typing import Any

import numpy as np

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario.antenna import with_harmonics
from nullpose.scenario.area_files import REACH_M, with_fence, with_zones
from nullpose.scenario.faults import refusal
from nullpose.scenario.geo_file import ENDINGS, MOST_BYTES, features_of
from nullpose.scenario.listed_nodes import ListedNode, retold
from nullpose.scenario.nodes_csv import nodes_from_csv
from nullpose.scenario.nodes_of_features import nodes_of_features
from nullpose.scenario.overrides import Override, apply_overrides, overridden
from nullpose.scenario.scenario import Scenario
from nullpose.scenario.toml_file import FileKind, file_content, file_text, tables_of
from nullpose.scenario.wording import described

_KEY = "nodes_from"
_NODES_FILE = FileKind("a file of nodes", "nodes.geojson", (*ENDINGS, ".csv"))
_AREA_FILE = FileKind("a file of areas", "zones.geojson", ENDINGS)
_FENCES = ("geofence_m", "geofence_lat_lon_deg")
_FENCE_KEY, _ZONES_KEY = "geofence_from", "no_fly_from"
_FILE_KEYS = (_KEY, _FENCE_KEY, _ZONES_KEY)
_EARLY = re.compile(r"origin\b|airspace\.(?!no_fly\b)|nodes_from\b")
_LOG = logging.getLogger("nullpose")

_Note = Callable[[str], object]


def load(
    path: str | os.PathLike[str],
    *,
    allow_outside: bool = False,
    overrides: Iterable[str | Override] = (),
    on_note: _Note = _LOG.warning,
) -> Scenario:
    """Returns the scenario that a TOML file describes, with what it takes from the files that it names.

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
    origins: dict[str, str] = {}
    try:
        tables, late = _overridden_tables(Path(source), overrides)
        tables = _with_antenna_from(tables, Path(source).parent, allow_outside)
        airspace = tables.get("airspace")
        has_zones_from = isinstance(airspace, dict) and _ZONES_KEY in airspace
        tables, origins = _with_areas_from(tables, Path(source).parent, allow_outside, on_note)
        if _KEY in tables and "nodes" not in tables:
            found = _with_nodes_from(tables, Path(source).parent, allow_outside, on_note)
        else:
            found = Scenario.from_dict(tables)
        if has_zones_from:
            _require_nodes_in_reach(found)
    except ScenarioError as error:
        faults = [_from_file(fault, origins) for fault in error.faults]
        raise ScenarioError(faults, error.source or source) from None
    return apply_overrides(found, late)


def _overridden_tables(
    path: Path, overrides: Iterable[str | Override]
) -> tuple[dict[str, Any], list[str | Override]]:
    """Returns a file's tables with those changes that decide which files are read and what of them counts.

    Args:
        path: of the file.
        overrides: all changes.

    Returns:
        The tables, and the changes that are left for the scenario.
    """
    tables, late = tables_of(file_text(path)), list(overrides)
    early = [change for change in late if _EARLY.match(str(change).strip())]
    stated = tables.get("airspace")
    holders = [tables, stated if isinstance(stated, dict) else {}]
    named = any(key in holder for holder in holders for key in _FILE_KEYS)
    if not early or not (named or any("_from" in str(change).split("=")[0] for change in early)):
        return tables, late
    return overridden(tables, early), [change for change in late if change not in early]


def scenario_from_text(content: bytes, name: str) -> Scenario:
    """Returns the scenario that the content of a file describes, which may name no other file.

    Args:
        content: the file's bytes, 10 MB at most.
        name: what to call the file in messages.

    Raises:
        ScenarioError: with every fault of the content.
    """
    try:
        tables = tables_of(content)
        if _KEY in tables:
            raise refusal(
                _KEY, "only a file on this machine may name another; list the nodes here, under [[nodes]]"
            )
        return Scenario.from_dict(tables)
    except ScenarioError as error:
        raise ScenarioError(error.faults, name) from None


def files_of(path: Path, overrides: Iterable[str | Override] = ()) -> dict[str, Path]:
    """Returns the files that a scenario is read from, by what to call them.

    Args:
        path: of a scenario file that loads.
        overrides: its changes.
    """
    tables, _ = _overridden_tables(path, overrides)
    named = {_KEY: tables.get(_KEY), "antenna.file": tables.get("antenna", {}).get("file")}
    named |= {f"airspace.{key}": tables["airspace"].get(key) for key in (_FENCE_KEY, _ZONES_KEY)}
    return {"the scenario": path} | {key: path.parent / file for key, file in named.items() if file}


def inside(folder: Path, file: str, allow_outside: bool, place: str = "") -> Path:
    """Returns where a file is that another one names.

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


def _with_antenna_from(tables: dict[str, Any], folder: Path, allow_outside: bool) -> dict[str, Any]:
    """Returns the tables with what the file of an antenna holds."""
    antenna = tables.get("antenna")
    file = antenna.get("file") if isinstance(antenna, dict) else None
    if not isinstance(antenna, dict) or not isinstance(file, str) or "harmonics" in antenna:
        return tables
    path = inside(folder, file, allow_outside, "antenna.file")
    try:
        return tables | {"antenna": with_harmonics(antenna, path)}
    except ScenarioError as error:
        raise ScenarioError(
            [_at(f"antenna.file: {file}", fault.path, fault) for fault in error.faults]
        ) from None


def _with_nodes_from(tables: dict[str, Any], folder: Path, allow_outside: bool, on_note: _Note) -> Scenario:
    """Returns the scenario whose nodes another file lists; faults name the place in either file."""
    file = tables[_KEY]
    nodes: list[ListedNode] = []
    try:
        nodes = _listed_nodes(file, folder, allow_outside, on_note)
        faults = [_at(file, f"{node.where}{fault.path}", fault) for node in nodes if (fault := node.fault)]
    except ScenarioError as error:
        faults = [fault if fault.path == _KEY else _at(file, fault.path, fault) for fault in error.faults]
    # The nodes take the place of the key, so that faults come in the order of the file.
    whole = {("nodes" if key == _KEY else key): value for key, value in tables.items()}
    try:
        scenario = Scenario.from_dict(whole | {"nodes": [dict(node.values) for node in nodes]})
    except ScenarioError as error:
        # Nodes that could not be read are not told as missing too.
        told = [retold(fault, file, nodes) for fault in error.faults if nodes or fault.path != "nodes"]
        faults += [fault for fault in told if fault]
    if faults:
        raise ScenarioError(faults)
    return scenario


def _listed_nodes(file: object, folder: Path, allow_outside: bool, on_note: _Note) -> list[ListedNode]:
    path = _named_path(file, _NODES_FILE, folder, allow_outside, _KEY)
    if path.suffix.lower() == ".csv":
        return nodes_from_csv(file_text(path, _NODES_FILE, folder, _KEY))
    nodes, notes = nodes_of_features(
        features_of(file_content(path, _NODES_FILE, folder, _KEY, MOST_BYTES), path)
    )
    for note in notes:
        on_note(f"{file}: {note}")
    return nodes


def _named_path(file: object, kind: FileKind, folder: Path, allow_outside: bool, key: str) -> Path:
    """Returns where a file is that a key names."""
    if not isinstance(file, str) or not file.strip():
        raise refusal(
            key, f'got {described(file)}, must be the name of {kind.noun}, as in "{kind.usual_name}"'
        )
    if PurePath(file).suffix.lower() not in kind.endings:
        raise refusal("", f"the name must end in one of {', '.join(kind.endings)}, which tells the kind")
    return inside(folder, file, allow_outside, key)


def _with_areas_from(
    tables: dict[str, Any], folder: Path, allow_outside: bool, on_note: _Note
) -> tuple[dict[str, Any], dict[str, str]]:
    """Returns the tables with the fence and the zones of other files, and which file each is from."""
    stated = tables.get("airspace")
    airspace: dict[str, Any] = dict(stated) if isinstance(stated, dict) else {}
    places: dict[str, str] = {}
    for key, read in ((_FENCE_KEY, with_fence), (_ZONES_KEY, with_zones)):
        zones = airspace.get("no_fly", [])
        clashes = key == _FENCE_KEY and any(fence in airspace for fence in _FENCES)
        if key not in airspace or clashes or not isinstance(zones, list):
            continue  # what is at fault is refused with the rest
        file = airspace.pop(key)
        label = f"airspace.{key}: {file}"
        try:
            path = _named_path(file, _AREA_FILE, folder, allow_outside, "")
            features = features_of(file_content(path, _AREA_FILE, folder, "", MOST_BYTES), path)
            airspace, areas = read(airspace, features, tables.get("origin"))
        except ScenarioError as error:
            raise ScenarioError([_at(label, fault.path, fault) for fault in error.faults]) from None
        for line in areas.account(is_fence=key == _FENCE_KEY):
            on_note(f"{file}: {line}")
        if key == _FENCE_KEY:
            places["airspace.geofence_lat_lon_deg"] = f"{label}: {areas.areas[0].place}"
        added = [area.place for area in areas.areas for _ in area.zones()] if key == _ZONES_KEY else []
        first = len(airspace.get("no_fly", [])) - len(added)
        places |= {
            f"airspace.no_fly[{first + index}]": f"{label}: {place}" for index, place in enumerate(added)
        }
    return (tables | {"airspace": airspace} if isinstance(stated, dict) else tables), places


def _require_nodes_in_reach(scenario: Scenario) -> None:
    """Raises the fault of a node near which zones of a file would not count."""
    for name, node in zip(scenario.node_names, scenario.nodes, strict=True):
        away_m = float(np.abs(np.asarray(node.position_m)[:2]).max())
        if away_m > REACH_M:
            raise refusal(
                f"airspace.{_ZONES_KEY}",
                f"its zones count up to {REACH_M / 1e3:g} km east, west, north and south of the origin, and "
                f"node {name} is {away_m / 1e3:.0f} km away; move [origin] to the nodes",
            )


def _from_file(fault: Fault, origins: Mapping[str, str]) -> Fault:
    """Returns a fault of an area with its place in the file that it is from."""
    for place, origin in origins.items():
        if f"{fault.path}.".startswith((f"{place}[", f"{place}.")):
            return Fault(f"{origin}{fault.path.removeprefix(place)}", fault.message)
    return fault


def _at(file: str, place: str, fault: Fault) -> Fault:
    return Fault(f"{file}: {place}" if place else file, fault.message)
