"""From a file to a scenario."""

from __future__ import annotations

import logging
import os
import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from nullpose.errors import ScenarioError, checked
from nullpose.files import PlainTable
from nullpose.scenario.faults import ONLY_LOCAL, refusal, require
from nullpose.scenario.origin import POINT_LISTS
from nullpose.scenario.overrides import Override, apply_overrides, overridden
from nullpose.scenario.scenario import Scenario
from nullpose.scenario.toml_file import file_text, tables_of, uploaded_text

_FILE_KEYS = (
    "nodes_from",
    "geofence_from",
    "no_fly_from",
    "file",
    "buildings_from",
    "antenna_file",
    "track_from",
)
_EARLY = re.compile(
    r"origin\b|airspace\.(?!no_fly\b)|nodes_from\b|\S*\.track_from\b"
    r"|buildings\S*\.(?:buildings_from|storey_height_m|missing_height_m|height_unit|\w+_property)\b"
)
_LOG = logging.getLogger("nullpose")


@checked
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
    try:
        tables, late = _overridden_tables(Path(source), overrides)
        if _named_files(tables):
            from nullpose.scenario.named_files import NamedFiles  # most scenarios name none

            scenario = NamedFiles(Path(source).parent, allow_outside, on_note).scenario(tables)
        else:
            scenario = Scenario.from_dict(tables)
    except (RecursionError, OverflowError):
        raise refusal(
            "", "it is nested too deeply to be read, or has a number beyond 1e308", source
        ) from None
    except ScenarioError as error:
        raise ScenarioError(error.faults, error.source or source) from None
    return apply_overrides(scenario, late)


def _overridden_tables(
    path: Path, overrides: Iterable[str | Override]
) -> tuple[PlainTable, list[str | Override]]:
    """Read a file's tables, with those changes that decide which files are read and what of them counts.

    Returns:
        The tables, and the changes that are left for the scenario.
    """
    tables, late = tables_of(file_text(path)), list(overrides)
    early = [change for change in late if _EARLY.match(str(change).strip())]
    names_files = any("_from" in key for key in _named_files(tables)) or any(
        "_from" in str(change).split("=")[0] for change in early
    )
    if not early or not names_files:
        return tables, late
    return overridden(tables, early), [change for change in late if change not in early]


def _named_files(tables: PlainTable) -> PlainTable:
    """Pick the names of the files of nodes, fence, zones, antennas and buildings, by key."""
    holders = {"": tables} | {f"{key}.": tables.get(key) for key in ("airspace", "antenna", "destination")}
    for key in ("buildings", *POINT_LISTS):
        members = tables.get(key)
        holders |= {
            f"{key}[{i}].": each for i, each in enumerate(members if isinstance(members, list) else ())
        }
    return {
        f"{path}{key}": table[key]
        for path, table in holders.items()
        if isinstance(table, Mapping)
        for key in _FILE_KEYS
        if key in table
    }


def files_of(path: Path, overrides: Iterable[str | Override] = ()) -> dict[str, Path]:
    """Return the files that a scenario is read from, by what to call them.

    Args:
        path: of a scenario file that loads.
        overrides: its changes.
    """
    files = _named_files(_overridden_tables(path, overrides)[0])
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
        require(
            "nodes_from" not in tables, "nodes_from", f"{ONLY_LOCAL}; list the nodes here, under [[nodes]]"
        )
        return Scenario.from_dict(tables)
    except ScenarioError as error:
        raise ScenarioError(error.faults, name) from None
