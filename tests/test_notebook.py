"""In a notebook every object is told in a line, shown as a table, and handed to pandas and xarray."""

import numpy as np
import pytest

import nullpose
from nullpose import notebook
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


def test_many_answers_have_a_frame() -> None:
    """A row for each scene and vehicle, in dB and metres."""
    assert "60 best-found" in repr(MANY)
    frame = MANY.frame()
    assert (len(frame), frame["vehicle"].tolist()[:2]) == (60, [0, 1])
    assert frame["value_db"].to_numpy() == pytest.approx(10.0 * np.log10(MANY.value.ravel()))
    assert frame["x_m"].tolist() == MANY.position_m[..., 0].ravel().tolist()


@pytest.mark.parametrize("found", [CASES, TABLE, VEHICLES, MANY])
def test_tables_are_html(found: object) -> None:
    """Names are escaped, and a long table is cut."""
    text = found._repr_html_()  # type: ignore[attr-defined]
    assert "<table" in text
    assert "<scene>" not in text
    assert text.count("<tr") < 50


def test_frames_have_the_numbers() -> None:
    """Of links, cases, vehicles and sweeps, by names with units."""
    assert RESULT.frame()["sinr_db"].tolist() == [link.sinr_db for link in RESULT.links]
    expected = [one.objective.value_db for one in CASES]
    assert CASES.frame()["min_sinr_db"].tolist() == pytest.approx(expected)
    assert VEHICLES.frame()["case"].tolist() == [row.case.label for row in VEHICLES.rows]
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
    """With the reason."""
    calm = SCENE.model_copy(update={"jammers": ()})
    table = nullpose.sweep(calm, "receiver.noise_w", [1e-3, 1e-2], certify=False)
    assert "left out: zero-interference (" in repr(table)


def test_without_pandas_the_message_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """As an error of nullpose; a notebook shows the plain text."""

    def missing(name: str) -> None:
        raise ImportError(name)

    monkeypatch.setattr(notebook, "import_module", missing)
    assert TABLE._repr_html_() is None
    with pytest.raises(nullpose.NullposeError, match="pip install pandas"):
        TABLE.frame()
