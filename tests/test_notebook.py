"""In a notebook every object is told in a line, shown as a table, and handed to pandas and xarray."""

import numpy as np
import pytest

import nullpose
from nullpose import notebook
from nullpose.report.comparison import compare_all
from nullpose.study import value_map

SCENE = nullpose.Scenario.from_arrays(
    [[0, 0, 0], [0, 50, 0]], [[17, 15, 4]], noise_w=1e-3, altitude_m=(8, 30), name="a <scene>"
)
RESULT = nullpose.solve(SCENE)
CASES = nullpose.compare(SCENE, certify=False)
TABLE = nullpose.sweep(SCENE, "jammers.M1.power_w", [0.5, 2.0], certify=False)
VEHICLES = nullpose.compare_airframes(SCENE, certify=False)
LEVEL = nullpose.Airframe(preset="level")
MANY = nullpose.solve_many([SCENE] * 30, airframes=[None, LEVEL], certify=False)
POSES = nullpose.evaluate_against(RESULT, [nullpose.Pose([0.0, y, 9.0], 0.0, 1.0) for y in range(5, 45)])


@pytest.mark.parametrize(
    "found", [SCENE, RESULT, TABLE, VEHICLES, MANY, POSES, value_map(RESULT, cells=9), TABLE.rows[0]]
)
def test_a_line_tells_what_it_is(found: object) -> None:
    """One line of less than 200 characters, with the type's name first."""
    line = repr(found)
    assert line.startswith(f"{type(found).__name__}(")
    assert len(line) < 200
    assert "\n" not in line


def test_what_the_lines_say() -> None:
    """A scenario its size, a result its value and bound."""
    assert repr(SCENE) == "Scenario('a <scene>': 2 nodes, 1 jammer, min-sinr, altitude 8 to 30 m)"
    assert repr(RESULT).startswith("Result(Optimum, certified: smallest SINR 0.9836997 dB, at most 0.98370")


def test_many_answers_are_printed_in_a_few_lines() -> None:
    """A line, a table in dB of 80 columns, and how many rows there are beside: no flood of arrays."""
    line, head, *rows, more = str(MANY).splitlines()
    assert line == repr(MANY)
    assert "60 best-found" in line
    assert len(rows) == 10
    assert more.startswith("50 more rows")
    assert max(map(len, str(MANY).splitlines())) <= 80
    cells = dict(zip(head.split(), rows[1].split(), strict=False))
    assert float(cells["value_db"]) == pytest.approx(10.0 * np.log10(MANY.value[0, 1]), rel=1e-5)
    assert "nan" not in str(MANY)
    frame = MANY.frame()
    assert (len(frame), frame["vehicle"].tolist()[:2]) == (60, [0, 1])
    assert frame["value_db"].to_numpy() == pytest.approx(10.0 * np.log10(MANY.value.ravel()))
    assert frame["x_m"].tolist() == MANY.position_m[..., 0].ravel().tolist()


@pytest.mark.parametrize(
    "found", [SCENE, RESULT, CASES, TABLE, VEHICLES, MANY, compare_all(SCENE, certify=False)]
)
def test_a_table_in_html(found: object) -> None:
    """Names are escaped, and every row has as many cells as there are headings."""
    text = found._repr_html_()  # type: ignore[attr-defined]
    assert "<scene>" not in text
    head, *rows = text.split("<tr>")[1:]
    assert rows
    assert {row.count("<td>") for row in rows} == {head.count("<th>")}


def test_frames_have_the_numbers() -> None:
    """Of links, cases, vehicles and sweeps, by names with units."""
    assert RESULT.frame()["sinr_db"].tolist() == [link.sinr_db for link in RESULT.links]
    expected = [one.objective.value_db for one in CASES]
    assert CASES.frame()["min_sinr_db"].tolist() == pytest.approx(expected)
    assert VEHICLES.frame()["vehicle"].tolist() == [one.case.label for one in VEHICLES.results]
    frame = TABLE.frame()
    assert frame["jammers.M1.power_w"].tolist() == [row.value for row in TABLE.rows]
    assert frame["min_sinr_db"].tolist() == [row.min_sinr_db for row in TABLE.rows]


def test_grids_become_arrays() -> None:
    """A sweep over setting and scheme, a map over north and east."""
    swept = TABLE.to_xarray()
    assert dict(swept.sizes) == {"jammers.M1.power_w": 2, "scheme": 4}
    assert float(
        swept["min_sinr_db"].sel({"jammers.M1.power_w": 2.0, "scheme": "vertical"})
    ) == pytest.approx(TABLE.of("vertical")[1].min_sinr_db)
    field = value_map(RESULT, cells=9)
    array = field.to_xarray()
    np.testing.assert_array_equal(array.values, field.values)
    assert (array.dims, array.name) == (("y_m", "x_m"), "min_sinr_db")


def test_a_sweep_says_what_it_left_out() -> None:
    """With the reason, in the line and in the table."""
    calm = SCENE.model_copy(update={"jammers": ()})
    table = nullpose.sweep(calm, "receiver.noise_w", [1e-3, 1e-2], certify=False)
    for text in (repr(table), table._repr_html_()):
        assert "left out: zero-interference (" in text


def test_without_pandas_the_message_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """As an error of nullpose."""

    def missing(name: str) -> None:
        raise ImportError(name)

    monkeypatch.setattr(notebook, "import_module", missing)
    with pytest.raises(nullpose.NullposeError, match="pip install pandas"):
        TABLE.frame()
