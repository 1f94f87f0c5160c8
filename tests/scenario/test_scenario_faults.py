"""Every fault that a scenario file can have: where it is reported, and in which words."""

import re
from dataclasses import dataclass

import pytest
from hypothesis import given, strategies as st

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario.loading import scenario_from_text

GOOD = """\
name = "test"
[airspace]
altitude_m = [8.0, 30.0]
keep_out_m = 1.5
[receiver]
noise_w = 1e-3
reference_gain_db = 0.0
[[nodes]]
name = "S1"
position_m = [0.0, 0.0, 0.0]
power_w = 1.0
[[nodes]]
name = "S2"
position_m = [0.0, 50.0, 0.0]
power_w = 2.0
[[jammers]]
name = "M"
position_m = [17.0, 15.0, 4.0]
power_w = 3.0
"""

LIBRARY_WORDS = re.compile(
    r"pydantic|https?:|validation|input should|type=|tuple|dict|_error|[A-Z]\w*Error|None|class|Extra inputs",
    re.IGNORECASE,
)


@dataclass(frozen=True)
class Case:
    """An edit of the good file, and the one fault that it makes."""

    old: str
    new: str
    path: str
    words: tuple[str, ...]

    def __str__(self) -> str:
        return self.new.replace("\n", " / ") or f"without {self.old}"


def case(old: str, new: str, path: str, *words: str) -> Case:
    """Returns a case; the old text must be there once."""
    assert GOOD.count(old) == 1, old
    return Case(old, new, path, words)


ALTITUDE, KEEP_OUT = "altitude_m = [8.0, 30.0]", "keep_out_m = 1.5"
NOISE, GAIN = "noise_w = 1e-3", "reference_gain_db = 0.0"
POSITION, POWER, NAME = "position_m = [17.0, 15.0, 4.0]", "power_w = 3.0", 'name = "M"'
WATTS = "a power in W from 1e-30 to 1e+30"
POINT = "a list of three numbers [x, y, z]: metres east, north and up"
INTERVAL = "a list of two numbers in m, the lowest first"

FIELD_CASES = [
    # powers
    case(POWER, "power_w = 0.0", "jammers[0].power_w", "got 0.0", WATTS, "never zero or negative", "_dbm"),
    case(POWER, "power_w = inf", "jammers[0].power_w", "got infinity", WATTS),
    case(POWER, "power_w = 1e31", "jammers[0].power_w", "got 1e+31", WATTS),
    case(POWER, f"power_w = {'9' * 400}", "jammers[0].power_w", "got an integer beyond 1e+15", WATTS),
    case(POWER, "power_w = true", "jammers[0].power_w", "the truth value true", "must be a number"),
    case(POWER, 'power_w = "3"', "jammers[0].power_w", 'the text "3"', "write it without quotes"),
    case(POWER, "power_w = 2024-05-01", "jammers[0].power_w", "a date or time", "must be a number"),
    case(POWER, "power_dbm = -271", "jammers[0].power_dbm", "got -271", "-270 to 330", "in W", "_w"),
    case(POWER, "power_dbm = nan", "jammers[0].power_dbm", "got NaN", "dBm"),
    # either-or pairs
    case(POWER, "", "jammers[0]", "neither power_w nor power_dbm", "exactly one", "add either"),
    case(POWER, f"{POWER}\npower_dbm = 5", "jammers[0]", "both power_w and power_dbm", "remove either"),
    case(NOISE, "", "receiver", "neither noise_w nor noise_dbm", "exactly one"),
    case(NOISE, f"{NOISE}\nnoise_dbm = 0", "receiver", "both noise_w and noise_dbm", "exactly one"),
    case(GAIN, "", "receiver", "neither reference_gain_db nor frequency_hz", "exactly one"),
    case(GAIN, f"{GAIN}\nfrequency_hz = 1e9", "receiver", "both reference_gain_db and frequency_hz"),
    # the receiver
    case(GAIN, "reference_gain_db = 1e3", "receiver.reference_gain_db", "a gain in dB from -300 to 300"),
    case(GAIN, "frequency_hz = 2.4", "receiver.frequency_hz", "got 2.4", "2.4 GHz is written 2.4e9"),
    # the airspace
    case(ALTITUDE, "altitude_m = [30.0, 8.0]", "airspace.altitude_m", "reversed", "try [8.0, 30.0]"),
    case(ALTITUDE, "altitude_m = [8, 9, 10]", "airspace.altitude_m", "a list of 3 values", INTERVAL),
    case(ALTITUDE, "altitude_m = 8", "airspace.altitude_m", "got 8", INTERVAL, "equal ends fix the value"),
    case(ALTITUDE, "altitude_m = [8, nan]", "airspace.altitude_m[1]", "got NaN", "a length in m"),
    case(ALTITUDE, "altitude_m = [8, 2e7]", "airspace.altitude_m[1]", "got 20000000.0", "to 1e+07"),
    case(ALTITUDE, "", "airspace.altitude_m", "missing", "must be given", "in metres: [low, high]"),
    case(KEEP_OUT, "keep_out_m = 0", "airspace.keep_out_m", "got 0", "no limit at a ground point"),
    # positions
    case(POSITION, "position_m = [17.0, 15.0]", "jammers[0].position_m", "a list of 2 values", POINT),
    case(POSITION, 'position_m = "here"', "jammers[0].position_m", 'the text "here"', POINT),
    case(POSITION, 'position_m = [1, "2", 3]', "jammers[0].position_m[1]", 'the text "2"', "without quotes"),
    case(POSITION, "position_m = [4.5e8, 2, 3]", "jammers[0].position_m[0]", "1e+07", "local origin"),
    case(POSITION, "", "jammers[0].position_m", "missing", "must be given", "[east, north, up]"),
    # names
    case(NAME, "name = 7", "jammers[0].name", "got 7", "must be text in quotes"),
    case(NAME, 'name = ""', "jammers[0].name", "an empty text", "at least one visible character"),
    case(NAME, 'name = "M "', "jammers[0].name", 'the text "M "', "without blanks at its ends"),
    case(NAME, 'name = "M\\n2"', "jammers[0].name", 'the text "M\\n2"', "text on one line"),
    # unknown keys
    case(KEEP_OUT, "keepout = 1.5", "airspace.keepout", "unknown key", 'did you mean "keep_out_m"?'),
    case(ALTITUDE, "altitude = [8, 30]", "airspace.altitude", 'did you mean "altitude_m"?', "x_m, y_m"),
    case(POWER, "power = 3.0", "jammers[0].power", 'did you mean "power_w"?', "power_dbm"),
    case("[receiver]", "[reciever]", "reciever", "unknown key", 'did you mean "receiver"?'),
    case(POWER, f"{POWER}\nqqqq = 1", "jammers[0].qqqq", "unknown key; the keys here are name, position_m"),
    case(POWER, f'{POWER}\n"a.b" = 1', 'jammers[0]."a.b"', "unknown key"),
    # tables and lists
    case("[[jammers]]", "[jammers]", "jammers", "got a table", "must be a list", "[[jammers]]"),
    case("[airspace]", "[[airspace]]", "airspace", "a list of one value", "a table headed [airspace]"),
]
CROSS_CASES = [
    case(NAME, 'name = "S1"', "jammers[0].name", 'got "S1"', "the name of nodes[0] already", "once"),
    case('name = "S2"', 'name = "S1"', "nodes[1].name", 'got "S1"', "the name of nodes[0] already"),
    case(POSITION, "position_m = [0, 50, 0]", "jammers[0].position_m", "nodes[1] already"),
    case(POSITION, "position_m = [0, 50, 1e-9]", "jammers[0].position_m", "nodes[1]", "different places"),
    case("[0.0, 50.0, 0.0]", "[0, 0, 0]", "nodes[1].position_m", "the place of nodes[0] already"),
    case(KEEP_OUT, "keep_out_m = 100\nx_m = [0, 10]\ny_m = [0, 50]", "airspace", "no room"),
]
CASES = FIELD_CASES + CROSS_CASES


def faults_of(text: str) -> tuple[Fault, ...]:
    """Returns the faults with which the text of a scenario file is refused."""
    with pytest.raises(ScenarioError) as caught:
        scenario_from_text(text.encode(), "bad.toml")
    assert caught.value.source == "bad.toml"
    return caught.value.faults


def edited(*cases: Case) -> str:
    """Returns the good file with the edits made."""
    text = GOOD
    for one in cases:
        text = text.replace(one.old, one.new)
    return text


@pytest.mark.parametrize("one", CASES, ids=str)
def test_one_fault_is_one_message(one: Case) -> None:
    """Every fault is reported once, at its path, and says what was given and what is allowed."""
    (fault,) = faults_of(edited(one))
    assert fault.path == one.path
    for words in one.words:
        assert words in fault.message
    assert not LIBRARY_WORDS.search(fault.message)


HEAD = GOOD.split("[[nodes]]", maxsplit=1)[0]


@pytest.mark.parametrize(
    ("text", "path", "words"),
    [
        (HEAD, "nodes", "missing; it must be given: Tables headed [[nodes]]"),
        ("nodes = []\n" + HEAD, "nodes", "must be a list of at least one table"),
        ("nodes = 3\n" + HEAD, "nodes", "must be a list of at least one"),
        ("nodes = [1]\n" + HEAD, "nodes[0]", "must be a node"),
        ("receiver = 3\n" + GOOD.replace("[receiver]", "[airspace.x]"), "receiver", "headed [receiver]"),
        (GOOD.replace("[airspace]", "[airspce]"), "airspce", 'did you mean "airspace"?'),
    ],
)
def test_missing_parts(text: str, path: str, words: str) -> None:
    """A part that is missing, empty or of another kind is named, with what is expected in its place."""
    faults = {fault.path: fault.message for fault in faults_of(text)}
    assert words in faults[path]


def test_faults_come_in_the_order_of_the_file() -> None:
    """Faults of all kinds are listed from the top of the file to its end."""
    text = GOOD
    for old, new in [
        (ALTITUDE, "altitude_m = [30, 8]"),
        (GAIN, "gain_db = 0"),
        ("power_w = 1.0", "power_w = -1.0"),
        ('name = "S2"', 'name = "S1"'),
        (POSITION, "position_m = [0, 50, 0]"),
        (POWER, "power_dbm = nan"),
    ]:
        text = text.replace(old, new)
    assert [fault.path for fault in faults_of(text)] == [
        "airspace.altitude_m",
        "receiver.gain_db",
        "nodes[0].power_w",
        "nodes[1].name",
        "jammers[0].position_m",
        "jammers[0].power_dbm",
    ]


# One edit a line at most; these lines' faults do not bear on each other.
INDEPENDENT = {
    old: [one for one in FIELD_CASES if one.old == old and "\n" not in one.new]
    for old in (ALTITUDE, KEEP_OUT, NOISE, GAIN, POSITION, POWER, NAME)
}


@given(
    st.lists(st.sampled_from(list(INDEPENDENT)), unique=True, min_size=2).flatmap(
        lambda olds: st.tuples(*(st.sampled_from(INDEPENDENT[old]) for old in olds))
    )
)
def test_all_faults_at_once(several: tuple[Case, ...]) -> None:
    """However many lines are at fault, loading reports exactly the faults that each has alone."""
    faults = faults_of(edited(*several))
    assert sorted(fault.path for fault in faults) == sorted(one.path for one in several)


@given(
    st.sampled_from(CROSS_CASES),
    st.sampled_from([NOISE, GAIN]).flatmap(lambda o: st.sampled_from(INDEPENDENT[o])),
)
def test_broken_parts_hide_no_cross_fault(cross: Case, other: Case) -> None:
    """Names, places and room are judged even when another part of the file cannot be read."""
    text = edited(cross, other).replace("power_w = 2.0", "power_w = 'much'")
    faults = faults_of(text)
    assert {cross.path, other.path, "nodes[1].power_w"} == {fault.path for fault in faults}
