"""The verb ``study`` and what it is followed by: ``run``, ``status``, ``show``, ``report``."""

from __future__ import annotations

import signal
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from nullpose.cli.faults import INTERRUPTED
from nullpose.cli.options import AllowOutside, JsonOutput, OutFolder
from nullpose.cli.output import tell
from nullpose.cli.printing import say
from nullpose.cli.progress import StudyBar

if TYPE_CHECKING:
    from nullpose.report.study import StudyReport
    from nullpose.study.monte_carlo import StudyStatus

study = typer.Typer(
    name="study",
    no_args_is_help=True,
    help="Solve many random scenes and report statistics.",
)

StudyFolder = Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a study.", show_default=False)]


@study.command()
def run(
    spec: Annotated[
        Path, typer.Argument(metavar="SPEC", help="Spec of the study (TOML).", show_default=False)
    ],
    out: OutFolder,
    allow_outside: AllowOutside = False,
    scheduler: Annotated[
        str | None,
        typer.Option(
            "--scheduler",
            metavar="ADDRESS",
            help="A running Dask scheduler, as in tcp://host:8786.",
            show_default="processes on this machine",
        ),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(
            "--workers",
            metavar="N",
            help="Number of processes on this machine; 0 works in this process.",
            show_default="one for each processor",
        ),
    ] = None,
    chunk: Annotated[
        int | None,
        typer.Option(
            "--chunk", metavar="N", help="Number of scenes in a chunk.", show_default="about a second of work"
        ),
    ] = None,
    json_output: JsonOutput = False,
) -> None:
    """Solve the scenes of a study, or continue.

    It runs on this machine or a cluster. If it is interrupted, run the same command again to resume.
    """
    from nullpose.study.monte_carlo.folder import require_extra

    require_extra()
    from nullpose.study.monte_carlo import load_spec, run_study

    loaded = load_spec(spec, allow_outside=allow_outside)
    try:
        with StudyBar() as bar:
            found = run_study(loaded, out, scheduler=scheduler, workers=workers, chunk=chunk, on_progress=bar)
    except KeyboardInterrupt:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # a second Ctrl-C must not disturb the end
        say("interrupted; the parts so far are kept, and the same command goes on from there", err=True)
        raise typer.Exit(INTERRUPTED) from None
    tell(found, words_of, json_output)


@study.command()
def status(folder: StudyFolder, json_output: JsonOutput = False) -> None:
    """Show a study's progress."""
    from nullpose.study.monte_carlo import study_status

    tell(study_status(folder), words_of, json_output)


@study.command()
def show(
    folder: StudyFolder,
    scene: Annotated[
        int, typer.Option("--scene", metavar="N", help="Index of the scene, from 0.", show_default=False)
    ],
    point: Annotated[
        int | None,
        typer.Option(
            "--point",
            metavar="N",
            help="Index of a combination of swept values, from 0.",
            show_default="nothing swept",
        ),
    ] = None,
    case: Annotated[
        str | None,
        typer.Option(
            "--case", metavar="NAME", help="Use the vehicle of this case.", show_default="the scene's own"
        ),
    ] = None,
    json_output: JsonOutput = False,
) -> None:
    """Print a scene of a study as a scenario file."""
    from nullpose.errors import require_usage
    from nullpose.study.monte_carlo import draw_scene, scene_at, study_spec

    spec = study_spec(folder)
    scenario = draw_scene(spec, scene) if point is None else scene_at(spec, scene, point)
    if case is not None:
        require_usage(case in spec.case_names, f"case: given {case!r}; allowed: {', '.join(spec.case_names)}")
        scenario = spec.cases[spec.case_names.index(case)].drawn(scenario)
    tell(scenario, lambda scene: scene.to_toml().removesuffix("\n"), json_output)


def words_of(status: StudyStatus) -> str:
    """Write the progress of a study in a few lines."""
    state = f"running: {status.running}" if status.running else "not running"
    state = "complete" if status.complete else state
    lines = [
        *filter(None, [status.name]),
        f"folder     {status.folder}",
        f"scenes     {status.done} of {status.scenes} ({100 * status.done // status.scenes} %), {state}",
        f"rows       {status.rows}, {status.failed} of them failures",
        f"parts      {status.parts} of up to {status.chunk} scenes, {status.size / 1e6:.1f} MB",
        f"work       {timedelta(seconds=round(status.worked_s))} on workers",
    ]
    if not status.complete and not status.running:
        lines.append("nullpose study run with the same spec and folder goes on from there")
    return "\n".join(lines)


@study.command()
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
