"""The formats by ending: which there are, what each needs, and that a file is whole or not there."""

from collections.abc import Callable
from pathlib import Path

import pytest

from nullpose import Result
from nullpose.errors import OutputError, UsageError
from nullpose.report.export import EXPORTS, require_exports, write_export

Placed = Callable[..., Result]
ON_EARTH = {".geojson", ".kml", ".plan"}


@pytest.mark.parametrize("ending", EXPORTS)
def test_every_format_is_written(placed: Placed, tmp_path: Path, ending: str) -> None:
    """A file has what its format writes, whatever the case of the ending; a plan alone loses something."""
    result, path = placed("alt_m"), tmp_path / f"pose{ending.upper()}"
    path.write_text("old", encoding="utf-8")
    lost = write_export(result, path)
    assert bool(lost) == (ending == ".plan")
    assert path.read_bytes() == EXPORTS[ending].content(result)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("name", ["pose.xyz", "pose", ".json", "pose.json.gz"])
def test_an_unknown_ending(placed: Placed, tmp_path: Path, name: str) -> None:
    """Any other ending is refused, before a solve and at the end, with those that are allowed."""
    result, path = placed("alt_m"), tmp_path / name
    for refused in (lambda: require_exports(result.scenario, [path]), lambda: write_export(result, path)):
        with pytest.raises(UsageError, match=r"given .*; allowed endings: \.json, \.tum, \.csv, .*\.mcap$"):
            refused()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("ending", EXPORTS)
def test_what_needs_an_origin(placed: Placed, tmp_path: Path, ending: str) -> None:
    """Formats of maps and of autopilots need one; the others are written without."""
    scenario = placed("alt_m").scenario.model_copy(update={"origin": None})
    path = tmp_path / f"pose{ending}"
    if ending in ON_EARTH:
        with pytest.raises(UsageError, match="has no origin"):
            require_exports(scenario, [path])
    else:
        require_exports(scenario, [path])


def test_a_fault_leaves_what_was_there(placed: Placed, tmp_path: Path) -> None:
    """A folder in the way is a message, and nothing else is left behind."""
    (tmp_path / "pose.kml").mkdir()
    with pytest.raises(OutputError, match="in the way"):
        write_export(placed("alt_m"), tmp_path / "pose.kml")
    assert [path.name for path in tmp_path.iterdir()] == ["pose.kml"]
