"""Raw nodes from a file of their own, and where in that file each of their values stands."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from nullpose.errors import Fault

__all__ = ["WHOLE", "ListedNodes", "NodesFileError"]

WHOLE = ""
"""Hides every fault of a node that could not be read at all."""

_NODE = re.compile(r"nodes\[(\d+)\](?:\.(.+?))?((?:\[\d+\])*)")
_MENTION = re.compile(r"nodes\[(\d+)\]")


class NodesFileError(Exception):
    """A file that lists no nodes that could be judged.

    Args:
        faults: what is wrong with it, each with its place in the file; an empty path is the whole file.
    """

    def __init__(self, *faults: Fault) -> None:
        self.faults = faults
        super().__init__(*map(str, faults))


@dataclass(frozen=True, slots=True)
class ListedNodes:
    """Nodes as a scenario file would state them, and the way back to the file they are from.

    Args:
        members: the raw nodes, in order.
        where: the place of each in the file, such as ``line 7``.
        place_of: from a node's index, a key and the index that follows it, such as ``[1]``, to the place of
            that value in the file, below the node's own.
        faults: what is wrong with the file beyond the nodes' own values, with places in the file.
        hidden: for nodes that such a fault concerns, the key whose own fault would only repeat it.
    """

    members: tuple[Mapping[str, object], ...]
    where: tuple[str, ...]
    place_of: Callable[[int, str, str], str]
    faults: tuple[Fault, ...] = ()
    hidden: Mapping[int, str] = field(default_factory=dict)

    def retold(self, fault: Fault, file: str) -> Fault | None:
        """Returns a scenario's fault with its place in the nodes' file, or None if it only repeats another.

        Args:
            fault: as the scenario reports it, at ``nodes[6].power_dbm`` or anywhere else.
            file: the file's name, as it stands in the scenario file.
        """
        message = _MENTION.sub(lambda found: f"{file}: {self.where[int(found[1])]}", fault.message)
        node = _NODE.fullmatch(fault.path)
        if node is None:
            return Fault(fault.path, message)
        index, key = int(node[1]), node[2] or ""
        if index in self.hidden and self.hidden[index] in (WHOLE, key):
            return None
        below = self.place_of(index, key, node[3]) if key else ""
        return Fault(f"{file}: {self.where[index]}{below}", message)
