"""From a file to a scenario."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path, PurePath
from typing import Any

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario.antenna import with_harmonics
from nullpose.scenario.areas import areas_from_features
from nullpose.scenario.faults import refusal
from nullpose.scenario.features import ENDINGS
from nullpose.scenario.listed_nodes import ListedNode, retold
from nullpose.scenario.nodes_csv import nodes_from_csv
from nullpose.scenario.nodes_geojson import nodes_from_features
from nullpose.scenario.scenario import Scenario
from nullpose.scenario.toml_file import FileKind, file_text, tables_of
from nullpose.scenario.wording import described

_KEY = "nodes_from"
_NODES_FILE = FileKind("a file of nodes", "nodes.geojson", (*ENDINGS, ".csv"))
_AREA_FILE = FileKind("a file of areas", "zones.geojson", ENDINGS)
_FENCES = {"geofence_m", "geofence_lat_lon_deg"}
_AREA_KEYS = {"geofence_from", "no_fly_from"}


def load(path: str | os.PathLike[str], *, allow_outside: bool = False) -> Scenario:
    """Returns the scenario that a TOML file describes, with the nodes of the file that it may name.

    Args:
        path: the file, of 10 MB at most.
        allow_outside: whether the file of nodes may be outside the folder of this one.

    Raises:
        ScenarioError: when the file cannot be read or is faulty; with every fault it has.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> scenario.node_names, scenario.jammers[0].power_w
        (('S1', 'S2'), 1.0)
    """
    source = os.fspath(path)
    origins: dict[str, str] = {}
    try:
        tables = tables_of(file_text(Path(source)))
        tables = _with_antenna_from(tables, Path(source).parent, allow_outside)
        tables, origins = _with_areas_from(tables, Path(source).parent, allow_outside)
        if _KEY in tables and "nodes" not in tables:
            return _with_nodes_from(tables, Path(source).parent, allow_outside)
        return Scenario.from_dict(tables)
    except ScenarioError as error:
        raise ScenarioError([_from_file(fault, origins) for fault in error.faults], source) from None


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


def files_of(path: Path) -> dict[str, Path]:
    """Returns the files that a scenario is read from, by what to call them.

    Args:
        path: of a scenario file that loads.
    """
    tables = tables_of(file_text(path))
    named = {_KEY: tables.get(_KEY), "antenna.file": tables.get("antenna", {}).get("file")}
    named |= {f"airspace.{key}": tables["airspace"].get(key) for key in _AREA_KEYS}
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


def _with_nodes_from(tables: dict[str, Any], folder: Path, allow_outside: bool) -> Scenario:
    """Returns the scenario whose nodes another file lists; faults name the place in either file."""
    file = tables[_KEY]
    nodes: list[ListedNode] = []
    try:
        nodes = _listed_nodes(file, folder, allow_outside)
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


def _listed_nodes(file: object, folder: Path, allow_outside: bool) -> list[ListedNode]:
    text, ending = _listed_text(file, _NODES_FILE, folder, allow_outside, _KEY)
    return nodes_from_csv(text) if ending == ".csv" else nodes_from_features(text, ending)


def _listed_text(
    file: object, kind: FileKind, folder: Path, allow_outside: bool, key: str
) -> tuple[str, str]:
    """Returns the text of a file that a key names, and how its name ends."""
    if not isinstance(file, str) or not file.strip():
        raise refusal(
            key, f'got {described(file)}, must be the name of {kind.noun}, as in "{kind.usual_name}"'
        )
    ending = PurePath(file).suffix.lower()
    if ending not in kind.endings:
        raise refusal("", f"the name must end in one of {', '.join(kind.endings)}, which tells the kind")
    return file_text(inside(folder, file, allow_outside, key), kind, folder, key), ending


def _with_areas_from(
    tables: dict[str, Any], folder: Path, allow_outside: bool
) -> tuple[dict[str, Any], dict[str, str]]:
    """Returns the tables with the fence and the zones of other files, and which file each is from."""
    stated = tables.get("airspace")
    airspace: dict[str, Any] = dict(stated) if isinstance(stated, dict) else {}
    origins: dict[str, str] = {}
    for key in _AREA_KEYS & airspace.keys():
        own = airspace.get("no_fly", []) if key == "no_fly_from" else [*_FENCES & airspace.keys()]
        if not isinstance(own, list) or (key == "geofence_from" and own):
            continue  # which is refused
        file = airspace.pop(key)
        label = f"airspace.{key}: {file}"
        try:
            areas = areas_from_features(*_listed_text(file, _AREA_FILE, folder, allow_outside, ""))
        except ScenarioError as error:
            raise ScenarioError([_at(label, fault.path, fault) for fault in error.faults]) from None
        if key == "no_fly_from":
            airspace["no_fly"] = [*own, *areas]
            places = (f"airspace.no_fly[{len(own) + index}]" for index in range(len(areas)))
            origins |= {place: f"{label}: features[{index}]" for index, place in enumerate(places)}
        elif len(areas) == 1 and "polygon_lat_lon_deg" in areas[0]:
            airspace["geofence_lat_lon_deg"] = areas[0]["polygon_lat_lon_deg"]
            origins["airspace.geofence_lat_lon_deg"] = f"{label}: coordinates"
        else:
            raise refusal(label, f"got {len(areas)} features, must be one Polygon, the fence")
    return (tables | {"airspace": airspace} if origins else tables), origins


def _from_file(fault: Fault, origins: Mapping[str, str]) -> Fault:
    """Returns a fault of an area with its place in the file that it is from."""
    for place, origin in origins.items():
        if f"{fault.path}.".startswith((f"{place}[", f"{place}.")):
            return Fault(f"{origin}{fault.path.removeprefix(place)}", fault.message)
    return fault


def _at(file: str, place: str, fault: Fault) -> Fault:
    return Fault(f"{file}: {place}" if place else file, fault.message)
