"""The destination of a relay is stated in all ways in which a node is."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nullpose.scenario import Scenario, apply_overrides, doubts, load
from nullpose.scenario.loading import files_of
from scenes import faults_of, small

HERE = {"lat_deg": 50.0, "lon_deg": 14.5, "alt_m": 232.0}
ORIGIN = {"lat_deg": 50.0, "lon_deg": 14.5, "alt_m": 230.0}
END = {"lat_deg": 50.001, "lon_deg": 14.501, "alt_agl_m": 3.0, "noise_dbm": -30.0}


def earthly(**changes: Any) -> dict[str, Any]:
    """Return a relay whose points are stated by latitude and longitude."""
    tables = {"origin": ORIGIN, "nodes": [HERE | {"power_w": 1.0}], "destination": END}
    return small(objective="relay", transmitter={"power_w": 1.0}, **tables | changes)


def test_it_is_placed_on_the_earth() -> None:
    """A latitude, a longitude and a height above the ground make a position, from wherever the origin is."""
    scenario = Scenario.from_dict(earthly())
    np.testing.assert_allclose(scenario.destination.position_m, [71.7, 111.2, 3.0], atol=0.1)
    np.testing.assert_array_equal(scenario.terminal_positions_m[-1], scenario.destination.position_m)
    moved = apply_overrides(scenario, ["origin.lat_deg=50.001"])
    assert moved.destination.position_m[1] == pytest.approx(0.0, abs=0.1)


@pytest.mark.parametrize(
    ("changes", "path", "words"),
    [
        ({"origin": None}, "origin", "nodes[0] is stated by lat_deg"),
        ({"destination": {"position_m": [1.0, 2.0, 3.0]}}, "destination", "state all in one way"),
        ({"destination": END | {"lat_deg": 14.5, "lon_deg": 50.0}}, "destination", "exchanged"),
        ({"destination": END | {"position_m": [0.0, 5.0, 0.0]}}, "destination", "must be one place"),
    ],
)
def test_faults_of_its_place(changes: dict[str, Any], path: str, words: str) -> None:
    """What is wrong with its place is said at its path, as of a node."""
    (found,) = [message for at, message in faults_of(earthly(**changes)).items() if at.startswith(path)]
    assert words in found


def test_it_is_written_read_and_changed() -> None:
    """A file that is written from it loads as the same scene; a value is changed by its path."""
    scenario = Scenario.from_dict(earthly())
    assert Scenario.from_dict(scenario.to_dict()) == scenario
    louder = apply_overrides(scenario, ["destination.noise_w=2e-3", "destination.min_sinr_db=3"])
    assert louder.destination.noise_dbm is None
    assert louder.destination_noise_w.tolist() == [2e-3]
    assert louder.has_margins
    assert louder.terminal_required_sinr.tolist() == [1.0, pytest.approx(10.0**0.3)]


def test_its_antenna_may_be_a_file(tmp_path: Path) -> None:
    """A profile is read from a file beside the scenario, which is one of the scenario's files."""
    (tmp_path / "whip.csv").write_text("elevation_deg,gain_dbi\n-90,-20\n0,2\n90,-20\n", encoding="utf-8")
    end = END | {"antenna": "profile", "antenna_file": "whip.csv", "name": "tower"}
    before, _, after = Scenario.from_dict(earthly()).to_toml().partition("[destination]")
    lines, path = [f"{key} = {value!r}" for key, value in end.items()], tmp_path / "relay.toml"
    _, _, rest = after.partition("\n[")
    path.write_text("\n".join([before, "[destination]", *lines, f"[{rest}"]), encoding="utf-8")
    scenario = load(path)
    assert scenario.terminal_names == ("S1", "tower")
    assert scenario.destination.peak_dbi == pytest.approx(2.0, abs=1e-9)
    assert "destination.antenna_file" in files_of(path)


def test_doubts_name_it() -> None:
    """Noise of less than a kilohertz is doubted at its path."""
    quiet = Scenario.from_dict(earthly(destination=END | {"noise_dbm": -170.0}))
    assert "destination" in [fault.path for fault in doubts(quiet)]
