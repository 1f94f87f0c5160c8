"""The verb `trajectory`: a flight with a bound, simpler flights beside it, files, and what is refused."""

import json
import math
from pathlib import Path

import pytest
from sizes import chosen

from scenes import Run

MOVING = str(Path(__file__).parents[2] / "examples" / "moving_jammer.toml")
SMALL = ("--set", "time.step_s=10", "--set", "jammers.M.power_w=100")


@pytest.mark.parametrize("aim", chosen(["worst", "mean-rate"], [0]))
def test_the_flight_keeps_its_speed_and_is_between_simpler_ones_and_the_bound(run: Run, aim: str) -> None:
    """No simpler flight has more, and none has more than the bound."""
    done = run("trajectory", MOVING, *SMALL, "--maximise", aim, "--window", 20, "--gap-db", 0.5, "--json")
    assert done.exit_code == 0
    found = json.loads(done.stdout)
    ending = "db" if aim == "worst" else "bps_hz"
    value, bound = (found["objective"][f"{name}_{ending}"] for name in ("value", "upper_bound"))
    others = [found["baselines"][f"{name}_{ending}"] for name in ("hover", "greedy", "window")]
    assert max(others) <= value <= bound <= found["baselines"][f"clairvoyant_{ending}"] + 1e-9
    assert found["status"] == "certified"
    assert [row["time_s"] for row in found["trajectory"]] == [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0]
    assert found["speed_max_m_s"] <= 5.0 + 1e-9
    lowest = min(row["value_db"] for row in found["trajectory"])
    assert 10.0 * math.log10(found["lowest_sample"]["value"]) <= lowest + 1e-9


def test_files_are_written_to_a_folder_and_named(run: Run, tmp_path: Path) -> None:
    """Each that is named is there, and nothing else; with an origin those for maps are among them."""
    origin = ("--set", "origin={lat_deg=50.0, lon_deg=14.5, alt_m=230}")
    done = run("trajectory", MOVING, *SMALL, *origin, "--out", tmp_path / "flight")
    assert done.exit_code == 0
    named = {Path(line.removeprefix("Wrote ")).name for line in done.stdout.splitlines() if "Wrote" in line}
    assert named == {path.name for path in (tmp_path / "flight").iterdir()}
    assert {"trajectory.json", "trajectory.plan", "plan.png", "flight.gif"} <= named
    assert "attitude" in done.stderr  # what a plan does not hold
