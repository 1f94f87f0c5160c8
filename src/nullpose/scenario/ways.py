"""Keys that belong together: several ways to state one thing."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from itertools import chain, combinations

from nullpose.files import PlainTable


@dataclass(frozen=True, slots=True)
class Ways:
    """Ways to state one thing, each a group of keys that are given whole or not at all.

    Args:
        groups: the keys of each way.
        fewest: 1 if one way must be taken, 0 if none need be.
        most: how many may be taken.
        twins: pairs of a key and the key of a group in whose place it may be given.
        instead: further keys of which one may be there in place of every group.
    """

    groups: tuple[tuple[str, ...], ...]
    fewest: int = 1
    most: int = 1
    twins: tuple[tuple[str, str], ...] = ()
    instead: tuple[str, ...] = ()

    def taken(self, present: Collection[str]) -> list[tuple[str, ...]]:
        """Return the groups of which some key, or its twin, is present."""
        return [group for group in self.groups if any(key in present for key in self._all(group))]

    def faults(self, present: Collection[str]) -> Iterator[str]:
        """Yield the faults of the keys that are present."""
        taken = self.taken(present)
        allowed = ", or ".join(" and ".join(group) for group in self.groups)
        keys = [" and ".join(key for key in self._all(group) if key in present) for group in taken]
        if len(taken) > self.most:
            number = "exactly one" if self.fewest else "at most one"
            yield f"both {' and '.join(keys)} are given, {number} is allowed: {allowed}; remove either"
        elif len(taken) < self.fewest:
            number = "exactly" if self.most == 1 else "at least"
            neither = " nor ".join(" and ".join(group) for group in self.groups)
            yield f"neither {neither} is given, {number} one must be; add either"
        else:
            for group, begin in zip(taken, keys, strict=True):
                yield from self._missing(group, begin, present)

    def _missing(self, group: tuple[str, ...], begin: str, present: Collection[str]) -> Iterator[str]:
        """Yield the fault that only a part of a group is present."""
        if missing := [key for key in group if not any(alike in present for alike in self.alike(key))]:
            others = ", or ".join(" and ".join(other) for other in self.groups if other != group)
            needed = " and ".join(" or ".join(self.alike(key)) for key in missing)
            yield f"{begin} given without {needed}; add it, or {others}"

    def alike(self, key: str) -> list[str]:
        """Return a key of a group together with those that may be given in its place."""
        return [key, *(twin for twin, replaced in self.twins if replaced == key)]

    def others(self, key: str) -> Iterator[str]:
        """Yield the keys that a key takes the place of: those of the other ways."""
        if taken := self.taken([key]):
            yield from chain.from_iterable(self._all(group) for group in self.groups if group not in taken)

    def schema(self) -> PlainTable:
        """Write the same as a rule of JSON Schema."""
        groups = [self._whole(group) for group in self.groups]
        if self.most > 1:
            return {"anyOf": [*groups, *({"required": [key]} for key in self.instead)]}
        if self.fewest:
            return {"oneOf": groups}
        pairs = [{"required": list(chain(*pair))} for pair in combinations(self.groups, 2)]
        return {"not": pairs[0] if len(pairs) == 1 else {"anyOf": pairs}}

    def _all(self, group: tuple[str, ...]) -> list[str]:
        return [alike for key in group for alike in self.alike(key)]

    def _whole(self, group: tuple[str, ...]) -> PlainTable:
        """Write the rule that all of a group is given, each key by itself or by a twin."""
        if self._all(group) == list(group):
            return {"required": list(group)}
        choices = [[{"required": [alike]} for alike in self.alike(key)] for key in group]
        return {"allOf": [rules[0] if len(rules) == 1 else {"anyOf": rules} for rules in choices]}


def exactly_one(*keys: str) -> Ways:
    """Make the rule that exactly one of the keys is given."""
    return Ways(tuple((key,) for key in keys))


def at_most_one(*keys: str) -> Ways:
    """Make the rule that at most one of the keys is given."""
    return Ways(tuple((key,) for key in keys), fewest=0)
