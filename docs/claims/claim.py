"""One claim of the paper, how it is measured, and what the data say of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from claims.study import JammingStudy
from nullpose.report.answer import counted


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """A claim of the paper; once checked, with what was found.

    Args:
        id: a name that does not change, such as ``weak-jamming-maximum-gain``.
        claim: what the paper says, in our words.
        source: where the paper says it.
        method: what is measured, and what counts as confirmed.
        unproved: what the claim rests on besides proofs: samples, bisections, the place of a pose.
        measure: returns the following, from the data; the certainty apart.
        holds: whether the data bear it out.
        finding: one or two sentences with the decisive numbers.
        levels: rows of numbers at single powers, by name with their unit.
        proved: what follows from the certified bounds, given that all values are certified.
        holds_up_to: the largest P_M/P up to which it holds, where that is less than all swept.
        holds_from: the smallest P_M/P from which it holds on, where that is more than the least swept.
        fails_from: the smallest P_M/P from which it fails, where it fails.
        certainty: the status of the values that it rests on, eq. 3.5 as printed apart.
    """

    id: str
    claim: str
    source: str
    method: str
    unproved: str
    measure: Callable[[JammingStudy], dict[str, Any]]
    holds: bool = False
    finding: str = ""
    levels: Sequence[Mapping[str, Any]] = ()
    proved: str = ""
    holds_up_to: float | None = None
    holds_from: float | None = None
    fails_from: float | None = None
    certainty: Mapping[str, Any] = field(default_factory=lambda: counted(()))

    def checked(self, study: JammingStudy) -> Claim:
        """Return the claim with its verdict, and what it rests on.

        Args:
            study: the data.
        """
        study.used.clear()
        measured = self.measure(study)
        return replace(self, **measured, certainty=counted(study.used.values()))

    @property
    def verdict(self) -> str:
        """Whether the data bear the claim out, in a word."""
        return "holds" if self.holds else "fails"

    @property
    def is_certified(self) -> bool:
        """Whether it rests on values, each of them certified."""
        return self.certainty["certified"] == self.certainty["values"] > 0

    @property
    def proved_words(self) -> str:
        """What is proved of the claim, which is nothing if one of its values is not certified."""
        return self.proved if self.is_certified else "Nothing: not every value that it rests on is certified."
