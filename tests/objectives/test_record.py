"""Every objective's record: its ratios are what the physics evaluates."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.channel.elevation import AVERAGES, elevation_excess
from nullpose.channel.model import BY_DISTANCE, BY_ELEVATION, CONSTANT
from nullpose.channel.power_law import distance_excess
from nullpose.objectives import RECORDS, USUAL, Quantity
from nullpose.physics import Pose, evaluate, objective_of_links, objective_value
from nullpose.scenario import Scenario

EXCESS = {CONSTANT: lambda *_: 1.0, BY_DISTANCE: distance_excess, BY_ELEVATION: elevation_excess}


def _scenario(name: str, rng: np.random.Generator) -> Scenario:
    def spot() -> list[float]:
        return [*map(float, rng.uniform(-80.0, 80.0, 2)), 0.0]

    record = RECORDS[name]
    data = {
        "objective": name,
        "airspace": {"altitude_m": [10.0, 60.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": float(rng.uniform(-3.0, 3.0))},
        "nodes": [{"position_m": spot(), "power_w": float(rng.uniform(0.5, 2.0))} for _ in range(3)],
        "jammers": [{"position_m": spot(), "power_w": float(rng.uniform(0.1, 9.0))} for _ in range(2)],
    }
    if "nodes.weight" not in record.unused:
        data["nodes"][0]["weight"] = 2.5
    if not {"nodes.weight", "nodes.min_sinr_db"} & set(record.unused):
        data["nodes"][1]["min_sinr_db"] = -4.0
    if "nodes.noise" not in record.unused:
        data["nodes"][0]["noise_dbm"], data["nodes"][1]["jamming_dbm"] = -5.0, -3.0
    more = {
        "transmitter": {"power_w": 1.0},
        "eavesdroppers": [{"position_m": spot()} for _ in range(2)],
        "destination": {"position_m": spot(), "noise_dbm": -2.0, "weight": 1.5},
    }
    if "sources" in record.needs:
        more["sources"] = [{"position_m": spot(), "power_w": float(rng.uniform(0.5, 2.0))} for _ in range(3)]
        for node in data["nodes"]:
            node["from"] = f"A{rng.integers(1, 4)}"
        data["airspace"] |= {"x_m": [-99.0, 99.0], "y_m": [-99.0, 99.0]}
    data |= {key: more[key] for key in record.needs if key in more}
    channels = [{"model": "power-law", "exponent": float(rng.uniform(1.6, 4.0))}]
    channels += [{"model": "elevation", "environment": "urban", "average": each} for each in AVERAGES]
    channels += [channels[1] | channels[0] | {"model": "elevation"}]
    data["channel"] = channels[rng.integers(len(channels))]
    data["nodes"][2]["channel"] = "free-space"
    if record.interferers in data:
        data[record.interferers][1]["channel"] = "free-space"
    return Scenario.from_dict(data)


@pytest.mark.parametrize("name", RECORDS)
@given(seed=st.integers(0, 2**32 - 1))
def test_smallest_or_mean_ratio_is_the_value_of_the_physics(name: str, seed: int) -> None:
    """Numerators over denominators, summed from the arrays, give the number that the physics evaluates."""
    rng = np.random.default_rng(seed)
    scenario = _scenario(name, rng)
    ratios = RECORDS[name].ratios(scenario)
    pose = Pose(rng.uniform([-90.0, -90.0, 20.0], [90.0, 90.0, 50.0]), *rng.uniform(-1.0, 1.0, 3))
    away = ratios.points_m - pose.position_m
    squared = np.sum(away**2, axis=1)
    link = 1.0 / squared - (away @ pose.antenna_axis) ** 2 / squared**2
    for j, row in enumerate(ratios.channels):
        seen_rad = np.arcsin(-away[j, 2] / np.sqrt(squared[j]))
        link[j] *= EXCESS[int(row[0])](row, np.sqrt(squared[j]), seen_rad, 0.0)
    leaks = ratios.denominator_weight * link[ratios.denominator_point]
    sums = np.append(0.0, np.cumsum(leaks))[ratios.denominator_start]
    below = ratios.denominator_isotropic + np.diff(sums)
    above = ratios.numerator_isotropic + ratios.numerator_weight * link[ratios.numerator_point]
    each = above / below[ratios.denominator_of]
    each = each[ratios.pairs[:, 0]] / each[ratios.pairs[:, 1]] if len(ratios.pairs) else each
    offset = RECORDS[name].mean_offset
    assert offset in (None, 0.0, 1.0), "the kernels know no other"
    ratio = float(np.min(each) if offset is None else np.prod((offset + each) ** scenario.node_shares))
    quantity = Quantity.of(scenario)
    value = float(objective_value(scenario, pose.position_m, pose.antenna_axis))
    assert quantity.of_ratio(ratio) == pytest.approx(value, rel=1e-9, abs=1e-12)
    assert objective_of_links(scenario, evaluate(scenario, pose)) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("name", RECORDS)
def test_a_proof_knows_all_points_and_a_mean_one_denominator(name: str) -> None:
    """The drone keeps clear of every point, of those in no ratio, too; no mean is proved with more."""
    scenario = _scenario(name, np.random.default_rng(7))
    ratios = RECORDS[name].ratios(scenario)
    assert {*map(tuple, ratios.points_m)} == {point.position_m for point in scenario.points}
    if RECORDS[name].mean_offset is not None:
        assert len(ratios.denominator_isotropic) == 1


def test_names_are_told_apart() -> None:
    """No two quantities share a name."""
    quantities = {one for record in RECORDS.values() for one in record.quantities}
    assert len({one.name for one in quantities}) == len(quantities)
    assert USUAL in RECORDS


@pytest.mark.parametrize("quantity", [one for record in RECORDS.values() for one in record.quantities])
@given(value=st.floats(1e-6, 1e6), more=st.floats(0.0, 10.0))
def test_gap_is_relative(quantity: Quantity, value: float, more: float) -> None:
    """The gap of a bound is its distance from the value over the value."""
    least = max(value, 1e-3)
    assert quantity.gap(least, least * (1.0 + more)) == pytest.approx(more, abs=1e-9)
