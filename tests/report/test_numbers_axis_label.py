"""Axes are labelled in words with their unit."""

import pytest

from nullpose.report.numbers import axis_label


@pytest.mark.parametrize(
    ("path", "label"),
    [
        ("jammers.M.power_w", "Power of jammer M  (W)"),
        ("nodes.S1.min_sinr_db", "Required SINR of node S1  (dB)"),
        ("receiver.noise_dbm", "Noise power of the receiver  (dBm)"),
        ("receiver.attitude_error_deg", "Attitude error of the receiver  (degrees)"),
        ("jammers.M.position_m[2]", "Position of jammer M, up  (m)"),
        ("airspace.altitude_m[0]", "Altitude of the airspace, lowest  (m)"),
        ("array.elements", "Elements of the array"),
        ("airframe.tilt_max_deg", "Largest tilt of the airframe  (degrees)"),
    ],
)
def test_a_setting_is_told_in_words(path: str, label: str) -> None:
    """No key of the file is on the axis."""
    assert axis_label(path) == label
