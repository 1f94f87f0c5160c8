"""What a prover says: a pose, the value it claims for it, and a bound that no pose exceeds."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

__all__ = ["FINISHED", "NOT_CLOSED", "Claim"]

FINISHED = "finished"
NOT_CLOSED = "not closed"


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """A prover's own words, none of them checked.

    Args:
        status: ``"finished"`` if the prover says that the gap is reached, ``"not closed"`` if its time ran
            out, or else what went wrong.
        value: smallest SINR that it claims for its pose; NaN if it has none.
        bound: the bound that it claims; NaN if it has none.
        position_m: (3,) its pose's position, metres; empty if it has none.
        axis: (3,) along its pose's dipole, of any length; empty if it has none.
        nodes: of its branch and bound.
        seconds: wall-clock time from building the model to the answer, imports left out.
    """

    status: str
    value: float = float("nan")
    bound: float = float("nan")
    position_m: tuple[float, ...] = ()
    axis: tuple[float, ...] = ()
    nodes: int = 0
    seconds: float = 0.0

    def to_dict(self) -> dict[str, Any]:
        """Return the claim as plain data."""
        return asdict(self)
