"""What a workload is: it measures rows, and turns rows into metrics and a section of the report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from benchmarks.metric import Metric

__all__ = ["Progress", "Row", "Section", "Workload"]

Row = Mapping[str, Any]
"""One measurement as plain data for JSON. A failure is a row too."""


class Progress(Protocol):
    """Where a workload says how far it is."""

    def begin(self, total: int) -> None:
        """Announce how many steps there are."""

    def step(self, doing: str) -> None:
        """Report a step done, and what it was."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """A workload's part of the report.

    Args:
        text: Markdown below the workload's heading.
        settings: what was run with which settings, as (name, sentence).
        limitations: what the figures do not show, one sentence each.
        headline: a sentence for the opening of the page; may be empty.
    """

    text: str
    settings: tuple[tuple[str, str], ...] = ()
    limitations: tuple[str, ...] = ()
    headline: str = ""


class Workload(Protocol):
    """Something to measure. Measuring and describing are apart: a stored run can be described again."""

    name: str
    title: str

    def measure(self, *, quick: bool, progress: Progress) -> list[Row]:
        """Return the measurements, one row each, failures included.

        Args:
            quick: a smaller sample, to see that everything runs; its figures are no evidence.
            progress: told of every step.
        """

    def metrics(self, rows: Sequence[Row]) -> tuple[Metric, ...]:
        """Return the numbers that the rows are judged by."""

    def section(self, rows: Sequence[Row], images: Path) -> Section:
        """Return the part of the report on the rows, its figures written to a folder.

        Args:
            rows: as measured.
            images: an existing folder; the text refers to it as ``images/``.
        """
