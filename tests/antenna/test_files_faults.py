"""Pattern files that are refused: one message each, with the file, the line and what to do."""

import gzip
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from pattern_files import write_msi, written

from nullpose.antenna.files import read_pattern, read_profile
from nullpose.errors import ScenarioError

Change = Callable[[str], str]


def csv(gain_dbi: Callable[[int, int], float], step: int = 10) -> str:
    """Returns a table of gains."""
    rows = [f"{t},{p},{gain_dbi(t, p):.4f}" for t in range(0, 181, step) for p in range(0, 360, step)]
    return "\n".join(["theta_deg,phi_deg,gain_dbi", *rows]) + "\n"


def line(number: int, text: str) -> Change:
    """Returns what replaces a line, which is counted from 1; a list of none leaves it out."""
    return lambda whole: "\n".join(
        text if at == number else old for at, old in enumerate(whole.split("\n"), 1) if at != number or text
    )


def cut(lines: int) -> Change:
    """Returns what keeps the first lines only."""
    return lambda whole: "\n".join(whole.split("\n")[:lines])


def swap(old: str, new: str) -> Change:
    """Returns what puts one text in place of another, which must be there."""

    def swapped(whole: str) -> str:
        assert old in whole
        return whole.replace(old, new, 1)

    return swapped


def twice(whole: str) -> str:
    """Returns a .ffd file with its pattern at a second frequency as well."""
    return whole.replace("Frequencies 1", "Frequencies 2") + "Frequency 9e8\n" + whole.split("2.4e9\n")[1]


def many(whole: str, count: int) -> str:
    """Returns a .ffd file with its pattern at so many frequencies."""
    head, _, rows = whole.replace("Frequencies 1", f"Frequencies {count}").partition("Frequency 2.4e9\n")
    return head + "".join(f"Frequency {1e9 + i * 1e8:.0f}\n{rows}" for i in range(count))


def named(column: str, gain: float) -> Change:
    """Returns what puts a table of one gain, under another name, in place of a file."""
    return lambda _: csv(lambda t, p: gain).replace("gain_dbi", column)


def only(kept: Callable[[int], bool]) -> Change:
    """Returns what leaves those rows of both cuts whose angle is to be kept."""

    def some(whole: str) -> str:
        rows = [x for x in whole.split("\n") if not x[:1].isdigit() or kept(int(x.split()[0]))]
        return "\n".join(rows).replace(" 360\n", f" {sum(map(kept, range(360)))}\n")

    return some


FIELDS, GAINS = "complex-csv", "csv"
FAULTS: dict[str, tuple[str, Change, dict[str, object], str]] = {
    "empty": (GAINS, lambda _: " \n\n", {}, "the file is empty"),
    "unknown": (GAINS, lambda _: "hello\n", {}, "no known format; export .* nec, ffs, cst"),
    "other format": (GAINS, str, {"file_format": "ffd"}, "must be one of nec.*it looks like csv"),
    "no such format": (GAINS, str, {"file_format": "ffe"}, "got the format 'ffe', must be one of nec"),
    "short csv": (FIELDS, cut(1000), {}, "angles are 0, 5, 10 ... 65 degrees, must go from 0 to 180"),
    "short nec": ("nec", cut(1000), {}, "azimuths are 0, 5, 10 .* must go from 0 to 360 .* cut short"),
    "short nec head": ("nec", cut(6), {}, "there is no table of gains or fields in it"),
    "no field": ("nec", lambda text: text.replace("E-0", "E-900"), {}, "line 4: the table has no field but"),
    "no nec table": ("nec", swap("RADIATION PATTERNS", "X"), {"file_format": "nec"}, "looks like none of"),
    "short ffd": ("ffd", cut(1000), {}, "line 1000: 2701 rows are announced and 996 lines follow"),
    "short ffs": ("ffs", cut(1000), {}, "line 1000: 2701 rows are announced and"),
    "ffs without power": ("ffs", swap("Stimulated Power", ""), {}, "the powers, or the counts"),
    "ffs with no power": ("ffs", swap("1\n4.0", "1\n0.0"), {}, "line 22: got 0.4 W radiated, 0 W accepted"),
    "ffd of nothing": ("ffd", line(1, "0 180 -3"), {}, "line 1: got -3 angles, must be a whole number from 1 to 3601"),  # noqa: E501
    "short cst": ("cst", cut(2), {}, "there is no row of theta, phi, abs"),
    "cst without gain": ("cst", swap("Abs(Dir.)", "Foo"), {}, "line 1: must have columns Theta .*, Phi .* and Abs"),  # noqa: E501
    "no number": (GAINS, line(7, "0,0,x"), {}, "line 7: got '0,0,x', must be 3 finite numbers"),
    "nan": (GAINS, line(7, "0,0,nan"), {}, "line 7: got '0,0,nan', must be 3 finite numbers"),
    "nan in nec": ("nec", line(40, "155 0 1 1 1 1 1 nan 0 0 0"), {}, "line 40: got '155 0 .* 11 finite"),
    "infinite": ("ffd", line(9, "1 2 inf 0"), {}, "line 9: got '1 2 inf 0', must be 4 finite numbers"),
    "overflow": ("ffd", line(9, "1 2 1e200 0"), {}, "line 9: got '1 2 1e200 0', must be 4 finite"),
    "beyond measure": (
        "ffs",
        swap("\n4.000000e-01\n4.000000e-01", "\n1e-300\n1e-300"),
        {},
        "has a field beyond",
    ),
    "turned": ("ffs", swap("Axis\n0 0 1", "Axis\n0 1 0"), {}, "line 16: its zaxis is 0 1 0, must be 0 0 1"),
    "fewer than announced": ("ffs", swap("s\n1\n", "s\n2\n"), {}, "2 frequencies are announced and 1 follow"),
    "powers": ("ffs", swap("4.000000e-01\n4.0", "4.000000e-01\n3.0"), {}, "0.4 W radiated, 0.3 W accepted"),
    "no pattern in nec": (
        "nec",
        lambda text: text.replace("RADIATION PATTERNS", "NUMERICAL ELECTROMAGNETICS CODE"),
        {},
        "without a pattern; add an RP card to the input, such as RP 0 37 73 1000",
    ),
    "no pattern in mininec": ("mininec", swap("PATTERN DATA", "CURRENT DATA"), {}, "MININEC without a pattern"),  # noqa: E501
    "fields in mininec": ("mininec", line(11, "0 0 1 2 3 4"), {}, "line 11: .* three gains in dBi: not fields"),  # noqa: E501
    "gain and field": ("nec", line(40, "155 0 1 1 9 1 1 .1 0 .1 0"), {}, "line 40: .* contradict each other"),
    "unit": ("cst", swap("Abs(Dir.)[dBi", "Abs(Gain)[dBm"), {}, "line 1: got a gain in .dbm., must be in"),
    "no directivity": (GAINS, named("dB(DirTotal)", 2.0), {}, "its directivity averages to 2.0 dB"),
    "below 0": (GAINS, named("GainTotal", -2.0), {}, "line 2: theta = 0, phi = 0 degrees has a gain below 0"),
    "unit of frequency": ("hfss-csv", swap("GHz", "Hz"), {}, "its frequency is 2.4 Hz, must be 1 kHz to"),
    "decimal commas": ("cst", lambda text: text.replace(".0", ",0"), {}, "line 3: .* points in place of"),
    "alone": (
        GAINS,
        lambda text: re.sub(r"\n65,45,[^\n]*", "\n65,45,-15.0", text),
        {},
        r"line \d+: theta = 65, phi = 45 degrees has a gain of -15.00 dBi, which does not fit",
    ),
    "tabs": (GAINS, line(1, "theta_deg,\tphi_deg,\tgain"), {}, "got the header .* must have theta_deg,phi"),
    "numbers": (GAINS, lambda _: "-1.4\n-1.5\n-1.6\n", {}, "it has the marks of no known format"),
    "one cut": (GAINS, lambda text: re.sub(r"\n\d+,[1-9][^\n]*", "", text), {}, "it has one cut, at phi = 0"),
    "columns": (GAINS, line(7, "0,0"), {}, "line 7: got '0,0', must be 3 finite numbers"),
    "header": (GAINS, line(1, "theta_deg,phi_deg,gain"), {}, "line 1: got the header .* must have theta_deg"),
    "hole": (FIELDS, line(800, ""), {}, "no row for theta = 55, phi = 30 degrees; the grid must"),
    "beyond theta": (FIELDS, line(9, "181,0,0,0,0,0"), {}, "line 9: theta = 181, phi = 0 .* beyond"),
    "beyond phi": (FIELDS, line(9, "0,361,0,0,0,0"), {}, "line 9: theta = 0, phi = 361 .* beyond"),
    "twice": (FIELDS, swap("\n5,5,", "\n5,0,1,2,3,4\n5,5,"), {}, "line 74: theta = 5, .* is given twice"),
    "pole": (FIELDS, line(9, "0,35,9,9,9,9"), {}, "line 9: .* phi = 35 degrees is given twice"),
    "seam": ("ffd", line(77, "9 9 9 9"), {}, "line 77: theta = 0, phi = 180 degrees is given twice"),
    "uneven": (FIELDS, lambda text: text.replace("\n5,", "\n6,"), {}, "are 0, 6, 10 .* equal steps"),
    "half a sphere": (
        "csv",
        lambda _: "\n".join(csv(lambda t, p: 0.0).split("\n")[: 1 + 10 * 36]),
        {},
        "polar angles are 0, 10, 20 ... 90 degrees, must go from 0 to 180",
    ),
    "frequencies": ("ffd", twice, {}, "2 tables, at 2400000000, 900000000 Hz; state one frequency"),
    "frequency": ("ffd", twice, {"frequency_hz": 1e9}, "1000000000 Hz, must be one of .* 900000000 Hz"),
    "many": ("ffd", lambda text: many(text, 10), {}, "1600000000, 1700000000 Hz and 2 more; state one"),
    "no frequency": (GAINS, str, {"frequency_hz": 0.0}, "got the frequency 0 Hz, must be one of"),
    "only frequency": ("nec", str, {"frequency_hz": 1e9}, "must be one of the file's: 2400000000 Hz"),
    "nothing": (GAINS, lambda _: csv(lambda t, p: -999.0), {}, "no direction has any gain"),
    "over-fed": (GAINS, lambda _: csv(lambda t, p: 3.0), {}, "average gain .* is 3.0 dB: it radiates more"),
    "floor": (GAINS, lambda _: csv(lambda t, p: 0.0 if t < 90 else -999.99), {}, "54 % of all directions"),
    "coarse": (
        "csv",
        lambda _: csv(lambda t, p: -1.0 - 6.0 * np.sin(np.radians(9.0 * t)) ** 2, 30),
        {},
        "steps of 30 degrees do not follow the pattern: .* export finer steps",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_faults(tmp_path: Path, name: str) -> None:
    """A fault is one message that names the file, and says what is wrong and what must be."""
    kind, change, options, message = FAULTS[name]
    path = tmp_path / "pattern.txt"
    path.write_text(change(written(kind)), encoding="utf-8")
    with pytest.raises(ScenarioError, match=message) as caught:
        read_pattern(path, **options)
    assert len(caught.value.faults) == 1
    assert str(caught.value).startswith(f"{path}: 1 fault\n")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "cannot be read: No such file"),
        (
            gzip.compress(b"theta_deg,phi_deg,gain_dbi\n" * 1000)[:-30],
            "its content is cut short, or exceeds 60 MB",
        ),
        (gzip.compress(bytes(61_000_000)), "its content is cut short, or exceeds 60 MB"),
        (b"\x1f\x8bnothing", "cannot be read: Error -3"),
        (bytes(range(256)), "no known format"),
    ],
    ids=["missing", "cut", "bomb", "broken", "binary"],
)
def test_files_that_cannot_be_read(tmp_path: Path, content: bytes | None, message: str) -> None:
    """What is no readable file is told so, however it is broken, and a bomb is not unpacked."""
    path = tmp_path / "pattern.gz"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ScenarioError, match=message):
        read_pattern(path)


@pytest.mark.parametrize("level", [0.4, -999.99])
def test_the_average_may_be_half_a_decibel_high(tmp_path: Path, level: float) -> None:
    """Rounding and meshes are forgiven, and directions without gain where they are few."""
    path = tmp_path / "pattern.csv"
    path.write_text(csv(lambda t, p: 0.4 if 0 < t < 180 else max(level, -40.0)), encoding="utf-8")
    with pytest.raises(ScenarioError, match="do not follow") if level < 0.0 else pytest.MonkeyPatch.context():
        read_pattern(path)


def test_two_cuts_are_no_pattern(tmp_path: Path) -> None:
    """An antenna that is not the same all round is refused, unless an estimate is asked for and said."""
    path = tmp_path / "pattern.msi"
    at = np.radians(np.arange(360.0))
    cuts = 12.0 * np.sin(at / 2.0) ** 2, 8.0 * np.sin(at) ** 2 + 12.0 * np.sin(at / 2.0) ** 2
    path.write_text(write_msi(*cuts, "0 dBi"), encoding="utf-8")
    with pytest.raises(ScenarioError, match=r'horizontal cut changes by 12\.0 dB.* write two_cuts = "sum-of'):
        read_pattern(path)
    table = read_pattern(path, estimate=True)
    assert "estimate by the sum of losses" in table.caveat
    assert f"Estimate: {table.caveat}." in table.notes


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (swap("GAIN 0 dBi", ""), "line 1: got '', must be one finite number: GAIN"),
        (swap("VERTICAL 360", ""), "cut VERTICAL is missing"),
        (cut(300), "the cut VERTICAL is missing"),
        (cut(500), "line 500: 360 rows are announced"),
        (swap("\n7 ", "\nx "), "line 15: got 'x .*must be 2 finite numbers: an angle and a loss"),
        (only(lambda at: at <= 180), "line 188: the cut HORIZONTAL at 180 degrees is too far from the next"),
        (only(lambda at: not 40 < at < 90), "line 48: the cut HORIZONTAL at 40 degrees is too far"),
        (only(lambda at: at % 90 == 0), "line 8: the cut HORIZONTAL at 0 degrees is too far from the next"),
        (swap("\n7 0.0", "\n6 0.5"), "line 15: the cut HORIZONTAL at 6 degrees is given twice"),
        (swap("\n7 0", "\n7 -3"), "line 15: the cut HORIZONTAL at 7 degrees has a loss below 0"),
        (swap("HORIZONTAL 360", "HORIZONTAL 350"), "line 358: the cut HORIZONTAL has more rows than the 350"),
        (lambda whole: whole + whole, "line 731: FREQUENCY is given twice"),
        (lambda whole: whole.replace(".", ","), "line 8: got '0 0,0000', .* decimal points in place of"),
    ],
)
def test_faults_of_two_cuts(tmp_path: Path, change: Change, message: str) -> None:
    """The cuts and the gain must all be there."""
    path = tmp_path / "pattern.msi"
    path.write_text(change(write_msi(np.zeros(360), np.zeros(360), "0 dBi")), encoding="utf-8")
    with pytest.raises(ScenarioError, match=message):
        read_pattern(path)


def test_cuts_of_a_tilted_beam_are_named(tmp_path: Path) -> None:
    """Where the cuts do not cross, a tilt is told from angles that are measured from the zenith."""
    path, at = tmp_path / "pattern.msi", np.radians(np.arange(360.0))
    for tilt_deg, words in ((10, "the vertical one at 10: ask for cuts without"), (90, "from the zenith")):
        off = at - np.radians(tilt_deg)
        down_db = 40.0 * np.sin(off) ** 2 + np.sin(off / 2.0) ** 2
        path.write_text(write_msi(10.0 * np.sin(at / 2.0) ** 2, down_db, "9 dBi"), encoding="utf-8")
        with pytest.raises(ScenarioError, match=f"ahead, where its cuts cross.*{words}"):
            read_pattern(path)


def test_an_estimate_is_no_way_round_other_refusals(tmp_path: Path) -> None:
    """Only two cuts are estimated, and not those whose gain no antenna has."""
    loss_db = 3.0 * np.sin(np.radians(np.arange(360.0)) / 2.0) ** 2
    for text in (write_msi(loss_db, loss_db, "9 dBi"), csv(lambda t, p: 3.0)):
        (path := tmp_path / "hot").write_text(text, encoding="utf-8")
        with pytest.raises(ScenarioError, match="more than it is fed"):
            read_pattern(path, estimate=True)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("angle_deg,gain_dbi\n0,0\n90,0\n", "angles are 0, 90, 90 degrees .* must go from 0 to 180"),
        ("angle_deg,gain_dbi\n5,0\n180,0\n", "must go from 0 to 180"),
        ("angle_deg,gain_dbi\n0,0\n90,0\n90,1\n180,0\n", "each given once"),
        ("angle_deg,gain_dbi\n", "there is no row of angle_deg,gain_dbi"),
        ("angle_deg,gain_dbi\n0,0\n90,inf\n180,0\n", "line 3: got '90,inf'"),
        ("theta_deg,phi_deg,gain_dbi\n0,0,0\n", "line 1: got the header .* must have angle_deg,gain_dbi"),
        ("angle_deg,gain_dbi\n0,20\n180,20\n", "average gain .* is 20.0 dB: it radiates more"),
        ("angle_deg,gain_dbi\n0,-999.99\n60,-999.99\n61,0\n180,0\n", "25 % of all directions have no gain"),
        ("", "the file is empty"),
    ],
)
def test_faults_of_profiles(tmp_path: Path, text: str, message: str) -> None:
    """A profile must span all angles, each once."""
    path = tmp_path / "profile.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ScenarioError, match=message):
        read_profile(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("##File Type: Far Field\n#Frequency: 2.4E9\n", "a far field of FEKO"),
        (
            "EZNEC Pro/2 ver. 6.0\n\nDeg      V dB     H dB   Tot dB\n  0   -3.0 -99.99 -3.0\n",
            "a table of EZNEC",
        ),
        ("REVNUM:,NSMA WG16.99.050\nREVDAT:,19990520\n", "two cuts as of NSMA"),
        ("Field data in cuts\n 0.0 5.0 37 0.0 3 1 2\n", "cuts of GRASP"),
        (
            "Az. [deg.]  El. [deg.]  Abs(Gain)[dBi ]\n---\n0 0 1\n",
            "a table of CST over other angles; export Theta and Phi",
        ),
        ("elevation_deg,azimuth_deg,gain_dbi\n0,0,1\n", "a table over elevations: theta is 90 less"),
    ],
)
def test_formats_that_are_not_read_are_named(tmp_path: Path, text: str, message: str) -> None:
    """Each by its name, with the way out."""
    (path := tmp_path / "pattern.txt").write_text(text, encoding="utf-8")
    with pytest.raises(ScenarioError, match=f"no known format: it looks like {message}.*export the pattern"):
        read_pattern(path)


def test_elevations_are_no_polar_angles(tmp_path: Path) -> None:
    """A whole sphere of elevations, under the name theta, is told apart from one that is cut short."""
    text = csv(lambda t, p: 1.76 + 20.0 * np.log10(max(np.sin(np.radians(t)), 1e-3)))
    rows = [line.split(",") for line in text.split("\n")[1:-1]]
    table = "\n".join(["theta_deg,phi_deg,gain_dbi", *(f"{90 - int(t)},{p},{g}" for t, p, g in rows)])
    (path := tmp_path / "elevation.csv").write_text(table, encoding="utf-8")
    with pytest.raises(ScenarioError, match=r"theta goes from -90 to 90 degrees.* write 90 less each"):
        read_pattern(path)


def test_steps_that_are_too_coarse_are_said_to_be(tmp_path: Path) -> None:
    """Where the rows of a pole agree and fit no other row, no row is written wrong."""
    path = tmp_path / "helix.csv"
    helix = lambda t: -1.0 - 8.0 * (t / 180.0) ** 2 - 3.0 * np.cos(np.radians(3.5 * t))  # noqa: E731
    path.write_text(csv(lambda t, p: helix(t), 20), encoding="utf-8")
    with pytest.raises(ScenarioError, match="steps of 20 degrees are too coarse"):
        read_pattern(path)


def collinear(tilt_deg: float) -> np.ndarray:
    """Returns the vertical cut of a whip whose beam is tilted down on all sides."""
    at = np.arange(360.0)
    below = np.where((at < 90.0) | (at > 270.0), (at + 180.0) % 360.0 - 180.0, 180.0 - at)
    return np.minimum(12.0 * ((below - tilt_deg) / 14.0) ** 2, 30.0)


@pytest.mark.parametrize(
    ("head", "down_db", "message"),
    [
        (
            "ELECTRICAL_TILT 6",
            collinear(0.0),
            "line 5: ELECTRICAL_TILT is 6 degrees, .* 2.2 dB below its peak",
        ),
        ("TILT 3", collinear(-3.0), "TILT is 3 degrees, .* growing downwards"),
        ("TILT 0", collinear(0.0) + 3.0, "no direction has a loss below 3 dB"),
    ],
)
def test_cuts_that_contradict_their_heading(
    tmp_path: Path, head: str, down_db: np.ndarray, message: str
) -> None:
    """The tilt that is stated is in the vertical cut, and the gain in some direction."""
    text = write_msi(np.full(360, down_db[0]), down_db, "5 dBi").replace("TILT 0", head)
    (path := tmp_path / "whip.msi").write_text(text, encoding="utf-8")
    with pytest.raises(ScenarioError, match=message):
        read_pattern(path)


def test_what_a_file_has_besides_is_named(tmp_path: Path) -> None:
    """Columns of a table and numbers of a heading that are not read are in a note."""
    whip = write_msi(np.full(360, 0.0), collinear(0.0), "5 dBi").replace("TILT 0", "TILT 0\nFRONT_TO_BACK 25")
    table = csv(lambda t, p: -1.0).replace("gain_dbi", "efficiency_db,gain_dbi")
    table = re.sub(r"(\n\d+,\d+),", r"\1,-3,", table)
    for text, note in (
        (whip, "Not read: FRONT_TO_BACK."),
        (table, "Columns that are not read: efficiency_db."),
    ):
        (path := tmp_path / "pattern").write_text(text, encoding="utf-8")
        assert note in read_pattern(path).notes
