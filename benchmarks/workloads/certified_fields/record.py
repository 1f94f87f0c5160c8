"""One solve with its proof: what it asked for, what it took, and what it reached."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from enum import StrEnum

from benchmarks.workload import Row
from benchmarks.workloads.fields.scenes import Scene

__all__ = ["Memory", "Purpose", "Record", "from_rows", "to_row"]


class Purpose(StrEnum):
    """What a solve is run for."""

    FIELD = "field"
    TIGHT = "tight"
    HURRIED = "hurried"


@dataclass(frozen=True, slots=True, kw_only=True)
class Record:
    """A solve, with the bound that it gave.

    Args:
        purpose: which of the workload's questions it answers.
        scene: the scene, its airspace unbounded horizontally.
        gap: relative gap asked for.
        time_limit_s: seconds that it had.
        seconds: wall-clock time of the whole Python call.
        boxes: boxes examined.
        status: ``"certified"``, or how else it ended; an error has its name here.
        value: smallest SINR at the pose, evaluated by nullpose's physics; 0 without a pose.
        bound: what no pose is said to exceed; infinite without one.
    """

    purpose: Purpose
    scene: Scene
    gap: float
    time_limit_s: float
    seconds: float = 0.0
    boxes: int = 0
    status: str
    value: float = 0.0
    bound: float = float("inf")

    @property
    def closed(self) -> bool:
        """Whether the gap was reached in time, and the bound is not below the pose's own value."""
        return self.status == "certified" and self.value <= self.bound <= self.value * (
            1.0 + 1.001 * self.gap
        )

    @property
    def gap_reached(self) -> float:
        """The relative gap between bound and value."""
        return self.bound / self.value - 1.0 if self.value > 0.0 else float("inf")


@dataclass(frozen=True, slots=True, kw_only=True)
class Memory:
    """Resident memory of the process that ran all solves.

    Args:
        loaded_mb: most until the first solve was done, that is interpreter, libraries and kernels, in 1e6 B.
        peak_mb: most of the whole run, in 1e6 B.
    """

    loaded_mb: float
    peak_mb: float


def to_row(found: Record | Memory) -> Row:
    """Return a record or the memory as plain data."""
    return asdict(found)


def from_rows(rows: list[Row]) -> tuple[list[Record], Memory]:
    """Return the records that rows came from, and the memory."""
    memory = next((Memory(**row) for row in rows if "peak_mb" in row), None)
    nothing = Memory(loaded_mb=float("nan"), peak_mb=float("nan"))
    records = [
        Record(**{**row, "purpose": Purpose(row["purpose"]), "scene": Scene(**row["scene"])})
        for row in rows
        if "peak_mb" not in row
    ]
    return records, memory or nothing
