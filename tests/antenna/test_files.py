"""Pattern files: one antenna in every format is one function of the direction."""

import gzip
from pathlib import Path

import numpy as np
import pytest
from pattern_files import DATA, WRITERS, field_of, write_msi, written

from nullpose.antenna.files import read_pattern, read_profile
from nullpose.antenna.harmonics import directions
from nullpose.antenna.pattern import deepest_null, table_harmonics
from nullpose.antenna.table import PatternTable, mean_gain, solid_angles
from nullpose.errors import ScenarioError

WITH_FIELD = ("nec", "4nec2", "ffd", "old-ffd", "ffs", "cst", "complex-csv")
NAMES = (*WITH_FIELD, "csv", "hfss-csv", "hfss-linear", "cst-gains")


def read(text: str, folder: Path, **options: object) -> PatternTable:
    """Returns the table of a file's content."""
    path = folder / "pattern.txt"
    path.write_text(text, encoding="utf-8")
    return read_pattern(path, **options)


def largest_error_db(table: PatternTable) -> float:
    """Returns by how much a table differs from the known antenna, 30 dB below the peak and above."""
    angles = np.meshgrid(table.theta_deg, table.phi_deg, indexing="ij")
    gain = np.sum(np.abs(field_of(*angles)) ** 2, axis=-1)
    seen = gain > 1e-3 * np.max(gain)
    return float(np.max(np.abs(10.0 * np.log10(table.gain[seen] / gain[seen]))))


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> dict[str, PatternTable]:
    """The table of the same antenna in every format, told from the content."""
    return {name: read(written(name, 10.0), tmp_path_factory.mktemp(name)) for name in WRITERS}


@pytest.mark.parametrize("name", NAMES)
def test_every_format_gives_the_same_antenna(
    tmp_path: Path, tables: dict[str, PatternTable], name: str
) -> None:
    """In every direction the gain is the antenna's to .01 dB, whether the format is stated or told."""
    for table in (tables[name], read(written(name, 10.0), tmp_path, file_format=WRITERS[name][0])):
        assert largest_error_db(table) < 0.01
        assert table.source == f"pattern.txt ({WRITERS[name][0]})"
        assert table.theta_deg[[0, -1]].tolist() == [0.0, 180.0]
        assert table.phi_deg[0] == 0.0
        assert table.phi_deg[-1] < 360.0
        assert (table.field is not None) == (name in WITH_FIELD)


@pytest.mark.parametrize("name", WITH_FIELD)
def test_fields_keep_their_phases(tables: dict[str, PatternTable], name: str) -> None:
    """Read fields are the antenna's but for one phase for all directions, so polarisations are as well."""
    table = tables[name]
    truth = field_of(*np.meshgrid(table.theta_deg, table.phi_deg, indexing="ij"))
    weights = solid_angles(table)[..., None]
    assert table.field is not None
    assert abs(np.sum(weights * np.conj(truth) * table.field)) == pytest.approx(1.0, abs=1e-3)
    assert np.sum(np.abs(table.field) ** 2, axis=-1) == pytest.approx(table.gain, rel=1e-12)


def test_what_the_file_tells_of_itself_is_kept(tables: dict[str, PatternTable]) -> None:
    """Frequency, quantity and notes: no power in .ffd is told, nor clockwise bearings kept silent."""
    known = {name: table.frequency_hz for name, table in tables.items() if table.frequency_hz}
    assert known == dict.fromkeys(("nec", "4nec2", "ffd", "ffs", "hfss-csv", "hfss-linear", "mininec"), 2.4e9)
    directive = {name for name, table in tables.items() if table.quantity == "directivity"}
    assert directive == {"ffd", "old-ffd", "cst"}
    realised = {name for name, table in tables.items() if table.quantity == "realised gain"}
    assert realised == {"hfss-linear", "cst-gains"}
    assert "no power" in tables["ffd"].notes[0]
    assert mean_gain(tables["ffd"]) == pytest.approx(1.0, abs=1e-12)


def test_a_frequency_is_picked(tmp_path: Path) -> None:
    """Of several frequencies the stated one is read; a file that tells none takes the user's word."""
    strong, _, rows = written("ffd").replace("Frequencies 1", "Frequencies 2").partition("Frequency 2.4e9\n")
    other = "\n".join("1.0 0.0 0.0 0.5" for _ in rows.splitlines())
    two = f"{strong}Frequency 9e8\n{other}\nFrequency 2.4e9\n{rows}"
    table = read(two, tmp_path, frequency_hz=2.4e9)
    assert table.frequency_hz == 2.4e9
    assert largest_error_db(table) < 0.01
    assert read(written("csv"), tmp_path, frequency_hz=9e8).frequency_hz == 9e8


def test_units_of_a_text_table(tmp_path: Path) -> None:
    """Gains in dB and linear, fields in V/m and in dB: the same antenna, and the right quantity."""
    rows = [line.split() for line in written("cst").splitlines()[2:]]
    power = np.array([10.0 ** (float(row[2]) / 10.0) for row in rows])
    for head, values, quantity in (
        ("Abs(Gain)[dBi]", 10.0 * np.log10(power), "gain"),
        ("Abs(Realized Gain)[ ]", power, "realised gain"),
        ("Abs(E)[V/m]", 3.0 * np.sqrt(power), "directivity"),
        ("Abs(E)[dB(1V/m)]", 10.0 * np.log10(7.0 * power), "directivity"),
        ("Abs(E)[dBuV/m]", 10.0 * np.log10(7.0 * power) + 120.0, "directivity"),
        ("Abs(E)[]", 3.0 * np.sqrt(power), "directivity"),
        ("Abs(Gain)[dBd]", 10.0 * np.log10(power) - 2.15, "gain"),
        ("Abs(Grlz)[dB]", 10.0 * np.log10(power), "realised gain"),
    ):
        body = "\n".join(f"{row[0]} {row[1]} {value:.8e}" for row, value in zip(rows, values, strict=True))
        table = read(f"Theta [deg.]  Phi [deg.]  {head}\n{'-' * 40}\n{body}\n", tmp_path)
        assert (table.quantity, table.field) == (quantity, None)
        assert largest_error_db(table) < 0.01


@pytest.mark.parametrize(
    ("gain", "peak_dbi"), [("0.0 dBd", 2.15), ("0.0", 2.15), ("2 dBi", 2.0), ("2.0dBi", 2.0)]
)
def test_two_cuts_of_an_antenna_that_is_the_same_all_round(
    tmp_path: Path, gain: str, peak_dbi: float
) -> None:
    """A flat horizontal cut gives a whole pattern: down is below, and the gain is dBd unless it says dBi."""
    down = np.sin(np.radians(np.arange(360.0)))
    down_db = 16.0 * down**2 - 4.0 * down + 0.25  # the lower side is the stronger
    table = read(write_msi(np.zeros(360), down_db, gain), tmp_path)
    loss = peak_dbi - 10.0 * np.log10(table.gain)
    assert loss[[0, 60, 90, 120, 180], 0] == pytest.approx(down_db[[270, 330, 0, 30, 90]], abs=1e-3)
    assert np.ptp(loss, axis=1) == pytest.approx(np.zeros(181), abs=1e-9)
    assert table.frequency_hz == 2.4e9
    assert any("dBi" in note if "dBi" in gain else "dBd" in note for note in table.notes)
    assert "horizontal cut's ripple of 0.0 dB, and 0.0 dB between the halves" in table.notes[1]
    assert table.notes[2] == "Its FREQUENCY, 2400, is read in MHz."
    assert table.caveat == ""


def test_the_profile_of_an_omni_is_the_mean_of_its_halves(tmp_path: Path) -> None:
    """A horizontal cut within 1.5 dB makes a profile, whose note says what it leaves out."""
    at = np.radians(np.arange(360.0))
    down_db = 10.0 * np.sin(at) ** 2 + 0.5 * (1.0 - np.cos(at))
    table = read(write_msi(0.7 * (1.0 - np.cos(at)), down_db, "0 dBi"), tmp_path)
    halves = 10.0 ** (-np.stack([down_db[np.arange(-90, 91)], down_db[270 - np.arange(181)]]) / 10.0)
    assert table.gain == pytest.approx(np.tile(np.mean(halves, axis=0), (360, 1)).T, rel=1e-4)
    assert table_harmonics(table).is_axisymmetric
    assert "ripple of 1.4 dB, and 1.0 dB between the halves" in table.notes[1]


AT = np.radians(np.arange(360.0))
BEAM_DB = 8.0 - 8.0 * np.cos(AT)
REAR_DB = 9.0 * (1.0 - np.cos(AT)) + 3.0 * np.cos(AT) ** 2


@pytest.mark.parametrize(
    ("across_db", "down_db"),
    [
        (BEAM_DB + np.sin(AT) ** 2, BEAM_DB + 9.0 * np.sin(AT) ** 2),
        (REAR_DB, REAR_DB + 12.0 * np.sin(AT) ** 2 * np.cos(AT)),  # less than straight behind
    ],
    ids=["beam", "rear"],
)
def test_an_estimate_from_two_cuts_has_both_of_them(
    tmp_path: Path, across_db: np.ndarray, down_db: np.ndarray
) -> None:
    """It agrees with both cuts, whether it points ahead or the rear is the stronger, and says what it is."""
    least_db = min(across_db)
    text = write_msi(across_db - least_db, down_db - least_db, f"{9.0 - least_db} dBi")
    table = read(text, tmp_path, estimate=True)
    with np.errstate(divide="ignore"):
        loss = 9.0 - 10.0 * np.log10(table.gain)
    assert loss[90] == pytest.approx(across_db[-np.arange(360) % 360], abs=1e-3)
    assert loss[1:-1, 0] == pytest.approx(down_db[(np.arange(1, 180) - 90) % 360], abs=1e-3)
    assert loss[1:-1, 180] == pytest.approx(down_db[270 - np.arange(1, 180)], abs=1e-3)
    if across_db[0] == 0.0:
        assert np.unravel_index(np.argmax(table.gain), table.gain.shape) == (90, 0)
        assert np.min(loss) == pytest.approx(0.0, abs=1e-9)
        assert solid_angles(table)[loss < 3.0].sum() < 0.1
        assert "estimate by the sum of losses: its horizontal cut changes by 16.0 dB" in table.caveat
        at_half = loss[45, 90]  # theta 45, phi 90: half of each half of the vertical cut
        assert at_half == pytest.approx(across_db[270] + 0.5 * (down_db[315] + down_db[225] - 16.0), abs=1e-3)


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


def test_averages_are_exact(tables: dict[str, PatternTable]) -> None:
    """Weights sum to 1, and average a polynomial of the cosine exactly, for odd and even numbers of steps."""
    for steps in (12, 15):
        theta = np.linspace(0.0, 180.0, steps + 1)
        gain = np.repeat(np.cos(np.radians(theta))[:, None] ** 6, 8, axis=1)
        coarse = PatternTable(theta_deg=theta, phi_deg=np.arange(0.0, 360.0, 45.0), gain=gain)
        assert np.sum(solid_angles(coarse)) == pytest.approx(1.0, abs=1e-14)
        assert mean_gain(coarse) == pytest.approx(1.0 / 7.0, abs=1e-14)
    assert mean_gain(tables["csv"]) == pytest.approx(1.0, abs=1e-4)


def far_field(step_deg: float, offset_m: np.ndarray) -> str:
    """Returns a table of the fields of the antenna that is away from the origin, at 300 MHz."""
    theta, phi = np.meshgrid(np.arange(0.0, 181.0, step_deg), np.arange(0.0, 360.0, step_deg), indexing="ij")
    towards = directions(np.arange(0.0, 181.0, step_deg), np.arange(0.0, 360.0, step_deg))
    parts = field_of(theta, phi) * np.exp(2j * np.pi * towards @ offset_m)[..., None]
    rows = zip(theta.ravel(), phi.ravel(), *parts.reshape(-1, 2).T, strict=True)
    lines = [f"{t:g},{p:g},{a.real:.7f},{a.imag:.7f},{b.real:.7f},{b.imag:.7f}" for t, p, a, b in rows]
    return "\n".join(["theta_deg,phi_deg,re_theta,im_theta,re_phi,im_phi", *lines]) + "\n"


@pytest.mark.parametrize("away_m", [0.0, 3.0, 5.0, 30.0])
def test_an_antenna_far_from_the_origin_is_read(tmp_path: Path, away_m: float) -> None:
    """Whatever its phases, which turn too fast for steps of 10 degrees, solvers use its gains to .02 dB."""
    table = read(far_field(10.0, away_m * np.array([0.6, 0.0, 0.8])), tmp_path)
    theta_deg, phi_deg = np.arange(3.0, 180.0, 7.0), np.arange(3.0, 360.0, 7.0)
    used = table_harmonics(table).gain(directions(theta_deg, phi_deg))
    truth = np.sum(np.abs(field_of(*np.meshgrid(theta_deg, phi_deg, indexing="ij"))) ** 2, axis=-1)
    strong = truth > 1e-2 * np.max(truth)
    assert np.max(np.abs(10.0 * np.log10(used[strong] / truth[strong]))) < 0.05


def test_no_null_is_deeper_than_the_files() -> None:
    """What solvers use has no gain below the smallest one of the file, on any grid."""
    table = read_pattern(DATA / "hex35_beside_10_half_5deg.out.gz")
    used, least = table_harmonics(table), np.min(table.gain)
    assert np.min(used.on_grid(*(np.radians(np.arange(0.05, end, 0.7)) for end in (180.0, 360.0)))) >= least
    assert deepest_null(used)[0] >= least * (1.0 - 1e-9)


def test_two_tables_at_one_frequency(tmp_path: Path) -> None:
    """The one over the whole sphere is read beside a cut, and a note says so; of two whole ones none is."""
    head, table = written("nec").split(" ---------- RADIATION", 1)
    whole = " ---------- RADIATION" + table
    cut = "\n".join(line for line in whole.split("\n") if line[5:6] != "." or line[9:17].strip() == "0.00")
    found = read(head + cut.replace("TOTAL RUN TIME", "") + whole, tmp_path)
    assert largest_error_db(found) < 0.01
    assert found.notes == ("Other tables at this frequency do not cover the sphere; they are not read.",)
    with pytest.raises(ScenarioError, match="2 tables at one frequency, from the lines"):
        read(head + whole + whole, tmp_path)


def test_compressed_files_are_read(tmp_path: Path) -> None:
    """A .gz file is the file inside it."""
    path = tmp_path / "pattern.csv.gz"
    path.write_bytes(gzip.compress(written("csv").encode()))
    assert largest_error_db(read_pattern(path)) < 0.01


def test_a_profile(tmp_path: Path) -> None:
    """Angles come back in order, gains linear; a floor is no gain."""
    path = tmp_path / "profile.csv"
    path.write_text("angle_deg,gain_dbi\n180,-999\n90,0\n0,-3.0103\n", encoding="utf-8")
    angle_deg, gain, _ = read_profile(path)
    assert angle_deg.tolist() == [0.0, 90.0, 180.0]
    assert gain == pytest.approx([0.5, 1.0, 0.0], abs=1e-6)
