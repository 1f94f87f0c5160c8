"""What the page last told of each workload, so that a partial run leaves the rest of the page standing."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from benchmarks.metric import Direction, Metric, Tolerance
from benchmarks.workload import Section

__all__ = ["TOLD", "Told", "load_told", "write_told"]

TOLD = Path(__file__).with_name("told.json")


@dataclass(frozen=True, slots=True, kw_only=True)
class Told:
    """A workload's part of the page, as it was written after it ran.

    Args:
        title: its heading.
        machine: what it ran on, and when; pairs of name and text.
        metrics: its numbers.
        section: its text, settings and limitations; its figures lie where the text says.
        remark: a sentence on what has changed since; may be empty.
    """

    title: str
    machine: Mapping[str, str]
    metrics: tuple[Metric, ...]
    section: Section
    remark: str = ""

    @property
    def note(self) -> str:
        """When it was measured, for the head of its section."""
        when = f"{self.machine.get('date (UTC)', 'unknown date')}, {self.machine.get('source', '')}"
        remark = f" {self.remark}" if self.remark else ""
        return f"**Measured earlier and not again since: {when}.**{remark}"


def load_told(path: Path = TOLD) -> dict[str, Told]:
    """Return what was told of each workload, by name; nothing if there is no record yet."""
    if not path.exists():
        return {}
    return {
        name: _from_dict(content) for name, content in json.loads(path.read_text(encoding="utf-8")).items()
    }


def write_told(fresh: Mapping[str, Told], path: Path = TOLD) -> None:
    """Record what is told of a run, other workloads staying as they are.

    Args:
        fresh: what is told of each workload that ran, by name.
        path: the file.
    """
    content = {name: asdict(told) for name, told in {**load_told(path), **fresh}.items()}
    path.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")


def _from_dict(content: Mapping[str, Any]) -> Told:
    section = content["section"]
    pairs: Iterable[Iterable[str]] = section["settings"]
    return Told(
        title=content["title"],
        machine=content["machine"],
        metrics=tuple(_metric(entry) for entry in content["metrics"]),
        section=Section(
            **{
                **section,
                "settings": tuple((name, text) for name, text in pairs),
                "limitations": tuple(section["limitations"]),
            }
        ),
        remark=content["remark"],
    )


def _metric(entry: Mapping[str, Any]) -> Metric:
    return Metric(
        **{
            **entry,
            "direction": Direction(entry["direction"]),
            "tolerance": Tolerance(**entry["tolerance"]),
        }
    )
