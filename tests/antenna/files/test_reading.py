"""The same pattern through every format, and files that are refused."""

import gzip
from pathlib import Path

import numpy as np
import pytest
from writers import PHI, THETA, WRITERS, dbi, lopsided, samples, write_csv, write_msi

from nullpose.antenna.files import read_pattern, read_profile
from nullpose.antenna.files.reading import mean_gain
from nullpose.antenna.summary import summary_of
from nullpose.errors import ScenarioError

DATA = Path("tests/antenna/data")


def in_db(path: Path) -> np.ndarray:
    """Return what is read, on the grid of 5 degrees."""
    table = read_pattern(path)
    step = round(5.0 / (table.theta_deg[1] - table.theta_deg[0]))
    np.testing.assert_array_equal(table.theta_deg[::step], THETA)
    np.testing.assert_array_equal(table.phi_deg[::step], PHI)
    return 10.0 * np.log10(table.gain[::step, ::step])


@pytest.mark.parametrize("name", WRITERS)
def test_the_same_pattern_through_every_format(name: str, tmp_path: Path) -> None:
    """Direction by direction to .01 dB; a format without power gives the directivity."""
    path = tmp_path / f"pattern.{name}"
    WRITERS[name](path, lopsided)
    wanted = dbi(samples(lopsided)[2]).reshape(len(THETA), len(PHI))
    found = in_db(path)
    if read_pattern(path).quantity == "directivity":
        (tmp_path / "gains.csv").write_text("")
        write_csv(tmp_path / "gains.csv", lopsided)
        wanted = wanted - 10.0 * np.log10(mean_gain(read_pattern(tmp_path / "gains.csv")))
    np.testing.assert_allclose(found, wanted, atol=0.01)
    mirrored, swapped = found[:, ::-1], found[::-1]
    assert np.abs(mirrored - wanted).max() > 1.0
    assert np.abs(swapped - wanted).max() > 1.0


def test_nec_output() -> None:
    """Our dipoles, alone and on a frame: peak, null and ripple as measured."""
    alone = summary_of(read_pattern(DATA / "alone_half_5deg.out.gz"))
    assert alone.peak_dbi == pytest.approx(2.14, abs=0.01)
    assert alone.ripple_db < 0.01
    assert alone.degree <= 6
    assert not np.isfinite(alone.null_depth_db)
    assert alone.polarisation.startswith("linear, 0 degrees")
    frame = summary_of(read_pattern(DATA / "hex35_above_10_half_off20mm_5deg.out.gz"))
    assert frame.peak_dbi == pytest.approx(3.4, abs=0.1)
    assert frame.ripple_db == pytest.approx(1.8, abs=0.1)
    assert frame.mean_gain_db == pytest.approx(0.0, abs=0.05)
    assert frame.degree > 25


def test_two_cuts_of_an_antenna_that_is_the_same_all_round(tmp_path: Path) -> None:
    """A flat horizontal cut gives the antenna; the vertical angle grows downwards; dBd is 2.15 dB more."""
    path = tmp_path / "omni.msi"
    write_msi(
        path,
        lambda a: (
            12.0 * (1.0 - np.cos(np.radians(a - 10.0)))
            if a < 90 or a > 270
            else 12.0 * (1.0 - np.cos(np.radians(170.0 - a)))
        ),
        lambda a: 0.2,
        "-0.5 dBd",
    )
    table = read_pattern(path)
    gain_db = 10.0 * np.log10(table.gain)
    assert gain_db[100, 0] == pytest.approx(-0.5 + 2.15, abs=0.01)  # 10 degrees below the horizon
    assert gain_db[100].std() == pytest.approx(0.0, abs=1e-9)


def test_two_cuts_of_another_are_an_estimate(tmp_path: Path) -> None:
    """They are refused, with what they cannot say; looked at, they are called an estimate."""
    path = tmp_path / "sector.msi"
    write_msi(path, lambda a: 0.05 * min(a, 360 - a), lambda a: 0.05 * min(a, 360 - a), "5 dBi")
    with pytest.raises(ScenarioError, match=r"horizontal cut changes by 9\.0 dB"):
        read_pattern(path)
    assert "estimate" in read_pattern(path, estimate=True).notes[0]


def test_a_compressed_file(tmp_path: Path) -> None:
    """What is compressed is read as it is."""
    write_csv(tmp_path / "a.csv", lopsided)
    (tmp_path / "b.csv.gz").write_bytes(gzip.compress((tmp_path / "a.csv").read_bytes()))
    np.testing.assert_array_equal(in_db(tmp_path / "a.csv"), in_db(tmp_path / "b.csv.gz"))


def lines_of(tmp_path: Path, name: str = "csv") -> list[str]:
    """Return the lines of a pattern's file."""
    path = tmp_path / "whole"
    WRITERS[name](path, lopsided)
    return path.read_text().splitlines()


def with_gains(lines: list[str], most: float, some: float) -> list[str]:
    """Return the lines with one gain at most directions, and another at polar angles that begin with 9."""
    rows = (f"{line.rsplit(',', 1)[0]},{some if line.startswith('9') else most}" for line in lines[1:])
    return [lines[0], *rows]


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda lines: [], "the file is empty"),
        (lambda lines: ["something", "else"], "the format cannot be told"),
        (lambda lines: lines[:1], "no rows below the header"),
        (lambda lines: lines[:-100], "polar angles go from 0 to 175 degrees, must go from 0 to 180"),
        (lambda lines: lines[:700] + lines[703:], "there is no row for theta = .*, phi = .*holes"),
        (lambda lines: [*lines[:9], "0,45,nan", *lines[10:]], "line 10: got '0 45 nan'.*finite"),
        (lambda lines: [*lines[:9], "0,45,loud", *lines[10:]], "line 10: got 'loud', must be a number"),
        (lambda lines: [*lines[:9], "0,45", *lines[10:]], "line 10: got 2 columns, must be 3"),
        (lambda lines: [*lines, "200,0,1.0"], "line 2666: got theta = 200.*beyond the sphere"),
        (lambda lines: [*lines, "90,0,-20"], r"line \d+: theta = 90, phi = 0 degrees is told twice"),
        (lambda lines: with_gains(lines, 3.5, 3.5), "radiate more than it is fed"),
        (lambda lines: with_gains(lines, 1.0, -999.99), "no gain at all.*nulls"),
    ],
)  # fmt: skip
def test_what_is_refused(spoil: object, message: str, tmp_path: Path) -> None:
    """Each fault is one message, with the line where there is one."""
    path = tmp_path / "spoilt.csv"
    path.write_text("\n".join(spoil(lines_of(tmp_path))))  # type: ignore[operator]
    with pytest.raises(ScenarioError, match=message) as caught:
        read_pattern(path)
    assert len(caught.value.faults) == 1


def test_another_format_than_stated(tmp_path: Path) -> None:
    """A format that is not the file's is told, and so is one that there is not."""
    path = tmp_path / "a.csv"
    write_csv(path, lopsided)
    with pytest.raises(ScenarioError, match="stated to be nec, but it is csv"):
        read_pattern(path, "nec")
    with pytest.raises(ScenarioError, match="must be one of nec, ffs"):
        read_pattern(path, "pdf")


def test_frequencies(tmp_path: Path) -> None:
    """Several frequencies ask for one of them; one that is not there is refused."""
    lines = lines_of(tmp_path, "nec")
    path = tmp_path / "two.out"
    path.write_text("\n".join([*lines, *(line.replace("4.3300E+02", "9.0000E+02") for line in lines)]))
    with pytest.raises(ScenarioError, match=r"2 frequencies: 4.33e\+08, 9e\+08 Hz"):
        read_pattern(path)
    assert read_pattern(path, frequency_hz=9e8).frequency_hz == 9e8
    with pytest.raises(ScenarioError, match="must be one of the file's"):
        read_pattern(path, frequency_hz=2.4e9)


def test_a_profile(tmp_path: Path) -> None:
    """Angles and gains in order; one that does not span 0 to 180 degrees is refused."""
    path = tmp_path / "profile.csv"
    path.write_text("angle_deg,gain_dbi\n90,2\n0,-30\n180,-30\n")
    angle, gain = read_profile(path)
    np.testing.assert_array_equal(angle, [0.0, 90.0, 180.0])
    assert gain[1] == pytest.approx(10.0**0.2)
    path.write_text("angle_deg,gain_dbi\n0,-30\n90,2\n")
    with pytest.raises(ScenarioError, match="from 0 to 90 degrees, must go from 0 to 180"):
        read_profile(path)


def test_hostile_xml(tmp_path: Path) -> None:
    """Entities are not read."""
    path = tmp_path / "a.xml"
    path.write_text('<!DOCTYPE a [<!ENTITY x "y">]>\n<antennaprofile><antennapattern/></antennaprofile>')
    with pytest.raises(ScenarioError, match="declares entities"):
        read_pattern(path)
