"""The page on channels: its sentences are what its tables hold, its example prints what it says."""

import contextlib
import csv
import io
import re
from pathlib import Path

import numpy as np
import pytest

import nullpose

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "channels.md").read_text(encoding="utf-8")
WORDS = " ".join(PAGE.split())

with (ROOT / "docs" / "figures" / "channels.csv").open(encoding="utf-8", newline="") as file:
    ROWS = list(csv.DictReader(file))


def _column(key: str, pattern: str, scene: str = "") -> np.ndarray:
    """Return a number of the channels whose name matches, in one scene or in both."""
    chosen = (row for row in ROWS if re.search(pattern, row["channel"]) and scene in row["scene"])
    return np.array([float(row[key]) for row in chosen])


def test_the_loss_of_the_free_space_pose() -> None:
    """The ranges at the top are those of the table."""
    assert f"at most {_column('regret_db', 'law').max():.2f} dB" in WORDS
    city = _column("regret_db", "^(urban|dense|high).*(power|db)$")
    suburbs = _column("regret_db", "^suburban, (power|db)$", "500 m")
    assert f"loses {city.min():.1f} to {city.max():.1f} dB" in WORDS
    assert f"{suburbs.min():.1f} to {suburbs.max():.1f} dB at 5" in WORDS
    assert _column("regret_db", "^suburban", "paper").max() < 0.35
    assert _column("regret_db", "guaranteed").max() < 0.02
    lower_db = 10.0 * np.log10(_column("value", "power$") / _column("value", "guaranteed"))
    assert f"{np.floor(lower_db.min()):.0f} to {np.ceil(lower_db.max()):.0f} dB below those of" in WORDS
    assert f"{_column('regret_db', 'block').item():.2f} dB" in WORDS


def test_the_claims() -> None:
    """What a vertical dipole and zero interference lose."""
    vertical = _column("vertical_loss_db_100", "")
    assert f"by {vertical.min():.1f} to {vertical.max():.1f} dB at $P_M / P = 100$" in WORDS
    assert f"up to {_column('vertical_loss_db_100', 'law').max():.1f} dB with a power law" in WORDS
    assert f"leaves {_column('vertical_loss_db_1', 'block').item():.1f} dB" in WORDS
    assert _column("null_loss_db_10000", "").max() < 0.011
    assert _column("null_loss_db_100", "^(?!a block|high-rise, db)").max() < 0.02
    assert _column("null_loss_db_100", "block").item() == pytest.approx(0.12, abs=5e-3)
    assert np.all(_column("saturation_db", "") <= _column("null_loss_db_100", ""))


def test_the_examples(monkeypatch: pytest.MonkeyPatch) -> None:
    """The examples, one after the other, print the texts below them."""
    examples = re.findall(r"```python\n(.*?)```\n+```text\n(.*?)```", PAGE, flags=re.DOTALL)
    assert len(examples) == 3
    monkeypatch.chdir(ROOT)
    names = {"__name__": "__main__"}
    for code, text in examples:
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(code, "channels.md", "exec"), names)
        assert printed.getvalue() == text


def test_an_exponent_beside_sight_by_elevation() -> None:
    """What the poses for either alone lose with both."""
    urban = nullpose.load(ROOT / "examples" / "urban.toml")
    both = nullpose.apply_overrides(urban, ["channel.exponent=2.3"])
    law = nullpose.apply_overrides(urban, ['channel={model="power-law", exponent=2.3}'])
    best, *others = (nullpose.solve(scene, gap=1e-4).pose for scene in (both, urban, law))
    lost = [10.0 * np.log10(nullpose.min_sinr(both, best) / nullpose.min_sinr(both, pose)) for pose in others]
    assert f"with 2 loses {lost[0]:.1f} dB" in WORDS
    assert f"power law alone {lost[1]:.1f} dB" in WORDS


def test_the_scenario_with_buildings(tmp_path: Path) -> None:
    """The scenario loads with what OpenStreetMap states: heights as text, levels, or nothing."""
    (tmp_path / "town.geojson").write_text(TOWN, encoding="utf-8")
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE, flags=re.DOTALL)
    (tmp_path / "town.toml").write_text(text, encoding="utf-8")
    scenario = nullpose.load(tmp_path / "town.toml")
    assert [building.height_m for building in scenario.buildings] == [22.0, 12.0, (4.0, 12.0)]


def _feature(properties: str, west_deg: float) -> str:
    corners = [[west_deg, 50.0001], [west_deg + 4e-4, 50.0001], [west_deg, 50.0003], [west_deg, 50.0001]]
    geometry = f'{{"type": "Polygon", "coordinates": [{corners}]}}'
    return f'{{"type": "Feature", "properties": {{{properties}}}, "geometry": {geometry}}}'


TOWN = f"""{{"type": "FeatureCollection", "features": [
  {_feature('"building": "yes", "height": "22 m", "building:levels": null', 14.5011)},
  {_feature('"building": "yes", "height": null, "building:levels": "4"', 14.5021)},
  {_feature('"building": "yes", "height": null, "building:levels": null', 14.5031)}
]}}"""
