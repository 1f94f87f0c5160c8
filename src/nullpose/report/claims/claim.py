"""One claim of the paper, and what the data say of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from nullpose.report.certainty import Certainty

__all__ = ["Claim", "Verdict"]


class Verdict(StrEnum):
    """Whether the data bear a claim out."""

    HOLDS = "holds"
    FAILS = "fails"

    @classmethod
    def of(cls, *conditions: bool) -> Verdict:
        """Return *holds* if every condition is met, else *fails*.

        Args:
            conditions: what the claim asks for.
        """
        return cls.HOLDS if all(conditions) else cls.FAILS


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """A claim, its verdict and the numbers behind it.

    Args:
        id: a name that does not change, such as ``weak-jamming-maximum-gain``.
        claim: what the paper says, in our words.
        source: where the paper says it.
        verdict: holds or fails.
        method: how it was decided, with the tolerance.
        finding: one or two sentences with the decisive numbers.
        evidence: the numbers, by name with their unit.
        proved: what follows from the certified bounds, given that all values are certified.
        unproved: what the claim rests on besides: samples, bisections, the place of a pose.
        certainty: the status of the values that it rests on, eq. 3.5 as printed apart.
        holds_up_to: the largest P_M/P up to which it holds, where that is less than all swept.
        holds_from: the smallest P_M/P from which it holds on, where that is more than the least swept.
        fails_from: the smallest P_M/P from which it fails, where it fails.
    """

    id: str
    claim: str
    source: str
    verdict: Verdict
    method: str
    finding: str
    evidence: Mapping[str, object]
    proved: str
    unproved: str
    certainty: Certainty | None = None
    holds_up_to: float | None = None
    holds_from: float | None = None
    fails_from: float | None = None

    @property
    def proved_words(self) -> str:
        """What is proved of the claim, which is nothing if one of its values is not certified."""
        if self.certainty is None or not self.certainty.complete:
            return "Nothing: not every value that it rests on is certified."
        return self.proved

    def to_dict(self) -> dict[str, object]:
        """Return the claim as plain data."""
        return {
            "id": self.id,
            "claim": self.claim,
            "source": self.source,
            "verdict": self.verdict.value,
            "finding": self.finding,
            "evidence": dict(self.evidence),
            "holds_up_to": self.holds_up_to,
            "holds_from": self.holds_from,
            "fails_from": self.fails_from,
            "method": self.method,
            "certainty": None if self.certainty is None else self.certainty.to_dict(),
            "proved": self.proved_words,
            "unproved": self.unproved,
        }
