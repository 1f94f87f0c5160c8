"""Mutations in a row: each is read, verified, and judged if it is accepted."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass, field
from functools import cache

import numpy as np

from benchmarks.mutations.bases import KINDS, bases_of, optima_of
from benchmarks.mutations.changes import CLASSES, MORE, mutated
from benchmarks.mutations.truth import Data, Truth
from nullpose.certificate import parse_certificate, verify
from nullpose.errors import CertificateError, ScenarioError

REFUSED, REJECTED, TRUE, FALSE = OUTCOMES = (
    "refused on reading",
    "rejected",
    "accepted, true",
    "accepted, false",
)
_EVERY = (*CLASSES, *MORE)
_TRIES = 12  # some changes, such as the sign of a zero, are none


@dataclass(slots=True)
class Tally:
    """Mutations counted by the class of the change and the outcome; what is false but accepted, in words."""

    counts: Counter[tuple[str, str]] = field(default_factory=Counter)
    falsehoods: list[str] = field(default_factory=list)

    def add(self, other: Tally) -> None:
        """Add what became of others."""
        self.counts += other.counts
        self.falsehoods += other.falsehoods


class Mutations:
    """The mutations of sound certificates of one kind, by number; optima are better poses of the same."""

    def __init__(self, kind: str, bases: list[Data], optima: list[Data]) -> None:
        self.kind, self.bases, self.optima, self.truth = kind, bases, optima, Truth(optima)

    def tally(self, first: int, count: int) -> Tally:
        """Return what became of mutations, each made from its number alone."""
        tally = Tally()
        for number in range(first, first + count):
            change, data = self.mutation(number)
            outcome, falsehood = self.judged(data)
            tally.counts[change, outcome] += 1
            if falsehood:
                tally.falsehoods.append(f"{self.kind}, mutation {number} ({change}): {falsehood}")
        return tally

    def mutation(self, number: int) -> tuple[str, Data]:
        """Return the class of a change and the data after it."""
        rng = np.random.default_rng([20263, list(KINDS).index(self.kind), number])
        change = _EVERY[number % len(_EVERY)]
        while True:
            for base in rng.integers(len(self.bases), size=_TRIES):
                data = mutated(self.bases[int(base)], change, rng)
                if data is not None:
                    return change, data
            change = _EVERY[int(rng.integers(len(_EVERY)))]  # there is no such place

    def judged(self, data: Data) -> tuple[str, str]:
        """Return the outcome of a certificate, and what is false in it if it is accepted all the same."""
        try:
            certificate = parse_certificate(json.dumps(data))
            accepted = verify(certificate).proved
        except (CertificateError, ScenarioError):
            return REFUSED, ""
        if not accepted:
            return REJECTED, ""
        falsehood = self.truth.falsehood(data)
        return (FALSE if falsehood else TRUE), falsehood


@cache
def _mutations(kind: str) -> Mutations:
    return Mutations(kind, bases_of(kind), optima_of(kind))


def tally_of(part: tuple[str, int, int]) -> Tally:
    """Return what became of some mutations, in a process that keeps the certificates they are made from."""
    kind, first, count = part
    return _mutations(kind).tally(first, count)
