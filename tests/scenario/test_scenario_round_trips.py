"""Scenarios of all kinds written and read back."""

import json
import pickle
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, strategies as st

from nullpose.scenario import Scenario, apply_overrides, load

EXAMPLES = Path(__file__).parents[2] / "examples"
SCENARIOS = sorted(path for path in EXAMPLES.glob("*.toml") if not path.stem.startswith("study"))  # a spec

watts = st.floats(1e-30, 1e30)
titles = st.text(st.characters(exclude_categories=["C", "Z"]), max_size=12)

lengths = st.floats(0.01, 3.0)
places = st.lists(st.tuples(*[st.integers(-500, 500).map(float)] * 3), unique=True, min_size=4, max_size=4)
optional_label = st.none() | st.text(
    st.characters(exclude_categories=["C", "Z"]), min_size=1, max_size=4
).filter(lambda name: name not in ("S1", "S2", "M1"))
extents = st.none() | lengths

airframes = st.one_of(
    st.none(),
    st.fixed_dictionaries(
        {"tilt_max_deg": st.floats(0.0, 180.0)}, optional={"mount_deg": st.floats(0.0, 90.0)}
    ),
    st.fixed_dictionaries({"preset": st.sampled_from(["omnidirectional", "level", "hexarotor-tilted-30"])}),
)
zones = st.one_of(
    st.fixed_dictionaries({"x_m": st.just([0.0, 5.0]), "y_m": st.just([-5.0, 5.0])}),
    st.fixed_dictionaries({"centre_m": st.just([3.0, 4.0]), "radius_m": lengths}),
    st.fixed_dictionaries({"polygon_m": st.just([[0.0, 0.0], [4.0, 1.0], [2.0, 7.0]])}),
)


def stated(**values: Any) -> dict[str, Any]:
    """Returns the values that are not None."""
    return {key: value for key, value in values.items() if value is not None}


@st.composite
def scenarios(draw: st.DrawFn) -> Scenario:
    """Returns scenarios of either objective in which anything may be stated."""
    at = draw(places)
    secret = draw(st.booleans())
    kinds = draw(st.lists(zones, max_size=3))
    no_fly = [zone | stated(altitude_m=draw(st.none() | st.just([0.0, 9.0]))) for zone in kinds]
    fence = [[-600.0, -600.0], [600.0, -600.0], [600.0, 600.0], [0.0, 100.0], [-600.0, 600.0]]
    margin = draw(st.sampled_from([{}, {"weight": 2.5}, {"min_sinr_db": -3.0}]))
    noise = draw(st.sampled_from([{}, {"noise_w": 2e-3, "jamming_dbm": 3.0}, {"noise_dbm": 1.0}]))
    uncertain = stated(uncertainty_m=draw(extents))
    errors = {"attitude_error_deg": draw(st.sampled_from([0.0, 2.0])), "position_error_m": draw(lengths)}
    data = stated(
        name=draw(titles),
        airspace=stated(
            altitude_m=[600.0, 700.0],
            keep_out_m=10.0,
            geofence_m=draw(st.sampled_from([None, fence])),
            no_fly=no_fly or None,
        ),
        receiver={"noise_w": draw(watts), "reference_gain_db": 0.0} | errors,
        airframe=draw(airframes),
        nodes=[
            {"position_m": at[0]} | (noise if secret else margin | {"power_w": 1.0}),
            {"position_m": at[1], "power_dbm": draw(st.floats(-270.0, 330.0))},
        ],
        jammers=[{"position_m": at[2], "power_w": 1.0} | uncertain],
    )
    if secret:
        data |= {
            "objective": "secrecy-rate",
            "transmitter": {"power_w": 1.0},
            "eavesdroppers": [{"position_m": at[3]} | uncertain | stated(name=draw(optional_label))],
        }
    return Scenario.from_dict(data)


@given(scenarios())
def test_round_trips(scenario: Scenario) -> None:
    """By TOML, JSON, pickle and copy a scenario is equal to the last bit; no default is written."""
    data = scenario.to_dict()
    copies = [
        Scenario.from_dict(tomllib.loads(scenario.to_toml())),
        Scenario.from_dict(json.loads(json.dumps(data, allow_nan=False))),
        pickle.loads(pickle.dumps(scenario)),
        scenario.model_copy(),
        apply_overrides(scenario, []),
    ]
    assert all(copy == scenario and hash(copy) == hash(scenario) for copy in copies)
    assert ("objective" in data) is (scenario.objective == "secrecy-rate")
    assert ("eavesdroppers" in data) is bool(scenario.eavesdroppers)
    assert ("attitude_error_deg" in data["receiver"]) is (scenario.receiver.attitude_error_deg > 0.0)
    assert ("no_fly" in data["airspace"]) is bool(scenario.airspace.no_fly)
    assert "mount_deg" not in data.get("airframe", {}) or scenario.airframe.mount_deg > 0.0
    assert all(None not in table.values() for table in data.values() if isinstance(table, dict))


@pytest.mark.parametrize("example", SCENARIOS, ids=lambda path: path.name)
def test_examples_round_trip(example: Path, tmp_path: Path) -> None:
    """Every example loads, and loads equal from what it is written back as."""
    scenario = load(example)
    (tmp_path / "copy.toml").write_text(scenario.to_toml(), encoding="utf-8")
    assert load(tmp_path / "copy.toml") == scenario == Scenario.from_dict(scenario.to_dict())
