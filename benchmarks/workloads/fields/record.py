"""One method on one scene: what it found, how long it took, or why it failed."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from benchmarks.workload import Row
from benchmarks.workloads.fields.scenes import Scene

__all__ = ["OK", "Record"]

OK = "ok"


@dataclass(frozen=True, slots=True, kw_only=True)
class Record:
    """A method's answer at one stopping point of one scene.

    Args:
        scene: the scene.
        method: name of nullpose or a peer.
        stage: the stopping point.
        status: ``"ok"``, or why there is no answer.
        value: smallest SINR at the pose, evaluated by nullpose's physics; 0 without an answer.
        seconds: wall-clock time up to that point.
        evaluations: poses evaluated up to that point.
        pose: x, y, z in metres, roll and pitch in radians; empty without an answer.
        certified: whether the answer is proved to the gap asked for.
    """

    scene: Scene
    method: str
    stage: str
    status: str = OK
    value: float = 0.0
    seconds: float = 0.0
    evaluations: int = 0
    pose: tuple[float, ...] = ()
    certified: bool = False

    def to_row(self) -> Row:
        """Return the record as plain data."""
        return {**asdict(self), "pose": list(self.pose)}

    @classmethod
    def from_row(cls, row: Row) -> Record:
        """Return the record that a row came from."""
        return cls(**{**row, "scene": Scene(**row["scene"]), "pose": tuple(row["pose"])})
