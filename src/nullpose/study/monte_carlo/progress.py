"""How far a study is."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["StudyProgress"]


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyProgress:
    """How far a run is, as its callback gets it.

    Args:
        scenes: how many there are.
        done: how many are in parts, those of earlier runs too.
        rows: how many rows these have.
        failed: how many of them are failures.
        workers: threads that work; 0 while none is there.
        rate: scenes per second of this run so far; 0 before the first part.
        note: what is going on, or went wrong and was mended; empty while scenes are solved.
    """

    scenes: int
    done: int
    rows: int
    failed: int
    workers: int
    rate: float
    note: str = ""

    @property
    def seconds_left(self) -> float | None:
        """How long the rest will take at this rate; None before the first part."""
        return (self.scenes - self.done) / self.rate if self.rate > 0.0 else None
