"""Faults between the objective and the keys that only one of the objectives reads."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from nullpose.scenario.faults import Place
from nullpose.scenario.ground_points import Node
from nullpose.scenario.rewording import meant_keys
from nullpose.scenario.wording import plain

__all__ = ["objective_faults"]

_SECRECY = "secrecy-rate"
_SWITCH = f'write objective = "{_SECRECY}" at the top of the file'
_DOWNLINK_KEYS = ("noise_w", "noise_dbm", "jamming_w", "jamming_dbm")
_UPLINK_KEYS = ("weight", "min_sinr_db")


def objective_faults(data: Mapping[str, object], keys: Sequence[str]) -> Iterator[tuple[Place, str]]:
    """Yields the faults between a raw scenario's objective and the rest of it, each with its place.

    Args:
        data: the raw scenario.
        keys: the keys that a scenario may have.
    """
    match data.get("objective"):
        case "secrecy-rate":
            yield from _secrecy_faults(data, keys)
        case None | "min-sinr":
            yield from _sinr_faults(data)


def _secrecy_faults(data: Mapping[str, object], keys: Sequence[str]) -> Iterator[tuple[Place, str]]:
    meant = meant_keys(data, keys)
    listeners = plain(data.get("eavesdroppers"))
    if (listeners is None or listeners in ([], ())) and "eavesdroppers" not in meant:
        message = (
            f'none is given, but objective = "{_SECRECY}" needs at least one; add a table headed '
            '[[eavesdroppers]], or write objective = "min-sinr"'
        )
        yield ("eavesdroppers",), message
    if data.get("transmitter") is None and "transmitter" not in meant:
        message = (
            f'missing, but objective = "{_SECRECY}" needs the drone\'s own power; add a table headed '
            "[transmitter] with power_w or power_dbm"
        )
        yield ("transmitter",), message
    for place, node in _nodes(data):
        for key in _UPLINK_KEYS:
            if node.get(key) is not None:
                message = (
                    f'has no meaning with objective = "{_SECRECY}", which compares rates and no SINR; remove '
                    'it, or write objective = "min-sinr"'
                )
                yield (*place, key), message


def _sinr_faults(data: Mapping[str, object]) -> Iterator[tuple[Place, str]]:
    used = f'used with objective = "{_SECRECY}" only'
    if plain(data.get("eavesdroppers")) not in (None, [], ()):
        yield ("eavesdroppers",), f"{used}; {_SWITCH}, or remove them"
    if data.get("transmitter") is not None:
        yield ("transmitter",), f"{used}; {_SWITCH}, or remove it"
    for place, node in _nodes(data):
        for key in _DOWNLINK_KEYS:
            if node.get(key) is not None:
                yield (*place, key), f"{used}; {_SWITCH}, or remove it"
        powers = ("power_w", "power_dbm")
        meant = meant_keys(node, list(Node.model_fields))
        if not any(node.get(key) is not None or key in meant for key in powers):
            yield place, "neither power_w nor power_dbm is given, exactly one must be; add either"


def _nodes(data: Mapping[str, object]) -> Iterator[tuple[Place, Mapping[str, object]]]:
    members = plain(data.get("nodes"))
    for index, member in enumerate(members if isinstance(members, list | tuple) else ()):
        if isinstance(member, Mapping):
            yield ("nodes", index), member
        elif isinstance(member, Node):
            yield ("nodes", index), {key: getattr(member, key) for key in Node.model_fields}
