"""Nodes listed in a file of their own, whichever its kind."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import PurePath

from nullpose.errors import Fault
from nullpose.scenario.listed_nodes import ListedNodes, NodesFileError
from nullpose.scenario.nodes_csv import nodes_from_csv
from nullpose.scenario.nodes_geojson import nodes_from_geojson

__all__ = ["KINDS", "reader_of"]

KINDS = {".geojson": nodes_from_geojson, ".json": nodes_from_geojson, ".csv": nodes_from_csv}
"""How a nodes' file is read, by the end of its name."""


def reader_of(file: str) -> Callable[[str], ListedNodes]:
    """Returns what reads the content of a GeoJSON or CSV file of nodes.

    Args:
        file: its name, the end of which tells its kind.

    Raises:
        NodesFileError: the name has another end.
    """
    read = KINDS.get(PurePath(file).suffix.lower())
    if read is None:
        raise NodesFileError(
            Fault("", f"the name must end in one of {', '.join(KINDS)}, which tells the kind")
        )
    return read
