"""Scenarios written and read back."""

import json
import pickle
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, strategies as st

from nullpose.scenario import Scenario, load

EXAMPLES = Path(__file__).parents[2] / "examples"
SCENARIOS = sorted(path for path in EXAMPLES.glob("*.toml") if path.name != "study.toml")  # which is a spec

watts = st.floats(1e-30, 1e30)
dbm = st.floats(-270.0, 330.0)
metres = st.floats(-1e7, 1e7)
titles = st.text(st.characters(exclude_categories=["C", "Z"]), max_size=12)
labels = titles.filter(bool)


def either(one: tuple[str, st.SearchStrategy[float]], other: tuple[str, st.SearchStrategy[float]]) -> Any:
    """Returns a strategy for a table with one of two keys."""
    return st.one_of(*(values.map(lambda value, key=key: {key: value}) for key, values in (one, other)))


ranges = st.lists(metres, min_size=2, max_size=2).map(sorted)
airspaces = st.fixed_dictionaries(
    {"altitude_m": ranges}, optional={"x_m": ranges, "keep_out_m": st.floats(0.001, 1e3)}
)
receivers = st.builds(
    dict.__or__,
    either(("noise_w", watts), ("noise_dbm", dbm)),
    either(("reference_gain_db", st.floats(-300.0, 300.0)), ("frequency_hz", st.floats(1e3, 1e13))),
)
powers = either(("power_w", watts), ("power_dbm", dbm))


@st.composite
def scenarios(draw: st.DrawFn) -> Scenario:
    """Returns scenarios of up to five ground points, with y unbounded so that there is always room."""
    places = draw(
        st.lists(
            st.lists(st.integers(-(10**7), 10**7).map(float), min_size=3, max_size=3).map(tuple),
            unique=True,
            min_size=1,
            max_size=5,
        )
    )
    names = draw(st.lists(labels, unique=True, min_size=len(places), max_size=len(places)))
    points = [
        {"name": name, "position_m": place} | draw(powers) for name, place in zip(names, places, strict=True)
    ]
    nodes = draw(st.integers(1, len(points)))
    return Scenario.from_dict(
        {
            "name": draw(titles),
            "airspace": draw(airspaces),
            "receiver": draw(receivers),
            "nodes": points[:nodes],
            "jammers": points[nodes:],
        }
    )


@given(scenarios())
def test_toml_round_trip(scenario: Scenario) -> None:
    """A scenario written as TOML loads back equal, to the last bit."""
    assert Scenario.from_dict(tomllib.loads(scenario.to_toml())) == scenario


@given(scenarios())
def test_json_round_trip(scenario: Scenario) -> None:
    """A scenario's dictionary goes through JSON and back to an equal scenario, with no null in it."""
    text = json.dumps(scenario.to_dict(), allow_nan=False)
    assert "null" not in json.dumps([list(part) for part in (scenario.to_dict()["receiver"],)])
    assert Scenario.from_dict(json.loads(text)) == scenario


@given(scenarios())
def test_pickle_round_trip(scenario: Scenario) -> None:
    """A scenario survives pickling, with and without its arrays having been asked for."""
    fresh = pickle.dumps(scenario)
    assert scenario.node_powers_w.size == len(scenario.nodes)
    assert pickle.loads(fresh) == scenario
    assert pickle.dumps(scenario) == fresh
    assert hash(pickle.loads(fresh)) == hash(scenario)


@pytest.mark.parametrize("example", SCENARIOS, ids=lambda path: path.name)
def test_examples_round_trip(example: Path, tmp_path: Path) -> None:
    """Every example loads, and loads equal from what it is written back as."""
    scenario = load(example)
    (tmp_path / "copy.toml").write_text(scenario.to_toml(), encoding="utf-8")
    assert load(tmp_path / "copy.toml") == scenario


def test_only_what_was_stated_is_written() -> None:
    """Keys left out stay out of the dictionary; defaults that matter are stated."""
    data = load(EXAMPLES / "paper.toml").to_dict()
    assert data["airspace"] == {"altitude_m": [8.0, 30.0], "keep_out_m": 1.0}
    assert data["receiver"] == {"noise_w": 1e-3, "reference_gain_db": 0.0}
    assert data["jammers"] == [{"name": "M", "position_m": [17.0, 15.0, 4.0], "power_w": 1.0}]
