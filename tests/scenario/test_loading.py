"""Files that cannot be read, and those that can."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from nullpose.errors import Fault, ScenarioError
from nullpose.scenario import Receiver, Scenario, load
from nullpose.scenario.loading import scenario_from_text
from scenes import EXAMPLES, load_faults


def fault_of(path: str | os.PathLike[str]) -> Fault:
    """Return the one fault for which a file cannot be read."""
    (fault,) = load_faults(path)
    return fault


def test_paper_example_is_the_papers_scenario() -> None:
    """The paper's file holds the numbers of its section 4."""
    scenario = load(EXAMPLES / "paper.toml")
    assert scenario.name == "Bonilla Licea et al., ICASSP 2024, section 4"
    assert scenario.node_positions_m.tolist() == [[0.0, 0.0, 0.0], [0.0, 50.0, 0.0]]
    assert scenario.jammer_positions_m.tolist() == [[17.0, 15.0, 4.0]]
    assert [*scenario.node_powers_w, *scenario.jammer_powers_w] == [1.0, 1.0, 1.0]
    assert scenario.airspace.altitude_m == (8.0, 30.0)
    assert (scenario.airspace.x_m, scenario.airspace.y_m, scenario.airspace.keep_out_m) == (None, None, 1.0)
    assert (scenario.receiver.noise_power_w, scenario.receiver.reference_gain) == (1e-3, 1.0)


def test_byte_order_mark_is_accepted(tmp_path: Path) -> None:
    """A file that an editor saved as UTF-8 with a mark loads like any other."""
    path = tmp_path / "mark.toml"
    path.write_bytes(b"\xef\xbb\xbf" + (EXAMPLES / "paper.toml").read_bytes())
    assert load(path) == load(EXAMPLES / "paper.toml")


def test_files_that_cannot_be_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The reason is told, and a file of a like name beside it or in the folder is suggested."""
    assert fault_of(tmp_path / "paper.toml").message == "there is no such file; check the path"
    assert fault_of(tmp_path).message == "this is a folder, must be a scenario file; check the path"
    (tmp_path / "papers.toml").touch()
    for path in (tmp_path / "paper.toml", tmp_path):
        assert f"did you mean {tmp_path / 'papers.toml'}?" in fault_of(path).message
    assert fault_of("pa\0per.toml").message == "this cannot be the name of a file"
    (tmp_path / "latin.toml").write_bytes(b'name = "a"\n# \xe9tude\n')
    told = str(fault_of(tmp_path / "latin.toml"))
    assert told == "line 2: byte 0xe9 is not UTF-8 text; save the file as UTF-8"

    def refuse(self: Path, mode: str) -> object:
        raise PermissionError(13, "Permission denied", str(self))

    monkeypatch.setattr(Path, "open", refuse)
    message = fault_of(tmp_path / "papers.toml").message
    assert message == "the file cannot be read (permission denied); check its name and permissions"


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ("x = 1\n[airspace]\naltitude_m [8, 30]\n", "line 3, column 12", "written as in power_w = 1.0"),
        ("[airspace\n", "line 1, column 10", "this is not TOML: "),
        ('name = "a', "line 1, column 10", "this is not TOML: "),
        ("[airspace]\naltitude_m = [8, 30", "line 2, column 20", "this is not TOML: "),
        ("x = 8 m\n", "line 1, column 7", "on a line of its own"),
        ("x = abc\n", "line 1, column 5", "texts stand in quotes"),
        ("x = 1\nx = 2\n", "line 2, column 6", "a key is given twice; keep one"),
        ("[nodes]\nx = 1\n[nodes]\n", "line 3, column 7", "lists of tables, such as [[nodes]], take double"),
        ("x = .5\n", "line 1, column 5", "numbers are written as in 8.0"),
    ],
)
def test_broken_toml(text: str, place: str, words: str, tmp_path: Path) -> None:
    """Broken TOML is reported by line and column, with what may help."""
    path = tmp_path / "broken.toml"
    path.write_text(text, encoding="utf-8")
    fault = fault_of(path)
    assert fault.path == place
    assert fault.message.startswith("this is not TOML: ")
    assert words in fault.message
    assert "at line" not in fault.message
    assert "('" not in fault.message


@pytest.mark.parametrize(
    "text",
    [
        "x = 1\n" + "a." * 50_000 + "a = 1\n",
        "[" + "a . " * 50_000 + "a]\n",
        ".".join(['"="'] * 50_000) + " = 1\n",
        'x = { y = """\n"x"""", ' + '"=".' * 50_000 + '"=" = 1 }\n',
        "x = " + "9" * 1_000_000 + "\n",
        "k" * 1_000_000 + " = 1\n",
    ],
    ids=["dotted", "header", "quoted", "behind text", "number", "key"],
)
def test_monstrous_words_of_an_upload_are_refused_at_once(text: str) -> None:
    """Keys of very many parts, which would take gigabytes to read, and very long words are not read."""
    with pytest.raises(ScenarioError, match="a key has more than 64 parts, or a word more than 10000"):
        scenario_from_text(text.encode(), "long.toml")


def test_long_texts_comments_and_lists_are_no_keys() -> None:
    """Dots in texts, comments and numbers are no parts of keys."""
    dots = "." * 20_000
    numbers = "1.5, " * 9000
    text = f'"..." = "{dots}"\na = """\n{dots}"""\nb = \'{dots}\' # {dots}\nc = [{numbers}]\n'
    with pytest.raises(ScenarioError) as caught:
        scenario_from_text(text.encode(), "dots.toml")
    assert {'"..."', "a", "b", "c"} & {fault.path for fault in caught.value.faults}


def test_a_file_without_end(tmp_path: Path) -> None:
    """More than 10 MB, a pipe, brackets by the thousand and a number of thousands of digits are not read."""
    with (tmp_path / "large.toml").open("wb") as file:
        file.truncate(10_000_001)
    assert "it is larger than 10 MB" in fault_of(tmp_path / "large.toml").message
    os.mkfifo(tmp_path / "pipe")
    assert "it is a device or a pipe" in fault_of(tmp_path / "pipe").message
    for text, words in (("[" * 100_000, "nested too deeply"), ("9" * 5000, "too many digits")):
        (tmp_path / "deep.toml").write_text(f"x = {text}", encoding="utf-8")
        assert words in fault_of(tmp_path / "deep.toml").message


def test_import_is_lean() -> None:
    """Scenarios bring in no solver, no plots and no command line; places on the Earth alone their library."""
    code = (
        "import sys; from nullpose.scenario import Scenario\n"
        "heavy = {'scipy', 'numba', 'matplotlib', 'typer', 'rich', 'pymap3d'}\n"
        "data = {'airspace': {'altitude_m': [8, 30]}, 'receiver': {'noise_w': 1.0, 'frequency_hz': 1e9},\n"
        "        'origin': {'lat_deg': 1, 'lon_deg': 2, 'alt_m': 3}}\n"
        "for place in ({'position_m': [0, 0, 0]}, {'lat_deg': 1, 'lon_deg': 2, 'alt_m': 3}):\n"
        "    Scenario.from_dict(data | {'nodes': [{'power_w': 1.0} | place]})\n"
        "    print(sorted(heavy & sys.modules.keys()))\n"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ran.stdout.splitlines() == ["[]", "['pymap3d']"]


def test_very_many_unknown_keys_are_told_in_few_words() -> None:
    """The first twenty are named and the others counted; a list that is far too long is one fault."""
    with pytest.raises(ScenarioError) as caught:
        Receiver.from_dict(
            {f"k{number}": 1 for number in range(100_000)} | {"noise_w": 1.0, "frequency_hz": 1e9}
        )
    assert [fault.path for fault in caught.value.faults if fault.path] == [
        f"k{number}" for number in range(20)
    ]
    assert [fault.message for fault in caught.value.faults if not fault.path] == [
        "99980 more keys are unknown; remove them too"
    ]
    assert str(caught.value).endswith("... and 1 more")
    with pytest.raises(ScenarioError) as caught:
        Scenario.from_dict({"nodes": [1] * 10_001})
    (fault,) = caught.value.faults
    assert str(fault) == "nodes: there are more than 10000 members, the most that are allowed"
