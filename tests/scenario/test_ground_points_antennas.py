"""Antennas on the ground in scenario files."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nullpose.scenario import Scenario, apply_overrides, doubts, load
from nullpose.scenario.loading import files_of
from scenes import faults_of, require_fault, small


def stated(paper: Callable, **keys: object) -> Scenario:
    """Return the paper's scene with these keys at its first node."""
    data = paper().to_dict()
    data["nodes"][0].update(keys)
    return Scenario.from_dict(data)


def test_axes_are_upright_or_as_stated(paper: Callable) -> None:
    """A dipole is upright; an axis of any length is brought to unit length; others have none."""
    upright = stated(paper, antenna="dipole")
    leaning = stated(paper, antenna="dipole", antenna_axis=[3, 0, 4])
    np.testing.assert_allclose(upright.node_antennas.axes, [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])
    np.testing.assert_allclose(leaning.node_antennas.axes[0], [0.6, 0.0, 0.8], atol=1e-15)
    circular = stated(paper, antenna="circular").node_antennas
    assert circular.shares.tolist() == [0.5, 1.0]
    assert not np.any(circular.axes)
    assert Scenario.from_dict(leaning.to_dict()) == leaning


@pytest.mark.parametrize(
    ("antenna", "keys", "key", "words"),
    [
        ("whip", {}, "antenna", '"isotropic" or "circular" or "dipole"'),
        ("isotropic", {"antenna_axis": [0, 0, 1]}, "antenna_axis", 'antenna = "isotropic" has no axis'),
        ("circular", {"antenna_axis": [0, 0, 1]}, "antenna_axis", 'write antenna = "dipole"'),
        ("isotropic", {"null_depth_db": 20.0}, "null_depth_db", 'antenna = "isotropic" has no null'),
        ("dipole", {"null_depth_db": -1.0}, "null_depth_db", "a depth in dB"),
        ("dipole", {"antenna_axis": [0, 0, 0]}, "antenna_axis", "length 0"),
        ("dipole", {"antenna_axis": [0, 1]}, "antenna_axis", "three numbers"),
        ("dipole", {"antenna_axis": [0, 0, float("nan")]}, "antenna_axis[2]", "direction"),
        ("dipole", {"gain_dbi": 101.0}, "gain_dbi", "from -100 to 100"),
    ],
)
def test_faults_have_their_place(antenna: str, keys: dict, key: str, words: str, paper: Callable) -> None:
    """One message each, with what was given and what is allowed."""
    require_fault(lambda: stated(paper, antenna=antenna, **keys), f"nodes[0].{key}", words)


def test_the_depth_of_a_null_is_told(paper: Callable) -> None:
    """As a leak along the dipole's axis; at 0 dB there is no direction left."""
    whip, level = (stated(paper, antenna="dipole", null_depth_db=depth) for depth in (20.0, 0.0))
    assert whip.node_antennas.leaks.tolist() == [0.01, 1.0]
    assert level.node_antennas.leaks.tolist() == [1.0, 1.0]
    assert not np.any(level.node_antennas.axes)
    assert Scenario.from_dict(whip.to_dict()) == whip
    assert "null_depth_db = 20" in whip.to_toml()
    assert whip.nodes[0].isotropic == paper().nodes[0]


def test_a_gain_is_told_of_every_antenna(paper: Callable) -> None:
    """In dBi over an isotropic antenna, half of it for a circular one; 0 is not told."""
    gained = stated(paper, gain_dbi=3.0, antenna="circular")
    assert gained.node_antennas.shares.tolist() == [0.5 * 10.0**0.3, 1.0]
    assert Scenario.from_dict(gained.to_dict()) == gained
    assert stated(paper, gain_dbi=0.0) == paper()
    assert stated(paper, gain_dbi=3.0).nodes[0].isotropic.gain_dbi == 3.0


@pytest.mark.parametrize(
    ("keys", "most_dbi"),
    [({"antenna": "dipole"}, 5.27), ({"antenna": "dipole", "null_depth_db": 10.0}, 5.06)],
)
def test_gains_that_no_dipole_has_are_refused(keys: dict, most_dbi: float, paper: Callable) -> None:
    """Over the upper half of the sphere it would radiate half a decibel more than it is fed."""
    stated(paper, gain_dbi=most_dbi - 0.01, **keys)
    require_fault(
        lambda: stated(paper, gain_dbi=8.5, **keys), "nodes[0].gain_dbi", f"must be at most {most_dbi:.2f}"
    )


@pytest.mark.parametrize(
    ("kind", "keys", "gain_dbi", "is_doubted"),
    [
        ("nodes", {"antenna": "dipole"}, 1.76, False),
        ("nodes", {"antenna": "dipole", "null_depth_db": 15.0}, 2.15, False),
        ("nodes", {"antenna": "dipole"}, 5.0, True),
        ("nodes", {"antenna": "circular"}, 3.0, False),
        ("nodes", {"antenna": "circular"}, 8.0, True),
        ("nodes", {}, 8.5, True),
        ("nodes", {"antenna": "dipole"}, -3.0, False),
        ("jammers", {"antenna": "dipole"}, 5.0, True),
        ("jammers", {}, 12.0, False),
    ],
)
def test_gains_of_some_directions_only_are_doubted(
    kind: str, keys: dict, gain_dbi: float, is_doubted: bool, paper: Callable
) -> None:
    """The gain counts in every direction: the worst case of a jammer, and too kind to a node."""
    data = paper().to_dict()
    data[kind][0] |= keys | {"gain_dbi": gain_dbi}
    assert [each.path for each in doubts(Scenario.from_dict(data))] == [f"{kind}[0].gain_dbi"] * is_doubted


@pytest.mark.parametrize(
    ("antenna", "most_dbi"),
    [
        ({}, 2.26),
        ({"null_depth_db": 10.0}, 2.05),
        ({"kind": "half-wave"}, 2.65),
        ({"kind": "profile", "normalise": "peak", "harmonics": [[0.25], [0.25, 0, 0]]}, 4.86),
    ],
)
def test_gains_that_no_antenna_on_the_drone_has_are_refused(
    antenna: dict, most_dbi: float, paper: Callable
) -> None:
    """Over the sphere it would radiate half a decibel more than it is fed."""
    data = paper().to_dict()
    Scenario.from_dict(data | {"antenna": antenna | {"gain_dbi": most_dbi - 0.01}})
    require_fault(
        lambda: Scenario.from_dict(data | {"antenna": antenna | {"gain_dbi": most_dbi + 0.01}}),
        "antenna.gain_dbi",
        f"must be at most {most_dbi:.2f}",
    )


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
