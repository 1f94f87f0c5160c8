"""The paper's Figure 2, a figure of its poses, and its claims checked, written to a folder."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from nullpose.files import check_outputs, write_text
from nullpose.paper.claim import Claim
from nullpose.paper.claims import CLAIMS
from nullpose.paper.figure2 import draw_figure2
from nullpose.paper.pages import Reproduction, claims_markdown
from nullpose.paper.scene import (
    JAMMER_POWER,
    JAMMING_LEVELS,
    POSE_LEVELS,
    PRINTED_LEVELS,
    paper_scenario,
)
from nullpose.paper.study import JammingStudy
from nullpose.report.figures.poses import draw_poses
from nullpose.report.figures.style import write_figure
from nullpose.report.plain import json_text
from nullpose.solve import PAPER_SCHEMES, Scheme
from nullpose.study import sweep

_FILES = ("figure2.png", "figure2.svg", "figure2.csv", "poses.png", "poses.svg", "claims.md", "claims.json")
_CLAIM_STEPS = 20  # a claim takes about as long as so many points of the sweep


def reproduce(
    folder: Path,
    *,
    seed: int = 0,
    levels: Sequence[float] = JAMMING_LEVELS,
    printed_levels: Sequence[float] = PRINTED_LEVELS,
    on_progress: Callable[[int, int], None] | None = None,
) -> Reproduction:
    """Return what the paper's section 4 looks like when computed, after writing it to a folder.

    Every point of the four curves comes with an upper bound.

    Args:
        folder: where the files go; made if it is missing.
        seed: the random seed of every solve.
        levels: P_M/P of the four curves, ascending.
        printed_levels: P_M/P of maximum gain as eq. 3.5 is printed, ascending.
        on_progress: called now and then with how many steps are done and how many there are.

    Raises:
        OutputError: the folder or a file cannot be written; the folder is tried before any work.
    """
    check_outputs({}, {name: folder / name for name in _FILES})
    four_cases = len(levels) * len(PAPER_SCHEMES)
    solves = four_cases + len(printed_levels)

    def told(done: int) -> None:
        if on_progress is not None:
            on_progress(done, solves + len(CLAIMS) * _CLAIM_STEPS)

    scenario = paper_scenario()
    table = sweep(scenario, JAMMER_POWER, levels, seed=seed, on_progress=lambda done, _: told(done)).joined(
        sweep(
            scenario,
            JAMMER_POWER,
            printed_levels,
            schemes=[Scheme.MAXIMUM_GAIN_PRINTED],
            seed=seed,
            on_progress=lambda done, _: told(four_cases + done),
        )
    )
    study = JammingStudy(scenario, table, seed)
    claims: list[Claim] = []
    for claim in CLAIMS:
        claims.append(claim.checked(study))
        told(solves + len(claims) * _CLAIM_STEPS)
    poses = [study.at(Scheme.OPTIMUM, level) for level in POSE_LEVELS]
    found = Reproduction(table, tuple(claims), table.of(Scheme.ZERO_INTERFERENCE)[0].provenance)
    files = (
        *write_figure(draw_figure2(table), folder, "figure2"),
        table.write_csv(folder / "figure2.csv"),
        *write_figure(draw_poses(scenario, poses), folder, "poses"),
        write_text(folder / "claims.md", claims_markdown(found)),
        write_text(folder / "claims.json", json_text(found.claims_dict()) + "\n"),
    )
    return replace(found, files=files)
