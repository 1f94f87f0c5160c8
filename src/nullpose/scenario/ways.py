"""Keys that belong together: several ways to state one thing."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import Any


@dataclass(frozen=True, slots=True)
class Ways:
    """Ways to state one thing, each a group of keys that are given whole or not at all.

    Args:
        groups: the keys of each way.
        fewest: 1 if one way must be taken, 0 if none need be.
        most: how many may be taken.
        twins: pairs of a key and the key of a group in whose place it may be given.
    """

    groups: tuple[tuple[str, ...], ...]
    fewest: int = 1
    most: int = 1
    twins: tuple[tuple[str, str], ...] = ()

    def begun(self, given: Collection[str]) -> list[tuple[str, ...]]:
        """Returns the ways of which some key, or its twin, is among the given ones."""
        return [group for group in self.groups if any(each in given for each in self._all(group))]

    def faults(self, given: Collection[str]) -> Iterator[str]:
        """Yields what is wrong with the keys that are given."""
        begun = self.begun(given)
        ways = [" and ".join(group) for group in self.groups]
        stated = [" and ".join(key for key in self._all(group) if key in given) for group in begun]
        number = "exactly" if self.fewest else "at most"
        if len(begun) > self.most:
            yield (
                f"both {' and '.join(stated)} are given, {number} one is allowed: {', or '.join(ways)}; "
                "remove either"
            )
        elif len(begun) < self.fewest:
            number = "exactly" if self.most == 1 else "at least"
            yield f"neither {' nor '.join(ways)} is given, {number} one must be; add either"
        else:
            for group, words in zip(begun, stated, strict=True):
                missing = [key for key in group if not any(each in given for each in self.alike(key))]
                if missing:
                    others = [way for way in ways if way != " and ".join(group)]
                    twins = [twin for twin, own in self.twins if own in missing]
                    instead = f" ({' or '.join(twins)} will do as well)" if twins else ""
                    yield (
                        f"{words} given without {' and '.join(missing)}; add it, or {', or '.join(others)}"
                        f"{instead}"
                    )

    def alike(self, key: str) -> list[str]:
        """Returns a key of a group together with those that may be given in its place."""
        return [key, *(twin for twin, own in self.twins if own == key)]

    def others(self, key: str) -> Iterator[str]:
        """Yields the keys that a key takes the place of: the other ways, where it is a whole one."""
        begun = self.begun([key])
        if begun and (len(self.groups) == 2 or len(begun[0]) == 1):
            yield from (other for group in self.groups if group not in begun for other in self._all(group))

    def schema(self) -> dict[str, Any]:
        """Returns the same as a rule of JSON Schema."""
        groups = [self._whole(group) for group in self.groups]
        if self.most > 1:
            return {"anyOf": groups}
        if self.fewest:
            return {"oneOf": groups}
        pairs = [{"required": [*one, *other]} for one, other in combinations(self.groups, 2)]
        return {"not": pairs[0] if len(pairs) == 1 else {"anyOf": pairs}}

    def _all(self, group: tuple[str, ...]) -> list[str]:
        return [each for key in group for each in self.alike(key)]

    def _whole(self, group: tuple[str, ...]) -> dict[str, Any]:
        """Returns the rule that all of a group is given, each key by itself or by a twin."""
        if self._all(group) == list(group):
            return {"required": list(group)}
        choices = [[{"required": [each]} for each in self.alike(key)] for key in group]
        return {"allOf": [one[0] if len(one) == 1 else {"anyOf": one} for one in choices]}


def exactly_one(*keys: str) -> Ways:
    """Returns the rule that exactly one of some keys is given."""
    return Ways(tuple((key,) for key in keys))


def at_most_one(*keys: str) -> Ways:
    """Returns the rule that at most one of some keys is given."""
    return Ways(tuple((key,) for key in keys), fewest=0)
