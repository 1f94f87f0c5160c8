"""The verb ``verify``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from nullpose.certificate import Certificate
    from nullpose.report.document import View

from nullpose.cli.faults import INTERNAL
from nullpose.cli.options import AllowOutside, JsonOutput
from nullpose.cli.output import show, show_json
from nullpose.cli.printing import say
from nullpose.cli.progress import Ticker


def verify(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="Certificate from solve --certificate.", show_default=False)
    ],
    scenario: Annotated[
        Path | None,
        typer.Option(
            "--scenario",
            metavar="FILE",
            help="Compare the certificate's scenario with this one (TOML), and say what differs.",
            show_default=False,
        ),
    ] = None,
    allow_outside: AllowOutside = False,
    show_scenario: Annotated[
        bool, typer.Option("--show", help="Print the certificate's scenario too, as check does.")
    ] = False,
    json_output: JsonOutput = False,
) -> None:
    """Check a certificate.

    The check uses interval arithmetic and imports nothing from the solver.
    """
    from nullpose.certificate import differences, read_certificate, subject, verify as verify_certificate
    from nullpose.report.scenario import scenario_view
    from nullpose.scenario import load

    certificate = read_certificate(file)
    unlike: tuple[str, ...] = ()
    if scenario is not None:
        scene = load(scenario, allow_outside=allow_outside)
        at_s = certificate.scenario.at_s if scene.time else None
        unlike = differences(certificate, scene if certificate.instants else scene.still(at_s))
    with Ticker("checking leaves") as ticker:
        verdict = verify_certificate(certificate, on_progress=ticker)
    if json_output:
        about = {} if scenario is None else {"about_scenario": not unlike, "differences": list(unlike)}
        checked = {"proved": verdict.proved, "message": verdict.message, "leaves": verdict.leaves}
        show_json(checked | about | subject(certificate))
    else:
        if verdict.proved:
            show(_proved_view(certificate, verdict.leaves))
        else:
            say(verdict.message, err=True)
        if show_scenario:
            show(scenario_view(certificate.scenario))
        if scenario is not None:
            words = (
                f"not about {scenario}, which differs:" if unlike else f"about {scenario}: nothing differs"
            )
            say("\n  ".join([words, *unlike]), err=bool(unlike))
    if unlike or not verdict.proved:
        raise typer.Exit(INTERNAL)


def _proved_view(certificate: Certificate, leaves: int) -> View:
    from rich.text import Text

    from nullpose.certificate.subject import claim_numbers, claim_words, gives, subject
    from nullpose.report.document import document, head, pairs
    from nullpose.report.numbers import capitalised

    most, least, near = claim_numbers(certificate)
    claim, what, instants = claim_words(certificate), gives(certificate), certificate.instants
    return document(
        head(certificate.scenario.name),
        Text("PROVED", style="bold green"),
        pairs(
            "",
            [
                ("upper bound", most),
                ("pose's value", least),
                ("gap", near),
                ("boxes checked", f"{leaves:,}"),
                *([("instants", f"{len(instants)} in the proof")] if instants else []),
                ("scheme", certificate.scheme),
                ("SHA-256", subject(certificate)["scenario_sha256"]),
            ],
        ),
        capitalised(f"{claim} above the bound. The stated pose {what} the pose's value."),
    )
