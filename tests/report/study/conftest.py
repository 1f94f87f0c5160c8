"""Studies whose rows are made up, so that every statistic is known beforehand."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

from nullpose.report.study.cases import report_cases
from nullpose.report.study.summary import Summary, summarise
from nullpose.study.monte_carlo import StudySpec, read_study
from nullpose.study.monte_carlo.folder import Folder
from nullpose.study.monte_carlo.rows import Row, as_parquet, row_of

TABLES: dict[str, Any] = {
    "name": "made up",
    "seed": 3,
    "gap": 1e-3,
    "scene": {
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
    },
    "nodes": {"layout": "disc", "count": 2, "centre_m": [0.0, 0.0], "radius_m": 50.0, "power_w": 2.0},
    "jammers": {
        "layout": "disc",
        "name": "M",
        "count": 1,
        "centre_m": [0.0, 25.0],
        "radius_m": 60.0,
        "power_w": 1.0,
    },
}

VEHICLES = ("level-vertical", "tilt-10-horizontal", "omnidirectional")
CASES = [{"name": name, "airframe": name} for name in VEHICLES]

Cell = float | tuple[float, str] | str
Make = Callable[..., Path]


def made_row(scene: int, point: int, case: str, cell: Cell) -> Row:
    """Return a row: a value in dB, certified; a value and its status; or the reason of a failure."""
    if isinstance(cell, str):
        return row_of(scene, point, case, "failed", reason=cell)
    level_db, status = cell if isinstance(cell, tuple) else (cell, "certified")
    value = 10.0 ** (level_db / 10.0)
    gap = {"certified": 1e-3, "gap-not-reached": 0.5, "best-found": None, "given": None}[status]
    return row_of(
        scene,
        point,
        case,
        status,
        value=value,
        bound=None if gap is None else value * (1.0 + gap),
        gap=gap,
        x_m=0.0,
        y_m=1.0,
        z_m=10.0,
        roll_rad=0.1,
        pitch_rad=0.2,
        yaw_rad=0.0,
        null_gain=10.0 ** -(2 + scene % 4),
        binding_node="S1",
        boxes=100,
        seconds=0.01 * (scene + 1),
        reason="time limit" if status == "gap-not-reached" else "",
    )


@pytest.fixture
def make(tmp_path: Path) -> Make:
    """Writes a study whose rows are those given, by scene, point and case; in parts of four scenes."""

    def made(
        cells: Sequence[Sequence[Sequence[Cell]]],
        *,
        cases: Sequence[Mapping[str, Any]] = CASES,
        scenes: int | None = None,
        **tables: Any,
    ) -> Path:
        whole = copy.deepcopy(TABLES) | {"scenes": scenes or max(1, len(cells)), "cases": list(cases)}
        whole = {key: value for key, value in (whole | tables).items() if value is not None}
        spec = StudySpec.from_dict(whole)
        folder, chunk = Folder(tmp_path / "study"), 4 if scenes is None else 1
        folder.parts_folder.mkdir(parents=True)
        folder.write_manifest(spec, chunk, {"nullpose": "0"})
        for first in range(0, len(cells), chunk):
            last = min(first + chunk, len(cells)) - 1
            rows = [
                made_row(scene, point, case, cell)
                for scene in range(first, last + 1)
                for point, at_point in enumerate(cells[scene])
                for case, cell in zip(spec.case_names, at_point, strict=True)
            ]
            folder.add(first, last, as_parquet(spec, rows, 1.0))
        return tmp_path / "study"

    return made


@pytest.fixture
def summed(make: Make) -> Callable[..., Summary]:
    """The statistics of a study that is made up."""

    def summed_up(
        cells: Any, *, requirement: float | None = None, against: str | None = None, **given: Any
    ) -> Summary:
        table = read_study(make(cells, **given))
        return summarise(table, report_cases(table.spec, against), requirement)

    return summed_up


@pytest.fixture(scope="session")
def ladder() -> Callable[..., list[list[list[float]]]]:
    """Scenes at -1, -2, ... dB of the first case, the others so much above, the same at each point."""

    def rows(count: int, *offsets_db: float, points: int = 1) -> list[list[list[float]]]:
        return [
            [[offset - scene - 1.0 for offset in (0.0, *offsets_db)] for _ in range(points)]
            for scene in range(count)
        ]

    return rows
