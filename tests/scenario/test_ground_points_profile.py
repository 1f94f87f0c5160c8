"""Antennas on the ground that are a table over elevation: what is read, and what is refused."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.reference.whip import whip_rows

from nullpose.channel import Custom
from nullpose.errors import ScenarioError, UsageError
from nullpose.physics import Pose, objective_value
from nullpose.report.links import gain_columns
from nullpose.scenario import Scenario, load
from nullpose.solver.robust.guarantee import guarantee

ROWS = whip_rows(5.0)
AXIS = np.array([1.0, 0.0, 0.0])


def scene(point: dict[str, Any], **more: Any) -> dict[str, Any]:
    """Return the table of a scenario with a node and a jammer that have an antenna."""
    return {
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "nodes": [{"position_m": [0.0, 0.0, 0.0], "power_w": 1.0} | point],
        "jammers": [{"position_m": [0.0, 60.0, 4.0], "power_w": 0.1}],
    } | more


def whip(**changes: Any) -> dict[str, Any]:
    """Return the keys of an antenna by the table, with some of them changed; None leaves one out."""
    keys = {"antenna": "profile", "antenna_profile": ROWS} | changes
    return {key: value for key, value in keys.items() if value is not None}


def test_a_whip_counts_with_the_gain_of_its_table() -> None:
    """Against an isotropic antenna of the gain that the table has at the elevation of the drone."""
    for deg, dbi in ROWS[19:34]:
        position_m = 30.0 * np.array([np.cos(np.radians(deg)), 0.0, np.sin(np.radians(deg))])
        axis = np.array([0.0, 1.0, 0.0])
        found, alike = (
            float(objective_value(Scenario.from_dict(scene(point)), position_m, axis))
            for point in (whip(), {"gain_dbi": dbi})
        )
        assert found == pytest.approx(alike, rel=1e-12)
        columns = gain_columns(Scenario.from_dict(scene(whip())), Pose.from_axis(position_m, axis))
        assert float(columns["with the ground's (dB)"][0]) == pytest.approx(dbi, abs=0.006)


def test_a_whip_survives_its_dictionary_and_its_file(tmp_path: Path) -> None:
    """The table comes back; and from a CSV file by elevation, from one by the angle, and from two cuts."""
    scenario = Scenario.from_dict(scene(whip()))
    assert Scenario.from_dict(scenario.to_dict()) == scenario
    fine = whip_rows(1.0)
    peak = max(dbi for _, dbi in fine)
    losses = {round(-deg): peak - dbi for deg, dbi in fine}  # the angle of a cut grows downwards from ahead
    down = [losses[a if a <= 90 else 180 - a if a <= 270 else a - 360] for a in range(360)]
    cuts = "\n".join(f"{a} {loss:.6f}" for a, loss in enumerate(down))
    files = {
        "elevation.csv": "elevation_deg,gain_dbi\n" + "\n".join(f"{a},{b}" for a, b in fine),
        "angle.csv": "angle_deg;gain_dbi\n" + "\n".join(f"{90 - a};{b}" for a, b in fine),
        "whip.msi": f"NAME whip\nGAIN {peak} dBi\nFREQUENCY 915\nHORIZONTAL 360\n"
        + "\n".join(f"{a} 0.0" for a in range(360))
        + f"\nVERTICAL 360\n{cuts}\n",
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text)
        (tmp_path / "s.toml").write_text(
            Scenario.from_dict(scene({}))
            .to_toml()
            .replace("power_w = 1.0", f'power_w = 1.0\nantenna = "profile"\nantenna_file = "{name}"', 1)
        )
        read = load(tmp_path / "s.toml")
        assert np.array(read.nodes[0].antenna_profile) == pytest.approx(np.array(fine), abs=1e-4)
        assert read.nodes[0].antenna_file == name


@pytest.mark.parametrize(
    ("point", "path", "words"),
    [
        (whip(antenna_profile=[[-90.0, -5.0], [0.0, 2.0]]), "antenna_profile", "-90 to 0 degrees, must rise"),
        (
            whip(antenna_profile=[[-90.0, 0.0], [5.0, 0.0], [5.0, 0.0], [90.0, 0.0]]),
            "antenna_profile",
            "0.01",
        ),
        (whip(antenna_profile=[[-90.0, 1.0], [90.0, 1.0]]), "antenna_profile", "averages to 1.0 dB"),
        (whip(antenna_profile=None), "antenna_profile", "needs it, or antenna_file"),
        (whip(antenna_profile=None, antenna_file="w.csv"), "antenna_file", "only a scenario file"),
        (whip(gain_dbi=3.0), "gain_dbi", "it would add to them"),
        (whip(null_depth_db=20.0), "null_depth_db", 'antenna = "dipole"'),
        (whip(antenna="isotropic"), "antenna_profile", 'antenna = "profile"'),
        (whip(channel=Custom(gain=lambda d, up, around: d**-2.0)), "antenna", "a function in Python"),
        ({"antenna": "dipole", "gain_dbi": 8.5}, "gain_dbi", 'antenna = "profile"'),
    ],
)
def test_what_is_refused(point: dict[str, Any], path: str, words: str) -> None:
    """By the path of what is wrong, once, and with what to write."""
    with pytest.raises(ScenarioError) as error:
        Scenario.from_dict(scene(point))
    (fault,) = error.value.faults
    assert fault.path == f"nodes[0].{path}"
    assert words in fault.message


def test_a_file_that_is_no_table_is_refused_by_its_name(tmp_path: Path) -> None:
    """With the node that names it, and nothing else."""
    (tmp_path / "w.csv").write_text("elevation_deg,gain_dbi\n0,3\n90,-10\n")
    text = Scenario.from_dict(scene({})).to_toml()
    keys = 'power_w = 1.0\nantenna = "profile"\nantenna_file = "w.csv"'
    (tmp_path / "s.toml").write_text(text.replace("power_w = 1.0", keys, 1))
    with pytest.raises(ScenarioError, match=r"nodes\[0\].antenna_file: w.csv.*from -90 to 90") as error:
        load(tmp_path / "s.toml")
    assert len(error.value.faults) == 1


def test_arrays_and_guarantees_refuse_it() -> None:
    """Their bounds do not know it."""
    array = {"elements": 2, "layout": "linear", "spacing_wavelengths": 0.5}
    with pytest.raises(ScenarioError, match="array hears isotropic"):
        Scenario.from_dict(scene(whip(), array=array))
    with pytest.raises(UsageError, match='antenna = "profile"'):
        guarantee(Scenario.from_dict(scene(whip())), [0.0, 20.0, 10.0], AXIS)
