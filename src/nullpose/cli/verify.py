"""The verb ``verify``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from nullpose.cli.faults import INTERNAL
from nullpose.cli.options import JsonOutput
from nullpose.cli.output import Ticker, show_json

__all__ = ["verify"]


def verify(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="Certificate from solve --certificate.", show_default=False)
    ],
    json_output: JsonOutput = False,
) -> None:
    """Check a certificate by code that shares nothing with the solver, in outward-rounded arithmetic."""
    from nullpose.certificate import read_certificate
    from nullpose.certificate import verify as verify_certificate

    certificate = read_certificate(file)
    with Ticker("checking leaves") as ticker:
        verdict = verify_certificate(certificate, on_progress=ticker)
    if json_output:
        show_json({"proved": verdict.proved, "message": verdict.message, "leaves": verdict.leaves})
    else:
        typer.echo(verdict.message, err=not verdict.proved)
    if not verdict.proved:
        raise typer.Exit(INTERNAL)
