"""JSON, CSV and TUM, read back by other libraries: place, rotation, angles, value and certificate."""

import csv
import hashlib
import io
import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from earth import local_m
from export_scene import ANGLES_DEG, ORIGIN, POSITION_M
from scipy.spatial.transform import Rotation

from nullpose import Result, Scenario, certificate_of, evaluate_against, poses_from_csv, solve
from nullpose.certificate import write_certificate
from nullpose.report.export.plain import csv_file, json_file, tum_file
from nullpose.solver.certificate_from_proof import verified

Placed = Callable[..., Result]


def same_rotation(found: Rotation, expected: Rotation) -> bool:
    """Tells whether two rotations are one, within rounding."""
    return (found.inv() * expected).magnitude() < 1e-12


def test_json_holds_the_pose(placed: Placed, turned: Rotation) -> None:
    """Metres, quaternion with the scalar first, angles, place and value lead back to the pose."""
    result = placed("alt_m")
    found = json.loads(json_file(result))
    w, x, y, z = found["quaternion_wxyz"]
    assert same_rotation(Rotation.from_quat([x, y, z, w]), turned)
    assert {name: found[name] for name in ANGLES_DEG} == pytest.approx(ANGLES_DEG)
    assert found["position_m"] == list(POSITION_M)
    axis = turned.apply([math.sin(0.4), 0.0, math.cos(0.4)])
    np.testing.assert_allclose(found["antenna_axis"], axis, rtol=0, atol=1e-12)
    np.testing.assert_allclose(local_m(**found["place"], origin=ORIGIN), POSITION_M, rtol=0, atol=1e-6)
    assert found["origin"] == dict(zip(("lat_deg", "lon_deg", "alt_m"), ORIGIN, strict=True))
    worst_db = min(link.sinr_db for link in result.links)
    assert (found["quantity"], found["unit"], found["value"]) == ("min_sinr", "dB", pytest.approx(worst_db))
    assert found["upper_bound"] is found["certificate_sha256"] is None


def test_json_without_an_origin(paper: Scenario, placed: Placed) -> None:
    """A scene that lies nowhere on the Earth has its metres, and null in place of the rest."""
    found = json.loads(json_file(replace(placed("alt_m"), scenario=paper)))
    assert found["origin"] is found["place"] is None
    assert found["position_m"] == list(POSITION_M)


def test_json_names_its_certificate(paper: Scenario, tmp_path: Path) -> None:
    """The digest of a verified result is that of the file which holds its certificate; the bound is in dB."""
    result = verified(solve(paper))
    write_certificate(certificate_of(result), tmp_path / "proof.json")
    found = json.loads(json_file(result))
    assert found["certificate_sha256"] == hashlib.sha256((tmp_path / "proof.json").read_bytes()).hexdigest()
    assert found["rigour"] == "verified"
    assert found["upper_bound"] == pytest.approx(10.0 * math.log10(result.objective.upper_bound))


def test_tum_is_a_line_with_the_scalar_last(placed: Placed, turned: Rotation) -> None:
    """NumPy reads t, x, y, z, qx, qy, qz and qw; the quaternion is the rotation to the world."""
    time_s, *numbers = np.loadtxt(io.BytesIO(tum_file(placed("alt_m")))).tolist()
    assert (time_s, numbers[:3]) == (0.0, list(POSITION_M))
    assert same_rotation(Rotation.from_quat(numbers[3:]), turned)


@pytest.mark.parametrize("altitude", ["alt_m", "alt_msl_m"])
def test_csv_is_a_row_with_a_header(placed: Placed, turned: Rotation, altitude: str) -> None:
    """The csv module finds place, metres, quaternion and angles by the names of their columns."""
    (row,) = csv.DictReader(io.StringIO(csv_file(placed(altitude)).decode()))
    numbers = {name: float(text) for name, text in row.items()}
    base_m = {"alt_m": 230.0, "alt_msl_m": 185.0}[altitude]
    place_m = local_m(numbers["lat_deg"], numbers["lon_deg"], numbers[altitude], (*ORIGIN[:2], base_m))
    np.testing.assert_allclose(place_m, POSITION_M, rtol=0, atol=1e-6)
    assert [numbers[name] for name in ("x_m", "y_m", "z_m")] == list(POSITION_M)
    assert same_rotation(Rotation.from_quat([numbers[name] for name in ("qx", "qy", "qz", "qw")]), turned)
    assert {name: numbers[name] for name in ANGLES_DEG} == pytest.approx(ANGLES_DEG)


def test_csv_is_evaluated_to_the_same_value(placed: Placed, tmp_path: Path) -> None:
    """A row that was handed over is a pose that `evaluate --poses` reads, with the value it had."""
    result = placed("alt_m")
    (tmp_path / "pose.csv").write_bytes(csv_file(result))
    poses = poses_from_csv(tmp_path / "pose.csv", mount_rad=result.pose.mount_rad)
    (again,) = evaluate_against(result, poses).results
    assert again.objective.value == pytest.approx(result.objective.value, rel=1e-12)
