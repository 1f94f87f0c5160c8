"""`solve` and `check` of a scenario on the Earth, and the files that `--export` writes."""

import csv
import json
import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from scipy.spatial.transform import Rotation

from nullpose.report.export import EXPORTS
from scenes import Run


@pytest.fixture
def geodetic(paper: str) -> str:
    """The example by latitude and longitude, with its nodes in a file of their own."""
    return paper.replace("paper.toml", "geodetic.toml")


def test_the_example_is_solved_and_put_on_the_map(run: Run, geodetic: str, tmp_path: Path) -> None:
    """The pose is told on the Earth, in NED and as quaternions, and the file holds the same place."""
    out = tmp_path / "new" / "pose.geojson"
    result = run("solve", geodetic, "--fast", "--export", out)
    assert (result.exit_code, result.stderr) == (0, "")
    for words in ("on the Earth", "NED, body FRD", "quaternion wxyz", "over the WGS-84 ellipsoid"):
        assert words in result.stdout
    pose, *others = json.loads(out.read_text(encoding="utf-8"))["features"]
    told = re.search(r"lat ([\d.]+) deg, lon ([\d.]+) deg, alt ([\d.]+) m", result.stdout)
    assert told is not None
    lat_deg, lon_deg, alt_m = map(float, told.groups())
    assert pose["geometry"]["coordinates"][:2] == pytest.approx([lon_deg, lat_deg], abs=1e-8)
    assert pose["geometry"]["coordinates"][2] == pytest.approx(alt_m, abs=1e-3)
    assert [each["properties"]["name"] for each in others[:5]] == ["weir", "gauge", "lock", "mill", "meadow"]


def test_the_help_names_every_ending(run: Run) -> None:
    """The option's help lists the endings that the program knows."""
    words = run("solve", "--help").stdout.replace("│", " ").split()
    assert set(EXPORTS) <= {f".{word.strip(',.')}" for word in words}


@pytest.mark.parametrize(
    "changes", [(), ("--set", "airframe.tilt_max_deg=40", "--set", "airframe.mount_deg=60")]
)
def test_every_file_has_the_attitude_that_is_printed(
    run: Run, geodetic: str, tmp_path: Path, changes: tuple[str, ...]
) -> None:
    """Roll, pitch and yaw of each format, by another library's rotation where it holds a quaternion."""
    files = {ending: tmp_path / f"pose{ending}" for ending in EXPORTS}
    options = [word for path in files.values() for word in ("--export", path)]
    result = run("solve", geodetic, "--fast", *changes, *options)
    assert result.exit_code == 0
    angles = re.search(
        r"^attitude +roll (\S+) deg, pitch (\S+) deg, yaw (\S+) deg", result.stdout, re.MULTILINE
    )
    assert angles is not None
    roll_deg, pitch_deg, yaw_deg = printed = [float(angle) for angle in angles.groups()]
    assert yaw_deg != 0.0 if changes else roll_deg != 0.0
    assert pitch_deg != 0.0
    plain = json.loads(files[".json"].read_bytes())
    (row,) = csv.DictReader(files[".csv"].read_text().splitlines())
    feature = json.loads(files[".geojson"].read_bytes())["features"][0]["properties"]
    mark = ElementTree.parse(files[".kml"]).find(".//{*}Placemark")
    data = {each.get("name"): each.findtext("{*}value") for each in mark.findall(".//{*}Data")}
    with files[".mcap"].open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        (*_, message), *_ = reader.iter_decoded_messages(topics="/pose")
    turn = message.pose.orientation
    quaternions_xyzw = {
        "tum": np.loadtxt(files[".tum"])[4:],
        "json": np.roll(plain["quaternion_wxyz"], -1),
        "csv": [float(row[name]) for name in ("qx", "qy", "qz", "qw")],
        "geojson": np.roll(feature["enu_quaternion_wxyz"], -1),
        "mcap": [turn.x, turn.y, turn.z, turn.w],
    }
    names = ("roll_deg", "pitch_deg", "yaw_deg")
    stated = {
        **{
            name: Rotation.from_quat(q).as_euler("ZYX", degrees=True)[::-1]
            for name, q in quaternions_xyzw.items()
        },
        "angles of json": [plain[name] for name in names],
        "angles of csv": [float(row[name]) for name in names],
        "angles of geojson": [feature[f"enu_{name}"] for name in names],
        "angles of kml": [float(data[f"enu_{name}"]) for name in names],
    }
    for source, found in stated.items():
        np.testing.assert_allclose(found, printed, rtol=0, atol=6e-4, err_msg=source)
    (item,) = json.loads(files[".plan"].read_bytes())["mission"]["items"]
    assert item["params"][3] == pytest.approx((90.0 - yaw_deg) % 360.0, abs=6e-4)
    assert f"{files['.plan']}: a plan holds no attitude" in result.stderr
