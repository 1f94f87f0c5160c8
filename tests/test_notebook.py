"""In a notebook every object is told in a line, shown as a table, and handed to pandas and xarray."""

from functools import cache
from typing import Any

import numpy as np
import pytest

import nullpose
from nullpose import notebook
from nullpose.study import value_map

SCENE = nullpose.Scenario.from_arrays(
    [[0, 0, 0], [0, 50, 0]], [[17, 15, 4]], noise_w=1e-3, altitude_m=(8, 30), name="a <scene>"
)
LEVEL = nullpose.Airframe(preset="level")


@cache
def made(name: str) -> Any:
    """Return what a function of the package gives for the scene."""
    return {
        "scene": lambda: SCENE,
        "result": lambda: nullpose.solve(SCENE),
        "cases": lambda: nullpose.compare(SCENE, certify=False),
        "table": lambda: nullpose.sweep(SCENE, "jammers.M1.power_w", [0.5, 2.0], certify=False),
        "row": lambda: made("table").rows[0],
        "vehicles": lambda: nullpose.compare_airframes(SCENE, certify=False),
        "many": lambda: nullpose.solve_many([SCENE] * 30, airframes=[None, LEVEL], certify=False),
        "poses": lambda: nullpose.evaluate_against(
            made("result"), [nullpose.Pose([0.0, y, 9.0], 0.0, 1.0) for y in range(5, 45)]
        ),
        "map": lambda: value_map(made("result"), cells=9),
    }[name]()


@pytest.mark.parametrize("name", ["scene", "result", "table", "vehicles", "many", "poses", "map", "row"])
def test_a_line_tells_what_it_is(name: str) -> None:
    """One line of less than 200 characters, with the type's name first."""
    found = made(name)
    line = repr(found)
    assert line.startswith(f"{type(found).__name__}(")
    assert len(line) < 200
    assert "\n" not in line


def test_many_answers_have_a_frame() -> None:
    """A row for each scene and vehicle, in dB and metres."""
    many = made("many")
    assert "60 best-found" in repr(many)
    frame = many.frame()
    assert (len(frame), frame["vehicle"].tolist()[:2]) == (60, [0, 1])
    assert frame["value_db"].to_numpy() == pytest.approx(10.0 * np.log10(many.value.ravel()))
    assert frame["x_m"].tolist() == many.position_m[..., 0].ravel().tolist()


@pytest.mark.parametrize("name", ["cases", "table", "vehicles", "many"])
def test_tables_are_html(name: str) -> None:
    """Names are escaped, and a long table is cut."""
    text = made(name)._repr_html_()
    assert "<table" in text
    assert "<scene>" not in text
    assert text.count("<tr") < 50


def test_frames_have_the_numbers() -> None:
    """Of links, cases, vehicles and sweeps, by names with units."""
    result, cases, vehicles, table = map(made, ("result", "cases", "vehicles", "table"))
    assert result.frame()["sinr_db"].tolist() == [link.sinr_db for link in result.links]
    expected = [one.objective.value_db for one in cases]
    assert cases.frame()["min_sinr_db"].tolist() == pytest.approx(expected)
    assert vehicles.frame()["case"].tolist() == [row.case.label for row in vehicles.rows]
    frame = table.frame()
    assert frame["jammers.M1.power_w"].tolist() == [row.value for row in table.rows]
    assert frame["min_sinr_db"].tolist() == [row.min_sinr_db for row in table.rows]


def test_grids_become_arrays() -> None:
    """A sweep over setting and scheme, a map over north and east."""
    table = made("table")
    swept = table.to_xarray()
    assert dict(swept.sizes) == {"jammers.M1.power_w": 2, "scheme": 4}
    assert float(
        swept["min_sinr_db"].sel({"jammers.M1.power_w": 2.0, "scheme": "vertical"})
    ) == pytest.approx(table.of("vertical")[1].min_sinr_db)
    field = made("map")
    array = field.to_xarray()
    np.testing.assert_array_equal(array.values, field.values)
    assert (array.dims, array.name) == (("y_m", "x_m"), "min_sinr_db")


def test_a_sweep_says_what_it_left_out() -> None:
    """With the reason."""
    calm = SCENE.model_copy(update={"jammers": ()})
    table = nullpose.sweep(calm, "receiver.noise_w", [1e-3, 1e-2], certify=False)
    assert "left out: zero-interference (" in repr(table)


def test_without_pandas_the_message_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """As an error of nullpose; a notebook shows the plain text."""
    table = made("table")

    def missing(name: str) -> None:
        raise ImportError(name)

    monkeypatch.setattr(notebook, "import_module", missing)
    assert table._repr_html_() is None
    with pytest.raises(nullpose.NullposeError, match="pip install pandas"):
        table.frame()
