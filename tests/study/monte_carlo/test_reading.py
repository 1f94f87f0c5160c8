"""The rows of a study come back in order, as a frame, as arrays and in batches."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from nullpose import UsageError, evaluate
from nullpose.physics import Pose
from nullpose.study.monte_carlo import StudySpec, StudyTable, read_study, run_study, scene_at

Spec = Callable[..., StudySpec]

CASES = [{"name": "free"}, {"name": "level", "airframe": "level-vertical"}]
SWEEP = {"jammers.M.power_w": [1.0, 10.0], "receiver.noise_w": [1e-3, 1e-2, 1e-1]}


@pytest.fixture(scope="module")
def table(spec: Spec, tmp_path_factory: pytest.TempPathFactory) -> StudyTable:
    """A small study that is solved, in parts of two scenes."""
    folder = tmp_path_factory.mktemp("study")
    run_study(spec(scenes=5, cases=CASES, sweep=SWEEP), folder, workers=0, chunk=2)
    return read_study(folder)


def test_rows_are_in_order(table: StudyTable) -> None:
    """By scene, combination of swept values and case, none missing, none double."""
    frame = table.frame()
    keys = [(scene, point, case) for scene in range(5) for point in range(6) for case in ("free", "level")]
    assert list(frame[["scene", "point", "case"]].itertuples(index=False, name=None)) == keys
    assert list(frame["case"].cat.categories) == ["free", "level"]
    assert table.is_complete
    assert table.scenes_done == 5


def test_columns_are_those_agreed(table: StudyTable) -> None:
    """Each column has its type, swept parameters stand by their paths."""
    kinds = {name: str(kind) for name, kind in table.frame().dtypes.items()}
    floats = [
        *SWEEP,
        "value",
        "bound",
        "gap",
        "x_m",
        "y_m",
        "z_m",
        "roll_rad",
        "pitch_rad",
        "yaw_rad",
        "seconds",
    ]
    assert [kinds[name] for name in floats] == ["float64"] * len(floats)
    assert (kinds["scene"], kinds["point"], kinds["boxes"]) == ("int64", "int32", "int64")
    assert {"status", "binding_node", "reason"} <= set(kinds)


def test_values_are_those_of_the_scene(table: StudyTable) -> None:
    """A row's pose, evaluated in its scene, gives its value, which its bound is not below."""
    for row in table.frame().itertuples():
        assert (row.status, row.reason) == ("certified", "")
        scene = scene_at(table.spec, row.scene, row.point)
        pose = Pose(np.array([row.x_m, row.y_m, row.z_m]), row.roll_rad, row.pitch_rad, row.yaw_rad)
        links = evaluate(scene, pose)
        assert min(link.sinr for link in links) == pytest.approx(row.value, rel=1e-12)
        assert row.binding_node == min(links, key=lambda link: link.sinr).node
        assert row.value <= row.bound <= row.value * 1.01
        assert row.gap == pytest.approx(row.bound / row.value - 1.0)


def test_swept_values_stand_beside_their_number(table: StudyTable) -> None:
    """The combination's number says which values were set."""
    frame = table.frame()
    for path in SWEEP:
        assert list(frame[path]) == [table.spec.points[point][path] for point in frame["point"]]


def test_batches_are_the_frame(table: StudyTable) -> None:
    """All batches, one after the other, are the whole."""
    pd.testing.assert_frame_equal(pd.concat(table.batches(), ignore_index=True), table.frame())


def test_arrays_have_a_dimension_for_each_choice(table: StudyTable) -> None:
    """Scene, swept parameters and case: what is looked up there is what the frame has."""
    arrays, frame = table.to_xarray(), table.frame()
    assert dict(arrays.sizes) == {"scene": 5, "jammers.M.power_w": 2, "receiver.noise_w": 3, "case": 2}
    assert arrays.attrs["objective"] == "min-sinr"
    for row in frame.itertuples(index=False):
        at = {path: table.spec.points[row.point][path] for path in SWEEP}
        assert float(arrays["value"].sel(scene=row.scene, case=row.case, **at)) == row.value


def test_no_study_is_there(tmp_path: Path) -> None:
    """A folder without a manifest is told apart from an empty study."""
    with pytest.raises(UsageError, match="no study is here"):
        read_study(tmp_path)
