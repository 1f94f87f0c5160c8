"""Which antenna the drone carries."""

import math
from pathlib import Path

import pytest

from nullpose import Scenario, ScenarioError
from nullpose.antenna import SHORT_DIPOLE
from nullpose.scenario import apply_overrides, doubts, load
from scenes import faults_of, require_fault

PAPER = load("examples/paper.toml")


def test_a_dipole_unless_another_is_stated() -> None:
    """With a perfect null, or one stated in dB below the broadside gain, which stays 1."""
    assert PAPER.antenna_record == apply_overrides(PAPER, ["antenna={}"]).antenna_record == SHORT_DIPOLE
    shallow = apply_overrides(PAPER, ["antenna.null_depth_db=30"]).antenna_record
    assert (SHORT_DIPOLE.leak, shallow.gain(1.0)) == (0.0, 1.0)
    assert shallow.gain(0.0) == pytest.approx(1e-3, rel=1e-15)


ROWS = [[1.0], [0.1, 0.2, 0.3]]
NAN = float("nan")


@pytest.mark.parametrize(
    ("antenna", "place", "words"),
    [
        ({"kind": "pattern"}, "antenna.file", "missing, but kind"),
        ({"kind": "profile", "file": "a.csv"}, "antenna.file", "only a scenario file on this machine"),
        ({"kind": "half-wave", "file": "a.csv"}, "antenna.file", "has no meaning with kind"),
        ({"kind": "pattern", "harmonics": ROWS, "null_depth_db": 20}, "antenna.null_depth_db", "no meaning"),
        ({"kind": "pattern", "harmonics": [[1.0], [1.0]]}, "antenna.harmonics[1]", "must be 3"),
        ({"kind": "pattern", "harmonics": [[NAN]]}, "antenna.harmonics[0][0]", "must be a coefficient"),
        ({"null_depth_db": -1}, "antenna.null_depth_db", "got -1"),
        ({"null_depth_db": NAN}, "antenna.null_depth_db", "got NaN"),
        ({"kind": "yagi"}, "antenna.kind", "yagi"),
        ({"depth_db": 30}, "antenna.depth_db", "unknown key"),
    ],
)
def test_faults(antenna: dict[str, object], place: str, words: str) -> None:
    """What a kind lacks, and what has no meaning with it, each at its place."""
    require_fault(lambda: Scenario.from_dict(PAPER.to_dict() | {"antenna": antenna}), place, words)


def test_dipoles_elsewhere_need_one_on_the_drone() -> None:
    """A power pattern tells no polarisation, so a whip is refused; arrays have perfect nulls only."""
    data = PAPER.to_dict() | {"antenna": {"kind": "pattern", "harmonics": ROWS}}
    data["nodes"][0]["antenna"] = "dipole"
    require_fault(lambda: Scenario.from_dict(data), "nodes[0].antenna", "whose polarisation is known")
    with pytest.raises(ScenarioError, match="short dipoles"):
        apply_overrides(load("examples/array.toml"), ["antenna.null_depth_db=30"])


def test_a_pattern_from_a_file_round_trips(tmp_path: Path) -> None:
    """A scenario that was read with its pattern's file is the same without the file."""
    scenario = load("examples/frame.toml")
    assert Scenario.from_dict(scenario.to_dict()) == scenario
    (tmp_path / "again.toml").write_text(scenario.to_toml())
    assert load(tmp_path / "again.toml").antenna_record == scenario.antenna_record


def test_a_file_outside_the_folder_is_refused(tmp_path: Path) -> None:
    """The file of a pattern is inside the scenario's folder unless that is allowed."""
    text = Path("examples/frame.toml").read_text()
    path = tmp_path / "scenario.toml"
    path.write_text(text.replace('"hexarotor', f'"{Path("examples").resolve()}/hexarotor'))
    with pytest.raises(ScenarioError, match=r"antenna\.file: .*outside the folder"):
        load(path)
    assert load(path, allow_outside=True).antenna_record.harmonics.degree > 4


def cuts(across_db: float) -> str:
    """Return two cuts, of which the horizontal one changes by so many dB."""
    losses = [across_db * (1.0 - math.cos(math.radians(at))) / 2.0 for at in range(360)]
    across = "".join(f"{at} {loss:.3f}\n" for at, loss in enumerate(losses))
    down = "".join(
        f"{at} {loss + 9.0 * math.sin(math.radians(at)) ** 2:.3f}\n" for at, loss in enumerate(losses)
    )
    return f"FREQUENCY 2400\nGAIN 3 dBi\nHORIZONTAL 360\n{across}VERTICAL 360\n{down}"


def scenario_of_cuts(folder: Path, across_db: float, keys: str = "") -> Scenario:
    """Return the paper's scene with an antenna of two cuts."""
    (folder / "cuts.msi").write_text(cuts(across_db))
    path = folder / "scenario.toml"
    text = Path("examples/paper.toml").read_text()
    path.write_text(f'{text}\n[antenna]\nkind = "pattern"\nfile = "cuts.msi"\n{keys}\n')
    return load(path)


def test_an_estimate_says_so_everywhere(tmp_path: Path) -> None:
    """Two cuts of a directional antenna are an estimate, only on request; name, label and copies say so."""
    with pytest.raises(ScenarioError, match=r'horizontal cut changes by 12.0 dB.*two_cuts = "sum-of-losses"'):
        scenario_of_cuts(tmp_path, 12.0)
    scenario = scenario_of_cuts(tmp_path, 12.0, 'two_cuts = "sum-of-losses"')
    said = f"{PAPER.name} (antenna: estimate from two cuts)"
    again = Scenario.from_dict(scenario.to_dict())
    assert scenario.name == again.name == apply_overrides(scenario, ["antenna.normalise=peak"]).name == said
    assert scenario.antenna_record.label == "pattern of cuts.msi at 2400 MHz (estimate from two cuts)"


def test_two_cuts_of_an_omni_are_a_profile(tmp_path: Path) -> None:
    """An antenna that is nearly the same all round is solved as it is, and is no estimate."""
    scenario = scenario_of_cuts(tmp_path, 1.4)
    assert scenario.antenna_record.harmonics.is_axisymmetric
    assert scenario.name == PAPER.name
    with pytest.raises(ScenarioError, match="two_cuts has no meaning: the file tells the whole pattern"):
        scenario_of_cuts(tmp_path, 1.4, 'two_cuts = "sum-of-losses"')


def test_how_a_file_is_read_is_told(tmp_path: Path) -> None:
    """The notes on a pattern are those of the scenario that names it."""
    scenario_of_cuts(tmp_path, 1.4)
    notes: list[str] = []
    load(tmp_path / "scenario.toml", on_note=notes.append)
    assert "cuts.msi: Its gain is read as dBi." in notes


@pytest.mark.parametrize(
    ("receiver", "gain", "paths"),
    [
        ("frequency_hz = 2.3e9", "3 dBi", []),
        ("frequency_hz = 9e8", "3 dBi", ["antenna.frequency_hz"]),
        ("frequency_hz = 2.4e9", "-7 dBi", ["antenna.file"]),
        ("reference_gain_db = 0.0", "3 dBi", []),
    ],
)
def test_a_pattern_of_another_carrier_or_below_its_feed_is_doubted(
    tmp_path: Path, receiver: str, gain: str, paths: list[str]
) -> None:
    """A file may be at another frequency, or relative to its peak."""
    scenario_of_cuts(tmp_path, 1.4)
    for name, old, new in (
        ("cuts.msi", "GAIN 3 dBi", f"GAIN {gain}"),
        ("scenario.toml", "reference_gain_db = 0.0", receiver),
    ):
        text = (tmp_path / name).read_text()
        assert old in text
        (tmp_path / name).write_text(text.replace(old, new))
    assert [doubt.path for doubt in doubts(load(tmp_path / "scenario.toml"))] == paths


def test_a_gain_that_a_file_has_is_not_counted_twice() -> None:
    """Beside gains in dBi another gain is refused; beside a pattern with a largest gain of 1 it is not."""
    profile = {"kind": "profile", "harmonics": ROWS}
    scene = PAPER.to_dict()
    assert list(faults_of(scene | {"antenna": profile | {"gain_dbi": 2.0}})) == ["antenna.gain_dbi"]
    for fine in (profile | {"gain_dbi": 0.0}, profile | {"gain_dbi": 2.0, "normalise": "peak"}):
        assert faults_of(scene | {"antenna": fine}) == {}
    half_wave = apply_overrides(PAPER, ["antenna.kind=half-wave", "antenna.gain_dbi=2.15"])
    assert half_wave.reference_gain == pytest.approx(10.0**0.215, rel=1e-15)
    assert Scenario.from_dict(half_wave.to_dict()) == half_wave
