"""Which antenna the drone carries."""

import pytest

from nullpose import ScenarioError
from nullpose.antenna import SHORT_DIPOLE
from nullpose.scenario import apply_overrides, load

PAPER = load("examples/paper.toml")


def test_the_papers_dipole_unless_another_is_stated() -> None:
    """No table, or an empty one, is a short dipole with a perfect null."""
    assert PAPER.antenna_record == SHORT_DIPOLE
    assert apply_overrides(PAPER, ["antenna={}"]).antenna_record == SHORT_DIPOLE
    assert SHORT_DIPOLE.leak == 0.0


def test_the_depth_of_a_null() -> None:
    """It is stated in dB below the broadside gain, which stays 1."""
    antenna = apply_overrides(PAPER, ["antenna.null_depth_db=30"]).antenna_record
    assert antenna.gain(0.0) == pytest.approx(1e-3, rel=1e-15)
    assert antenna.gain(1.0) == 1.0


@pytest.mark.parametrize(
    ("override", "path"),
    [
        ("antenna.null_depth_db=-1", "antenna.null_depth_db"),
        ("antenna.null_depth_db=nan", "antenna.null_depth_db"),
        ("antenna.kind=yagi", "antenna.kind"),
        ("antenna.depth_db=30", "antenna.depth_db"),
    ],
)
def test_antennas_that_are_none(override: str, path: str) -> None:
    """Each fault is told by its path."""
    with pytest.raises(ScenarioError) as caught:
        apply_overrides(PAPER, [override])
    assert [fault.path for fault in caught.value.faults] == [path]


def test_elements_of_an_array_are_short_dipoles() -> None:
    """An array of dipoles with shallow nulls is refused."""
    with pytest.raises(ScenarioError, match="short dipoles"):
        apply_overrides(load("examples/array.toml"), ["antenna.null_depth_db=30"])
