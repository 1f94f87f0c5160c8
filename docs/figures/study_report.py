"""Bring the pages on studies up to date: `python docs/figures/study_report.py out/study out/motion`.

From the folder of the study of ``examples/study.toml``: its pictures into ``docs/images/study-report-*.png``,
its summary, its three numbers, its sentences and its table beside this script. From that of
``examples/study-motion.toml``: ``docs/images/study-motion.png``.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from twins import darken

from nullpose.files import write_text
from nullpose.report.study import report_study

FOLDER = Path(__file__).parent
IMAGES = FOLDER.parent / "images"
REQUIREMENT_DB = 0.0


def main(study: Path) -> None:
    """Write pictures, summary, numbers, sentences and table of a study's report.

    Args:
        study: its folder.
    """
    with TemporaryDirectory() as folder:
        report = report_study(study, out=folder, requirement_db=REQUIREMENT_DB)
        for image in (Path(folder) / "figures").glob("*.png"):
            darken(Path(shutil.copyfile(image, IMAGES / f"study-report-{image.name}")))
        shutil.copyfile(Path(folder) / "summary.csv", FOLDER / "study-report.csv")
        lines = (Path(folder) / "report.md").read_text(encoding="utf-8").splitlines()
    write_text(FOLDER / "study-report-answer.txt", " ".join([report.answer, *report.notes]) + "\n")
    tables = [line for line in lines if line.startswith("|")]
    numbers, table = tables[:3], tables[3:]
    write_text(FOLDER / "study-report-numbers.txt", "\n".join(numbers) + "\n")
    last = table[:2] + table[-len(report.summary.cases) :]
    write_text(FOLDER / "study-report-table.txt", "\n".join(last) + "\n")


def draw_motion(study: Path) -> None:
    """Write the distributions of the study of hovers and flights.

    Args:
        study: its folder.
    """
    with TemporaryDirectory() as folder:
        report_study(study, out=folder)
        image = Path(folder) / "figures" / "distribution.png"
        darken(Path(shutil.copyfile(image, IMAGES / "study-motion.png")))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
    draw_motion(Path(sys.argv[2]))
