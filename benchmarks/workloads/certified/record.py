"""One method at one jamming power: what it claims, and what its pose is worth."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from benchmarks.workload import Row

__all__ = ["Record"]

_NAN = float("nan")


@dataclass(frozen=True, slots=True, kw_only=True)
class Record:
    """A method's claim, and beside it what was found out about it apart from the method.

    Args:
        method: name of nullpose or a prover.
        jamming_ratio: jamming power over the power of a node, P_M / P.
        status: ``"finished"``, ``"not closed"``, or why there is no claim.
        claimed_value: smallest SINR that the method claims for its pose; NaN without one.
        claimed_bound: its bound; NaN without one.
        value: smallest SINR of its pose, evaluated by nullpose's physics; NaN without a pose.
        seconds: median wall-clock time of its runs.
        nodes: of the branch and bound.
        known: best value that any method's pose has, by the same physics.
        gap: relative gap asked for.
        cap_s: seconds that the method had.
    """

    method: str
    jamming_ratio: float
    status: str
    claimed_value: float = _NAN
    claimed_bound: float = _NAN
    value: float = _NAN
    seconds: float = 0.0
    nodes: int = 0
    known: float = _NAN
    gap: float = _NAN
    cap_s: float = _NAN

    def to_row(self) -> Row:
        """Return the record as plain data."""
        return asdict(self)

    @classmethod
    def from_row(cls, row: Row) -> Record:
        """Return the record that a row came from."""
        return cls(**row)
