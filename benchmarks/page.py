"""docs/benchmarks.md, written from ``results.json``: tables of each workload and the machine they are of."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pandas as pd

from benchmarks.machine import ROOT

RESULTS = Path(__file__).with_name("results.json")
PAGE = ROOT / "docs" / "benchmarks.md"

_HEAD = """# Benchmarks

Written by `make bench` (`python -m benchmarks --page`) from `benchmarks/results.json`, not by hand. Times are of the
machine that is named; ratios depend less on it. `benchmarks/README.md` says how to run a part of it, and which programs
look for false bounds and false certificates.
"""  # noqa: E501


def store(
    name: str, title: str, about: str, tables: dict[str, pd.DataFrame], machine: dict[str, str]
) -> None:
    """Put the tables of a workload in place of those that ``results.json`` has."""
    results = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
    kept = {heading: frame.to_dict("split", index=False) for heading, frame in tables.items()}
    results[name] = {"title": title, "about": about, "machine": machine, "tables": kept}
    RESULTS.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")


def write_page() -> None:
    """Write docs/benchmarks.md from the stored tables."""
    results = json.loads(RESULTS.read_text(encoding="utf-8"))
    sections = [_section(workload) for workload in results.values()]
    PAGE.write_text("\n".join([_HEAD, *sections]), encoding="utf-8")


def _section(workload: dict[str, Any]) -> str:
    parts = [f"## {workload['title']}", workload["about"]]
    for heading, table in workload["tables"].items():
        frame = pd.DataFrame(table["data"], columns=table["columns"])
        parts += [f"**{heading}**" if len(workload["tables"]) > 1 else "", markdown(frame)]
    parts.append(
        "Measured on " + "; ".join(f"{key}: {value}" for key, value in workload["machine"].items()) + "."
    )
    return "\n\n".join(part for part in parts if part) + "\n"


def markdown(frame: pd.DataFrame) -> str:
    """Lay a frame out as a Markdown table, texts to the left and numbers to the right."""
    numeric = [pd.api.types.is_numeric_dtype(kind) for kind in frame.dtypes]
    rows = [frame.columns, ["--:" if number else ":--" for number in numeric]]
    rows += [[_cell(value) for value in row] for row in frame.itertuples(index=False)]
    return "\n".join("| " + " | ".join(map(str, row)) + " |" for row in rows)


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:,.0f}" if abs(value) >= 1000.0 else f"{value:.3g}"
    return f"{value:,}" if isinstance(value, int) else str(value)
