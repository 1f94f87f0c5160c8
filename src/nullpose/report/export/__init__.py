"""The pose of a result for other programs: a file in the format that its ending names."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from nullpose.errors import require_usage
from nullpose.files import replacing
from nullpose.report.export.geojson import geojson_file
from nullpose.report.export.kml import kml_file
from nullpose.report.export.mcap import mcap_file, require_foxglove
from nullpose.report.export.places import require_origin
from nullpose.report.export.plain import csv_file, json_file, tum_file
from nullpose.report.export.plan import loss_words, plan_file
from nullpose.scenario import Scenario
from nullpose.solver import Result


@dataclass(frozen=True, slots=True)
class ExportFormat:
    """A format in which a pose is handed over.

    Args:
        content: from a result: the bytes of the file.
        require: raises a UsageError if a scenario, or this machine, lacks what the format needs.
        loss_words: from a result: a sentence on what the format cannot hold; empty if it holds the pose.
    """

    content: Callable[[Result], bytes]
    require: Callable[[Scenario], object] = lambda _: None
    loss_words: Callable[[Result], str] = lambda _: ""


EXPORTS = {
    ".json": ExportFormat(json_file),
    ".tum": ExportFormat(tum_file),
    ".csv": ExportFormat(csv_file),
    ".geojson": ExportFormat(geojson_file, require_origin),
    ".kml": ExportFormat(kml_file, require_origin),
    ".plan": ExportFormat(plan_file, require_origin, loss_words),
    ".mcap": ExportFormat(mcap_file, require_foxglove),
}
"""The formats, by the ending of a file's name."""


def export_format(path: Path) -> ExportFormat:
    """Look up the format that a file's ending names.

    Raises:
        UsageError: no format has that ending.
    """
    require_usage(
        path.suffix.lower() in EXPORTS, f"--export: given {path}; allowed endings: {', '.join(EXPORTS)}"
    )
    return EXPORTS[path.suffix.lower()]


def require_exports(scenario: Scenario, paths: Iterable[Path]) -> None:
    """Make sure, before a solve, that each file's format is known and has what it needs.

    Raises:
        UsageError: an unknown ending, or a format lacks an origin or a package.
    """
    for form in [export_format(path) for path in paths]:
        form.require(scenario)


def write_export(result: Result, path: Path) -> str:
    """Write a result's pose to a file, whole or not at all; return what the format cannot hold, in words.

    Raises:
        UsageError: an unknown ending, or the format lacks an origin or a package.
        OutputError: the file cannot be written.
    """
    form = export_format(path)
    form.require(result.scenario)
    with replacing(path) as temporary:
        temporary.write_bytes(form.content(result))
    return form.loss_words(result)
