"""Raw nodes from a file of their own, and where in that file each of their values stands."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from nullpose.errors import Fault

_NODE = re.compile(r"nodes\[(\d+)\](?:\.(.+))?")
_MENTION = re.compile(r"nodes\[(\d+)\]")


@dataclass(frozen=True, slots=True)
class ListedNode:
    """A node as a scenario file would state it, and the way back to the file it is from.

    Args:
        where: its place in the file, such as ``line 7``.
        values: the raw node; empty if it could not be read.
        usual: the place of a value below the node's, with ``{}`` for its key.
        places: the places of those values that stand elsewhere, by key, such as ``position_m[1]``.
        fault: why it could not be read, below its own place.
    """

    where: str
    values: Mapping[str, object] = field(default_factory=dict)
    usual: str = ""
    places: Mapping[str, str] = field(default_factory=dict)
    fault: Fault | None = None


def retold(fault: Fault, file: str, nodes: Sequence[ListedNode]) -> Fault | None:
    """Returns a scenario's fault with its place in the nodes' file, or None if it only repeats another.

    Args:
        fault: as the scenario reports it, at ``nodes[6].power_dbm`` or anywhere else.
        file: the file's name, as it stands in the scenario file.
        nodes: its nodes.
    """
    message = _MENTION.sub(lambda found: f"{file}: {nodes[int(found[1])].where}", fault.message)
    found = _NODE.fullmatch(fault.path)
    if found is None:
        return Fault(fault.path, message)
    node, key = nodes[int(found[1])], found[2]
    below = node.places.get(key, node.usual.format(key)) if key else ""
    return None if node.fault else Fault(f"{file}: {node.where}{below}", message)
