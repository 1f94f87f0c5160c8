"""Pattern files: one antenna in every format is one function of the direction."""

import gzip
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from nullpose.antenna.files import FORMATS, read_pattern, read_profile
from nullpose.antenna.files.reading import mean_gain, solid_angles
from nullpose.antenna.table import PatternTable

NAMES = ("nec", "4nec2", "ffd", "ffs", "cst", "csv", "complex-csv")
WITH_FIELD = ("nec", "4nec2", "ffd", "ffs", "cst", "complex-csv")
Field = Callable[..., np.ndarray]


def read(text: str, folder: Path, **options: object) -> PatternTable:
    """Returns the table of a file's content."""
    path = folder / "pattern.txt"
    path.write_text(text, encoding="utf-8")
    return read_pattern(path, **options)


def largest_error_db(table: PatternTable, field: Field, turn: Callable[..., tuple] | None = None) -> float:
    """Returns by how much a table differs from the antenna, 30 dB below the peak and above."""
    angles = np.meshgrid(table.theta_deg, table.phi_deg, indexing="ij")
    gain = np.sum(np.abs(field(*(turn(*angles) if turn else angles))) ** 2, axis=-1)
    seen = gain > 1e-3 * np.max(gain)
    return float(np.max(np.abs(10.0 * np.log10(table.gain[seen] / gain[seen]))))


@pytest.mark.parametrize("name", NAMES)
def test_every_format_gives_the_same_antenna(
    written: dict[str, str], formats: dict[str, str], field: Field, tmp_path: Path, name: str
) -> None:
    """In every direction the gain is the antenna's to .01 dB, whether the format is stated or told."""
    for stated in (None, formats[name]):
        table = read(written[name], tmp_path, file_format=stated)
        assert largest_error_db(table, field) < 0.01
        assert table.source == f"pattern.txt ({formats[name]})"
        assert table.theta_deg[[0, -1]].tolist() == [0.0, 180.0]
        assert table.phi_deg[0] == 0.0
        assert table.phi_deg[-1] < 360.0
        assert (table.field is not None) == (name in WITH_FIELD)


@pytest.mark.parametrize(
    "turn",
    [
        lambda theta, phi: (theta, -phi),
        lambda theta, phi: (180.0 - theta, phi),
        lambda theta, phi: (theta, phi + 180.0),
        lambda theta, phi: (phi / 2.0, 2.0 * theta),
    ],
    ids=["mirrored", "upside down", "backwards", "swapped"],
)
def test_a_wrong_reading_would_show(
    written: dict[str, str], field: Field, tmp_path: Path, turn: Callable[..., tuple]
) -> None:
    """The antenna has no symmetry: mirrored, turned or swapped it is another one, by decibels."""
    assert largest_error_db(read(written["csv"], tmp_path), field, turn) > 3.0


@pytest.mark.parametrize("name", WITH_FIELD)
def test_fields_keep_their_phases(written: dict[str, str], field: Field, tmp_path: Path, name: str) -> None:
    """Read fields are the antenna's but for one phase for all directions, so polarisations are as well."""
    table = read(written[name], tmp_path)
    truth = field(*np.meshgrid(table.theta_deg, table.phi_deg, indexing="ij"))
    weights = solid_angles(table)[..., None]
    assert table.field is not None
    assert abs(np.sum(weights * np.conj(truth) * table.field)) == pytest.approx(1.0, abs=1e-3)
    assert np.sum(np.abs(table.field) ** 2, axis=-1) == pytest.approx(table.gain, rel=1e-12)


def test_what_the_file_tells_of_itself_is_kept(written: dict[str, str], tmp_path: Path) -> None:
    """Frequency, quantity and notes: no power in .ffd is told, nor clockwise bearings kept silent."""
    tables = {name: read(text, tmp_path) for name, text in written.items()}
    known = {name: table.frequency_hz for name, table in tables.items() if table.frequency_hz}
    assert known == dict.fromkeys(("nec", "4nec2", "ffd", "ffs"), 2.4e9)
    assert {name for name, table in tables.items() if table.quantity == "directivity"} == {"ffd", "cst"}
    assert "no power" in tables["ffd"].notes[0]
    assert mean_gain(tables["ffd"]) == pytest.approx(1.0, abs=1e-12)


def test_a_frequency_is_picked(written: dict[str, str], field: Field, tmp_path: Path) -> None:
    """Of several frequencies the stated one is read; a file that tells none takes the user's word."""
    strong, _, rows = written["ffd"].partition("Frequency 2.4e9\n")
    other = "\n".join("1.0 0.0 0.0 0.5" for _ in rows.splitlines())
    two = f"{strong}Frequency 9e8\n{other}\nFrequency 2.4e9\n{rows}"
    table = read(two, tmp_path, frequency_hz=2.4e9)
    assert table.frequency_hz == 2.4e9
    assert largest_error_db(table, field) < 0.01
    assert read(written["csv"], tmp_path, frequency_hz=9e8).frequency_hz == 9e8


def test_units_of_a_text_table(written: dict[str, str], field: Field, tmp_path: Path) -> None:
    """Gains in dB and linear, fields in V/m and in dB: the same antenna, and the right quantity."""
    rows = [line.split() for line in written["cst"].splitlines()[2:]]
    power = np.array([10.0 ** (float(row[2]) / 10.0) for row in rows])
    for head, values, quantity in (
        ("Abs(Gain)[dBi]", 10.0 * np.log10(power), "gain"),
        ("Abs(Realized Gain)[ ]", power, "realised gain"),
        ("Abs(E)[V/m]", 3.0 * np.sqrt(power), "directivity"),
        ("Abs(E)[dB(1V/m)]", 10.0 * np.log10(7.0 * power), "directivity"),
    ):
        body = "\n".join(f"{row[0]} {row[1]} {value:.8e}" for row, value in zip(rows, values, strict=True))
        table = read(f"Theta [deg.]  Phi [deg.]  {head}\n{'-' * 40}\n{body}\n", tmp_path)
        assert (table.quantity, table.field) == (quantity, None)
        assert largest_error_db(table, field) < 0.01


@pytest.mark.parametrize(
    ("gain", "peak_dbi"), [("0.0 dBd", 2.15), ("0.0", 2.15), ("2 dBi", 2.0), ("2.0dBi", 2.0)]
)
def test_two_cuts_of_an_antenna_that_is_the_same_all_round(
    msi: Callable[..., str], tmp_path: Path, gain: str, peak_dbi: float
) -> None:
    """A flat horizontal cut gives a whole pattern: down is below, and the gain is dBd unless it says dBi."""
    down = np.sin(np.radians(np.arange(360.0)))
    down_db = 16.0 * down**2 - 4.0 * down + 0.25  # the lower side is the stronger
    table = read(msi(np.zeros(360), down_db, gain), tmp_path)
    loss = peak_dbi - 10.0 * np.log10(table.gain)
    assert loss[[0, 60, 90, 120, 180], 0] == pytest.approx(down_db[[270, 330, 0, 30, 90]], abs=1e-3)
    assert np.ptp(loss, axis=1) == pytest.approx(np.zeros(181), abs=1e-9)
    assert table.frequency_hz == 2.4e9
    assert any("dBi" in note if "dBi" in gain else "dBd" in note for note in table.notes)
    assert table.notes[-1].startswith("Two cuts, and the horizontal one is flat")


def test_an_estimate_from_two_cuts_has_both_of_them(msi: Callable[..., str], tmp_path: Path) -> None:
    """Of another antenna two cuts make an estimate, which agrees with both, and the notes warn."""
    at = np.radians(np.arange(360.0))
    across_db = 3.0 - 3.0 * np.cos(at) + 1.0 * np.sin(at) + 0.2
    down_db = 8.0 - 3.0 * np.cos(at) - 2.0 * np.sin(at) - 5.0 * np.cos(at) ** 2 + 0.2
    text = msi(across_db, down_db, "3 dBi")
    table = read(text, tmp_path, estimate=True)
    loss = 3.0 - 10.0 * np.log10(table.gain)
    assert loss[90] == pytest.approx(across_db[-np.arange(360) % 360], abs=1e-3)
    assert loss[:, 0] == pytest.approx(down_db[(np.arange(181) - 90) % 360], abs=1e-3)
    assert loss[:, 180] == pytest.approx(down_db[270 - np.arange(181)], abs=1e-3)
    assert any(note.startswith("Not fit for solving: it is not the same all round") for note in table.notes)


def test_isolated_nulls_are_nulls(tmp_path: Path) -> None:
    """A direction at a floor is an exact null, of gain 0."""
    rows = [
        (theta, phi, 1.76 + 20.0 * np.log10(np.sin(np.radians(theta))) if 0 < theta < 180 else -999.99)
        for theta in range(0, 181, 10)
        for phi in range(0, 360, 10)
    ]
    text = "theta_deg,phi_deg,gain_dbi\n" + "\n".join(f"{t},{p},{g:.3f}" for t, p, g in rows)
    table = read(text, tmp_path)
    assert np.all(table.gain[[0, -1]] == 0.0)
    assert np.all(table.gain[1:-1] > 0.0)


def test_averages_are_exact(written: dict[str, str], tmp_path: Path) -> None:
    """Weights sum to 1, and average a polynomial of the cosine exactly, for odd and even numbers of steps."""
    table = read(written["csv"], tmp_path)
    for steps in (12, 15):
        theta = np.linspace(0.0, 180.0, steps + 1)
        gain = np.repeat(np.cos(np.radians(theta))[:, None] ** 6, 8, axis=1)
        coarse = PatternTable(theta_deg=theta, phi_deg=np.arange(0.0, 360.0, 45.0), gain=gain)
        assert np.sum(solid_angles(coarse)) == pytest.approx(1.0, abs=1e-14)
        assert mean_gain(coarse) == pytest.approx(1.0 / 7.0, abs=1e-14)
    assert mean_gain(table) == pytest.approx(1.0, abs=1e-4)


def test_compressed_files_are_read(written: dict[str, str], field: Field, tmp_path: Path) -> None:
    """A .gz file is the file inside it."""
    path = tmp_path / "pattern.csv.gz"
    path.write_bytes(gzip.compress(written["csv"].encode()))
    assert largest_error_db(read_pattern(path), field) < 0.01


def test_a_profile(tmp_path: Path) -> None:
    """Angles come back in order, gains linear; a floor is no gain."""
    path = tmp_path / "profile.csv"
    path.write_text("angle_deg,gain_dbi\n180,-999\n90,3.0103\n0,0\n", encoding="utf-8")
    angle_deg, gain = read_profile(path)
    assert angle_deg.tolist() == [0.0, 90.0, 180.0]
    assert gain == pytest.approx([1.0, 2.0, 0.0], abs=1e-6)


def test_every_format_is_tested(formats: dict[str, str]) -> None:
    """No format is without a writer."""
    assert {*formats.values(), "msi"} == set(FORMATS)
