"""Ten traps of a first hour: each ends with a message that says what is wrong and what to do about it."""

from pathlib import Path
from typing import Any

import pytest
from typer.testing import Result

import nullpose
from nullpose.errors import UsageError
from scenes import Run

HEAD = """\
[origin]
lat_deg = 50.0
lon_deg = 14.5
{origin}
[airspace]
altitude_m = [20.0, 80.0]
{fence}
[receiver]
noise_dbm = -95.0
frequency_hz = 2.4e9
"""
NODE = """
[[nodes]]
lat_deg = {lat}
lon_deg = {lon}
{altitude}
power_dbm = 20.0
"""
NODES = [(50.0, 14.5), (50.001, 14.502), (50.0018, 14.5008)]


def scene(
    folder: Path,
    *,
    origin: str = "alt_m = 230.0",
    fence: str = "",
    altitude: str = "alt_m = 231.0",
    swap: bool = False,
) -> Path:
    """Return the path of a scene of three nodes on the Earth."""
    places = [place[::-1] if swap else place for place in NODES]
    nodes = "".join(NODE.format(lat=lat, lon=lon, altitude=altitude) for lat, lon in places)
    path = folder / "mine.toml"
    path.write_text(HEAD.format(origin=origin, fence=fence) + nodes, encoding="utf-8")
    return path


def refused(result: Result, *words: str) -> str:
    """Return the message of a refusal, which has the words, exit code 2 and nothing on standard output."""
    assert (result.exit_code, result.stdout) == (2, "")
    for word in words:
        assert word in result.stderr
    return result.stderr


FENCE = "geofence_m = [[14.499, 49.999], [14.504, 49.999], [14.504, 50.003], [14.499, 50.003]]"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"fence": FENCE}, ["airspace.geofence_m: it is 0.005 m by 0.004 m", "write geofence_lat_lon_deg ="]),
        ({"origin": "alt_msl_m = 185.0"}, ["nodes[0].alt_m: ", "(and so in 2 more)", "add alt_m to [origin"]),
        ({"swap": True}, ["nodes[0]: lat_deg and lon_deg are", "are latitude and longitude exchanged?"]),
    ],
    ids=["fence in degrees", "heights over another zero", "latitude and longitude exchanged"],
)
def test_a_scene_on_the_earth(run: Run, tmp_path: Path, changes: dict[str, Any], words: list[str]) -> None:
    """What is wrong in every point is said once, with what is meant."""
    told = refused(run("check", scene(tmp_path, **changes)), "1 fault", *words)
    assert len(told.splitlines()) == 2


def test_heights_that_look_wrong(run: Run, tmp_path: Path) -> None:
    """Heights that are all far above the origin earn a warning."""
    result = run("check", scene(tmp_path, origin="alt_m = 185.0"))
    assert result.exit_code == 0
    assert "warning: nodes[0]: this and all other points in alt_m lie 46 m or more" in result.stderr


@pytest.mark.parametrize("verb", ["solve", "compare"])
def test_a_path_given_to_a_function(paper: str, verb: str) -> None:
    """A function that takes a scenario says how to read one from a path."""
    with pytest.raises(TypeError, match=r"allowed: Scenario; try Scenario\.from_file\('"):
        getattr(nullpose, verb)(paper)


def test_a_misspelt_scheme(paper: str) -> None:
    """The schemes are listed, and the one that is meant is named; in Python as on the command line."""
    with pytest.raises(UsageError, match=r"given 'optimun'; allowed: optimum, .*; did you mean .optimum.\?"):
        nullpose.solve(nullpose.load(paper), "optimun")


def test_dbm_given_as_watts(run: Run, paper: str, tmp_path: Path) -> None:
    """33 W among powers in dBm earns a warning that names power_dbm; 33 W among watts earns none."""
    mixed = scene(tmp_path)
    mixed.write_text(
        mixed.read_text(encoding="utf-8").replace("power_dbm = 20.0", "power_w = 33", 1), encoding="utf-8"
    )
    result = run("check", mixed)
    assert result.exit_code == 0
    assert (
        "warning: nodes[0].power_w: 33 W is 45.2 dBm, and other transmit powers are stated in dBm; if 33 dBm "
        "(2 W) is meant, write power_dbm = 33" in result.stderr
    )
    assert run("check", paper, "--set", "jammers.M.power_w=33").stderr == ""


def test_points_in_degrees_as_metres(run: Run, paper: str) -> None:
    """A point whose metres are the origin's latitude and longitude earns a warning, either way round."""
    origin = ("--set", "origin={lat_deg=50.2, lon_deg=14.4, alt_m=300}")
    for degrees in ("[50.2013, 14.4028, 2]", "[14.4028, 50.2013, 2]"):
        result = run("check", paper, *origin, "--set", f"nodes.S1.position_m={degrees}")
        assert result.exit_code == 0
        assert "close to the origin's latitude and longitude (50.2, 14.4)" in result.stderr
        assert "lat_deg, lon_deg and an altitude" in result.stderr
    assert run("check", paper, *origin).stderr == ""
