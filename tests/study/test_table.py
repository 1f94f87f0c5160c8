"""The table of a sweep: rows found again, joined and written with units."""

import csv
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from nullpose import Link, Pose, Status
from nullpose.objectives import RECORDS, USUAL
from nullpose.solver import Objective
from nullpose.solver.result import Stats
from nullpose.study import Case, ResultRow, ResultTable


def row(value: float, scheme: str, db: float = 0.0, node: str = "S1") -> ResultRow:
    """Returns a row with an easy pose."""
    ratio = 10.0 ** (db / 10.0)
    pose = Pose(np.array([1.0, 2.0, 8.0]), roll_rad=0.0, pitch_rad=math.pi / 2)
    objective = Objective(quantity=RECORDS[USUAL].quantities[0], value=ratio, value_db=db)
    return ResultRow(
        value=value,
        case=Case(name=scheme, scheme=scheme),
        scenario=None,
        scheme=scheme,
        status=Status.BEST_FOUND,
        objective=objective,
        pose=pose,
        links=(Link(node, {"sinr": ratio, "sinr_db": db}),),
        stats=Stats(wall_s=0.0, starts=1, evaluations=1),
        provenance={},
        note="a, note",
    )


def proved(row: ResultRow, relative_gap: float) -> ResultRow:
    """Returns the row with a bound."""
    bound = row.min_sinr * (1.0 + relative_gap)
    objective = replace(row.objective, upper_bound=bound, relative_gap=relative_gap)
    return replace(row, status=Status.CERTIFIED, objective=objective)


TABLE = ResultTable("receiver.noise_w", tuple(row(v, s) for v in (1.0, 2.0) for s in ("optimum", "vertical")))


def test_values_and_schemes_come_once_in_order() -> None:
    """Each value and each scheme is listed once."""
    assert TABLE.values == (1.0, 2.0)
    assert TABLE.names == ("optimum", "vertical")
    assert [r.value for r in TABLE.of("vertical")] == [1.0, 2.0]


def test_unknown_scheme() -> None:
    """Asking for a scheme that was not swept names those that were."""
    with pytest.raises(KeyError, match=r"no case .*optimum, vertical"):
        TABLE.of("maximum-gain")


def test_csv_reads_back_to_the_last_digit(tmp_path: Path) -> None:
    """Numbers survive the file, angles in degrees, names with commas and notes quoted."""
    table = ResultTable("receiver.noise_w", (row(1 / 3, "optimum", db=-1 / 7, node='gate, "north"'),))
    path = table.write_csv(tmp_path / "t.csv")
    with path.open(encoding="utf-8", newline="") as file:
        (read,) = csv.DictReader(file)
    assert float(read["receiver.noise_w"]) == 1 / 3
    assert float(read["min_sinr_db"]) == table.rows[0].min_sinr_db == pytest.approx(-1 / 7)
    assert float(read["pitch_deg"]) == pytest.approx(90.0)
    assert float(read['sinr_gate, "north"_db']) == -1 / 7
    assert [float(read[name]) for name in ("x_m", "y_m", "z_m")] == [1.0, 2.0, 8.0]
    assert float(read["axis_x"]) == pytest.approx(1.0)
    assert read["note"] == "a, note"


def test_plain_data() -> None:
    """The table as plain data keeps rows, poses and what was left out."""
    data = ResultTable("receiver.noise_w", TABLE.rows[:1], {"zero-interference": "no jammer"}).to_dict()
    assert data["left_out"] == [{"case": "zero-interference", "reason": "no jammer"}]
    assert data["rows"][0]["pose"]["position_m"] == [1.0, 2.0, 8.0]
    assert data["rows"][0]["links"] == [{"node": "S1", "sinr": 1.0, "sinr_db": 0.0}]


def test_bounds_are_columns(tmp_path: Path) -> None:
    """A proved row has its bound in dB and its gap; a row of which nothing is proved has empty cells."""
    open_row = replace(row(2.0, "vertical"), reason="the time limit, 60 s")
    table = ResultTable("receiver.noise_w", (proved(row(1.0, "optimum", db=1.0), 1e-6), open_row))
    path = table.write_csv(tmp_path / "t.csv")
    with path.open(encoding="utf-8", newline="") as file:
        first, second = csv.DictReader(file)
    assert (first["status"], first["relative_gap"], first["reason"]) == ("certified", "1e-06", "")
    assert float(first["upper_bound_db"]) == pytest.approx(1.0 + 10.0 * math.log10(1.0 + 1e-6), abs=1e-12)
    assert (second["status"], second["upper_bound_db"], second["relative_gap"]) == ("best-found", "", "")
    assert second["reason"] == "the time limit, 60 s"
    plain = [data["upper_bound_db"] for data in table.to_dict()["rows"]]
    assert plain == [table.rows[0].upper_bound_db, None]
    assert table.to_dict()["rows"][0]["upper_bound"] == 10**0.1 * (1.0 + 1e-6)
