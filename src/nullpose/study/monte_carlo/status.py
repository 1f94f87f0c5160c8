"""How far a study in a folder is, read without touching it."""

from __future__ import annotations

import os
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from nullpose.solve import Rigour
from nullpose.study.monte_carlo.lock import holder
from nullpose.study.monte_carlo.spec import StudySpec
from nullpose.study.monte_carlo.store import Store

__all__ = ["StudyStatus", "study_spec", "study_status"]


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyStatus:
    """How far a study is.

    Args:
        folder: where it is.
        name: its title.
        scenes: how many it has.
        done: how many of them are in parts.
        rows: rows of these.
        failed: how many of those are failures.
        parts: how many parts there are.
        chunk: scenes of a part.
        size: bytes of all parts.
        worked_s: seconds that workers spent on the parts.
        running: who writes the folder now; empty if nobody does.
    """

    folder: str
    name: str
    scenes: int
    done: int
    rows: int
    failed: int
    parts: int
    chunk: int
    size: int
    worked_s: float
    running: str

    @property
    def complete(self) -> bool:
        """Whether all scenes are done."""
        return self.done == self.scenes

    def to_dict(self) -> dict[str, Any]:
        """Return the status as plain data."""
        return asdict(self) | {"complete": self.complete, "rigour": Rigour.FLOATING_POINT.value}


def study_status(out: str | os.PathLike[str]) -> StudyStatus:
    """Return how far the study in a folder is.

    Args:
        out: the folder.

    Raises:
        UsageError: no study is there.
    """
    store = Store(Path(out))
    manifest = store.manifest()
    parts = store.parts()
    return StudyStatus(
        folder=str(out),
        name=manifest["name"],
        scenes=manifest["scenes"],
        done=sum(part.scenes for part in parts),
        rows=sum(part.rows for part in parts),
        failed=sum(part.failed for part in parts),
        parts=len(parts),
        chunk=manifest["chunk"],
        size=sum(part.size for part in parts),
        worked_s=sum(part.seconds for part in parts),
        running=holder(Path(out)),
    )


def study_spec(out: str | os.PathLike[str]) -> StudySpec:
    """Return the spec of the study in a folder.

    Args:
        out: the folder.

    Raises:
        UsageError: no study is there.
    """
    return StudySpec.from_dict(Store(Path(out)).manifest()["spec"], str(out))
