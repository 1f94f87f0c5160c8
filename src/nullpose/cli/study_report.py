"""The verb ``study report``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nullpose.cli.options import JsonOutput
from nullpose.cli.output import tell
from nullpose.cli.study import StudyFolder

if TYPE_CHECKING:
    from nullpose.report.study import StudyReport


def report(
    folder: StudyFolder,
    requirement_db: Annotated[
        float | None,
        typer.Option(
            "--requirement-db",
            metavar="X",
            help="Outage: a value in dB (margin, if nodes have min_sinr_db) below X dB.",
            show_default="no outage for SINR, 0 dB for margins",
        ),
    ] = None,
    requirement_bps_hz: Annotated[
        float | None,
        typer.Option(
            "--requirement-bps-hz",
            metavar="X",
            help="Outage: a rate below X bits/s/Hz.",
            show_default=False,
        ),
    ] = None,
    against: Annotated[
        str | None,
        typer.Option(
            "--against",
            metavar="CASE",
            help="Case that the gains refer to.",
            show_default="level-vertical, or the first case",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="FOLDER", help="Folder of the report.", show_default="DIR/report"),
    ] = None,
    json_output: JsonOutput = False,
) -> None:
    """Write the report of a study: text, figures and tables.

    As Markdown, HTML and CSV.
    """
    from nullpose.report.study import report_study

    written = report_study(
        folder,
        out=out,
        requirement_db=requirement_db,
        requirement_bps_hz=requirement_bps_hz,
        against=against,
    )
    tell(written, _words, json_output, broken=True)


def _words(written: StudyReport) -> str:
    """Write the answer, after a note if the study is not finished, and the paths of the files."""
    lines = (*written.notes[: not written.summary.is_complete], written.answer)
    return "\n".join([*(f"{line}\n" for line in lines), *map(str, written.files)])
