"""Keys that belong together: several ways to state one thing."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Ways:
    """Ways to state one thing, each a group of keys that are given whole or not at all.

    Args:
        groups: the keys of each way.
        fewest: 1 if one way must be taken, 0 if none need be.
        most: how many may be taken.
    """

    groups: tuple[tuple[str, ...], ...]
    fewest: int = 1
    most: int = 1

    def begun(self, given: Collection[str]) -> list[tuple[str, ...]]:
        """Returns the ways of which some key is among the given ones."""
        return [group for group in self.groups if not set(group).isdisjoint(given)]

    def faults(self, given: Collection[str]) -> Iterator[str]:
        """Yields what is wrong with the keys that are given."""
        begun = self.begun(given)
        ways = [" and ".join(group) for group in self.groups]
        stated = [" and ".join(key for key in group if key in given) for group in begun]
        number = "exactly" if self.fewest else "at most"
        if len(begun) > self.most:
            yield (
                f"both {' and '.join(stated)} are given, {number} one is allowed: {', or '.join(ways)}; "
                "remove either"
            )
        elif len(begun) < self.fewest:
            yield f"neither {' nor '.join(ways)} is given, exactly one must be; add either"
        else:
            for group, words in zip(begun, stated, strict=True):
                missing = [key for key in group if key not in given]
                if missing:
                    others = [way for way in ways if way != " and ".join(group)]
                    yield f"{words} given without {' and '.join(missing)}; add it, or {', or '.join(others)}"

    def others(self, key: str) -> Iterator[str]:
        """Yields the keys that a key takes the place of: those of the other one of two ways."""
        if len(self.groups) == 2 and self.begun([key]):
            yield from (other for group in self.groups if key not in group for other in group)

    def schema(self) -> dict[str, Any]:
        """Returns the same as a rule of JSON Schema."""
        groups = [{"required": list(group)} for group in self.groups]
        if self.most > 1:
            return {"anyOf": groups}
        return {"oneOf": groups} if self.fewest else {"not": {"required": [*self.groups[0], *self.groups[1]]}}


def exactly_one(*keys: str) -> Ways:
    """Returns the rule that exactly one of some keys is given."""
    return Ways(tuple((key,) for key in keys))


def at_most_one(*keys: str) -> Ways:
    """Returns the rule that at most one of some keys is given."""
    return Ways(tuple((key,) for key in keys), fewest=0)
