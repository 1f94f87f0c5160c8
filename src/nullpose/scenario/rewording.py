"""What pydantic and the pair rule have to say about the keys of one table, in plain words."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from pydantic import ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import InitErrorDetails

from nullpose.scenario.faults import KIND, as_error_details
from nullpose.scenario.wording import described, listed, nearest

__all__ = ["meant_keys", "table_faults"]


def table_faults(
    error: ValidationError | None,
    data: Mapping[str, object],
    fields: Mapping[str, FieldInfo],
    pairs: Sequence[tuple[str, str]],
    alternatives: Sequence[tuple[str, str]] = (),
    ways: Sequence[tuple[str, ...]] = (),
) -> list[InitErrorDetails]:
    """Returns the faults of one table, without those that only follow from a misspelt key.

    Args:
        error: what pydantic found in the table, or None.
        data: the table as given.
        fields: the fields that the table may have.
        pairs: keys of which exactly one is to be given.
        alternatives: keys of which at most one may be given.
        ways: groups of keys that state one required thing; one group is to be given.
    """
    entries = error.errors(include_url=False) if error else []
    unknown = [str(entry["loc"][-1]) for entry in entries if entry["type"] == "extra_forbidden"]
    absent = [key for key in fields if data.get(key) is None]
    meant = {nearest(key, absent) for key in unknown}
    details = []
    for entry in entries:
        place, given = entry["loc"], entry["input"]
        match entry["type"]:
            case _ if entry["type"] == KIND:
                message = entry["msg"]
            case "extra_forbidden":
                message = _unknown_key(str(place[-1]), absent, fields)
            case "missing" if place[-1] in meant or _stated_otherwise(str(place[-1]), data, ways, meant):
                continue
            case "missing":
                message = f"missing; it must be given: {_expected(fields[str(place[-1])])}"
            case "invalid_key":
                message = f"got a key that is not text; the keys here are {listed(fields)}"
            case _:
                message = f"got {described(given)}, which cannot be used here"
        details.append(as_error_details(place, message, given))
    messages = [*_pair_faults(data, pairs, meant), *_alternative_faults(data, alternatives)]
    return details + [as_error_details((), message) for message in messages]


def _stated_otherwise(
    key: str, data: Mapping[str, object], ways: Sequence[tuple[str, ...]], meant: Collection[str]
) -> bool:
    """Returns whether a key of another way to state the same is given or, misspelt, meant."""
    if not any(key in way for way in ways):
        return False
    others = [other for way in ways if key not in way for other in way]
    return any(data.get(other) is not None or other in meant for other in others)


def meant_keys(data: Mapping[str, object], keys: Collection[str]) -> set[str]:
    """Returns the keys for which the unknown keys of a raw table seem to be meant."""
    absent = [key for key in keys if data.get(key) is None]
    return {nearest(str(key), absent) for key in data if key not in keys}


def _unknown_key(key: str, absent: Collection[str], fields: Collection[str]) -> str:
    # A key that is still to be given is the likelier meaning of a misspelt one.
    guess = nearest(key, absent) or nearest(key, fields)
    meant = f'; did you mean "{guess}"?' if guess else ";"
    return f"unknown key{meant} the keys here are {listed(fields)}"


def _expected(field: FieldInfo) -> str:
    return (field.description or "").rstrip(".")


def _pair_faults(
    data: Mapping[str, object], pairs: Sequence[tuple[str, str]], meant: Collection[str]
) -> list[str]:
    faults = []
    for one, other in pairs:
        given = [key for key in (one, other) if data.get(key) is not None]
        if len(given) == 2:
            faults.append(f"both {one} and {other} are given, exactly one is allowed; remove either")
        elif not given and one not in meant and other not in meant:
            faults.append(f"neither {one} nor {other} is given, exactly one must be; add either")
    return faults


def _alternative_faults(data: Mapping[str, object], alternatives: Sequence[tuple[str, str]]) -> list[str]:
    return [
        f"both {one} and {other} are given, at most one is allowed; remove either"
        for one, other in alternatives
        if data.get(one) is not None and data.get(other) is not None
    ]
