"""The verb `trajectory`: a flight with a bound, simpler flights beside it, files, and what is refused."""

import json
import math
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

Run = Callable[..., Result]

MOVING = str(Path(__file__).parents[2] / "examples" / "moving_jammer.toml")
SMALL = ("--set", "time.step_s=10", "--set", "jammers.M.power_w=100")


@pytest.mark.parametrize("aim", ["worst", "mean-rate"])
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


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--maximise", "best"), "maximise: given 'best'; allowed: worst, mean-db, mean-rate"),
        (("--gap-db", "0"), "gap: given 0.0 dB"),
        (("--window", "-1"), "window: given -1.0"),
        (("--set", "airframe={tilt_max_deg=20}"), "airframe.speed_max_m_s: missing"),
        (("--set", "time.step_s=61"), "time.step_s: got 61"),
        (("--at", "3"), "No such option: --at"),
    ],
)
def test_bad_input_is_refused_in_a_line(run: Run, words: tuple[str, ...], message: str) -> None:
    """The message says what was given; the exit code is 2, and nothing was worked out."""
    done = run("trajectory", MOVING, *SMALL, *words)
    assert done.exit_code == 2
    assert message in done.stderr
    assert "Traceback" not in done.stderr


def test_a_still_scene_is_refused(run: Run, paper: str) -> None:
    """It says that a table [time] is missing."""
    done = run("trajectory", paper)
    assert done.exit_code == 2
    assert "[time]" in done.stderr
