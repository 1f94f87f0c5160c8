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


def test_a_file_outside_the_folder_is_refused(tmp_path: Path) -> None:
    """The file of an antenna is inside the scenario's folder unless that is allowed."""
    (tmp_path / "below").mkdir()
    (tmp_path / "profile.csv").write_text("angle_deg,gain_dbi\n0,-9\n90,1\n180,-9\n")
    path = tmp_path / "below" / "scenario.toml"
    path.write_text(
        f'{Path("examples/paper.toml").read_text()}\n[antenna]\nkind = "profile"\nfile = "../profile.csv"\n'
    )
    with pytest.raises(ScenarioError, match=r"antenna\.file: .*outside the folder"):
        load(path)
    assert load(path, allow_outside=True).antenna_record.harmonics.is_axisymmetric


PAPERS_GAIN = "reference_gain_db = 0.0"


def cuts(across_db: float) -> str:
    """Return two cuts, of which the horizontal one changes by so many dB."""
    losses = [across_db * (1.0 - math.cos(math.radians(at))) / 2.0 for at in range(360)]
    across = "".join(f"{at} {loss:.3f}\n" for at, loss in enumerate(losses))
    down = "".join(
        f"{at} {loss + 9.0 * math.sin(math.radians(at)) ** 2:.3f}\n" for at, loss in enumerate(losses)
    )
    return f"FREQUENCY 2400\nGAIN 3 dBi\nHORIZONTAL 360\n{across}VERTICAL 360\n{down}"


def scenario_of_cuts(
    folder: Path, across_db: float, keys: str = "", gain: str = "3 dBi", receiver: str = PAPERS_GAIN,
    notes: list[str] | None = None,
) -> Scenario:  # fmt: skip
    """Return the paper's scene with an antenna of two cuts."""
    (folder / "cuts.msi").write_text(cuts(across_db).replace("GAIN 3 dBi", f"GAIN {gain}"))
    path = folder / "scenario.toml"
    text = Path("examples/paper.toml").read_text().replace(PAPERS_GAIN, receiver)
    path.write_text(f'{text}\n[antenna]\nkind = "pattern"\nfile = "cuts.msi"\n{keys}\n')
    return load(path, on_note=(notes if notes is not None else []).append)


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
    """An antenna that is nearly the same all round is solved as it is, is no estimate, and is told of."""
    notes: list[str] = []
    scenario = scenario_of_cuts(tmp_path, 1.4, notes=notes)
    assert scenario.antenna_record.harmonics.is_axisymmetric
    assert scenario.name == PAPER.name
    assert "cuts.msi: Its gain is read as dBi." in notes
    with pytest.raises(ScenarioError, match="two_cuts has no meaning: the file tells the whole pattern"):
        scenario_of_cuts(tmp_path, 1.4, 'two_cuts = "sum-of-losses"')


@pytest.mark.parametrize(
    ("receiver", "gain", "paths"),
    [
        ("frequency_hz = 2.3e9", "3 dBi", []),
        ("frequency_hz = 9e8", "3 dBi", ["antenna.frequency_hz"]),
        ("frequency_hz = 2.4e9", "-7 dBi", ["antenna.file"]),
        (PAPERS_GAIN, "3 dBi", []),
    ],
)
def test_a_pattern_of_another_carrier_or_below_its_feed_is_doubted(
    tmp_path: Path, receiver: str, gain: str, paths: list[str]
) -> None:
    """A file may be at another frequency, or relative to its peak."""
    scenario = scenario_of_cuts(tmp_path, 1.4, gain=gain, receiver=receiver)
    assert [doubt.path for doubt in doubts(scenario)] == paths


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
