"""An antenna of one's own: a file and a line in the registry."""

from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from nullpose import Scenario, ScenarioError, load, min_sinr, solve
from nullpose.antenna import ANTENNAS, AntennaKind, QuadraticAntenna
from nullpose.certificate import verify
from nullpose.cli.app import app
from nullpose.physics import objective_value
from nullpose.solver.certificate_from_proof import certificate_of


def mast_whip() -> QuadraticAntenna:
    """Make a whip whose null a mast fills to a fifth of the broadside gain."""
    return QuadraticAntenna(name="mast-whip", label="whip beside a mast", leak=0.2)


MAST_WHIP = AntennaKind("a whip beside a mast", mast_whip)


def paper(**antenna: object) -> Scenario:
    """Read the paper's scene with strong jamming and an antenna."""
    data = load("examples/paper.toml").to_dict() | {"antenna": antenna}
    return Scenario.from_dict(data | {"jammers": [data["jammers"][0] | {"power_w": 10.0}]})


def test_a_new_antenna_is_a_file_and_a_line(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """It is read, solved, proved, evaluated and printed, and no pose tried is better."""
    monkeypatch.setitem(ANTENNAS, "mast-whip", MAST_WHIP)
    scenario = paper(kind="mast-whip")
    assert Scenario.from_dict(scenario.to_dict()) == scenario
    result = solve(scenario, gap=1e-6)
    value = result.objective.value
    assert value == min_sinr(scenario, result.pose)
    assert verify(certificate_of(result)).proved
    (file := tmp_path / "whip.toml").write_text(scenario.to_toml())
    assert "whip beside a mast" in CliRunner().invoke(app, ["check", str(file)]).stdout
    rng = np.random.default_rng(0)
    positions_m = result.pose.position_m + rng.normal(size=(20_000, 3)) * 5.0
    positions_m = positions_m[scenario.airspace.allows(positions_m)]
    axes = result.pose.antenna_axis + 0.3 * rng.normal(size=positions_m.shape)
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    assert 0.9 * value < np.max(objective_value(scenario, positions_m, axes)) <= value * (1.0 + 1e-6)
    as_deep = solve(paper(null_depth_db=-10.0 * np.log10(0.2)), gap=1e-6)
    assert value == pytest.approx(as_deep.objective.value, rel=1e-6)


def test_keys_of_other_kinds_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """A key that the kind does not take has no meaning for it."""
    monkeypatch.setitem(ANTENNAS, "mast-whip", MAST_WHIP)
    with pytest.raises(ScenarioError, match="no meaning with kind"):
        paper(kind="mast-whip", null_depth_db=20.0)
