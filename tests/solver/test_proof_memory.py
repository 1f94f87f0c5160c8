"""A proof goes on to its limit however many boxes it takes, in a bounded memory."""

from __future__ import annotations

from importlib import import_module

import numpy as np
import pytest

from nullpose import Scenario, UsageError, load, solve
from nullpose.certificate.certificate import DEEPEST
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.scenario import Airframe
from nullpose.solver.certificate_from_proof import certificate_of
from nullpose.solver.kernels.bounds import node
from nullpose.solver.kernels.bounds.branch import branch
from nullpose.solver.kernels.bounds.records import Goal
from nullpose.solver.kernels.bounds.root import fill_root
from nullpose.solver.multistart import multistart

PROOF = import_module("nullpose.solver.proof")


def whips(seed: int) -> Scenario:
    """Returns five whips and two jammers for a level vehicle."""
    rng = np.random.default_rng(seed)
    places = [[x, y, 0.0] for x, y in rng.uniform(0.0, 60.0, (7, 2)).tolist()]
    return Scenario.from_dict(
        {
            "airspace": {"altitude_m": [8.0, 30.0]},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "airframe": {"tilt_max_deg": 0.0},
            "nodes": [{"position_m": place, "power_w": 1.0, "antenna": "dipole"} for place in places[:5]],
            "jammers": [{"position_m": place, "power_w": 10.0, "antenna": "dipole"} for place in places[5:]],
        }
    )


def test_no_number_of_boxes_ends_a_proof() -> None:
    """A tree of more boxes than a certificate holds is worked off until a limit that was asked for."""
    scenario = Scenario.from_dict(
        {
            "airspace": {"altitude_m": [8.0, 30.0]},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "airframe": {"tilt_max_deg": 1.0, "mount_deg": 90.0},
            "nodes": [
                {"position_m": [29.646027519011042, 40.85000198956229, 4.384168792188026], "power_w": 0.68},
                {"position_m": [22.660002233949946, 32.54653735229097, 0.0], "power_w": 1.86},
            ],
            "jammers": [
                {"position_m": [9.97385251302588, 41.512084865195845, 3.087689601584442], "power_w": 406.0}
            ],
        }
    )
    result = solve(scenario, node_limit=1_200_000, time_limit_s=600.0)
    assert result.reason == "the node limit of 1200000"
    assert result.stats.boxes >= 1_200_000


def test_a_proof_in_little_memory_has_the_same_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where leaves do not fit into memory the proof is closed without them, and has no certificate."""
    scenario = whips(1)
    monkeypatch.setattr(PROOF, "_TRIES", ((0.0, 10),))
    kept = solve(scenario, gap=1e-3, threads=1)
    monkeypatch.setattr(PROOF, "_MOST_BYTES", 1e4)
    dropped = solve(scenario, gap=1e-3, threads=1)
    assert kept.status == dropped.status == "certified"
    assert dropped.objective.upper_bound == pytest.approx(kept.objective.upper_bound, rel=1e-9)
    assert (kept.rigour, dropped.rigour) == ("verifiable", "floating-point")
    assert dropped.stats.boxes > 0
    monkeypatch.setattr("nullpose.solver.certificate_from_proof.MOST_LEAVES", 1)
    with pytest.raises(UsageError, match="too many leaves"):
        certificate_of(dropped)


def test_boxes_still_to_do_end_a_proof_before_they_fill_the_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """With the bound that it has, and the reason."""
    monkeypatch.setattr("nullpose.solver.branch_and_bound._MOST_BYTES", 1e4)
    result = solve(whips(1), gap=1e-3)
    assert result.status == "gap-not-reached"
    assert result.objective.upper_bound >= result.objective.value
    assert "boxes may take" in result.reason


def test_cells_of_axes_are_no_finer_than_their_box_tells() -> None:
    """Halved for ever, they would leave the boxes behind them: a vehicle that tilts by 20 degrees."""
    scenario = load("examples/paper.toml", overrides=["jammers.M.power_w=1e4"])
    scenario = scenario.model_copy(update={"airframe": Airframe(tilt_max_deg=20.0, mount_deg=0.0)})
    family, band = build_family(scenario), AxisField.within(*scenario.axis_band)
    incumbent = multistart(family, band, seed=0)
    row, rows = np.zeros(node.COLUMNS), np.zeros((4096, node.COLUMNS))
    weights, level = incumbent.multipliers.copy(), np.exp(incumbent.log_value) * (1.0 + 1e-6)
    fill_root(family.ratios, family.domain, incumbent.log_value, 1e-6, np.inf, weights, incumbent.axis, row)
    rows[0] = row
    goal, at_once = Goal(np.exp(incumbent.log_value), row, 1e9), 3_000  # axes are split before positions
    problem = family.ratios, family.domain, band.arrays
    leaves, pose = np.zeros((4096, node.COLUMNS)), (np.zeros(3), np.zeros(3))
    _, top, *_ = branch(*problem, level, goal, rows, 1, leaves, 0, at_once, *pose)
    in_cells = rows[:top][rows[:top, node.FACE] >= 0.0]
    sides = in_cells[:, node.CELL + 1 : node.SIDE : 2] - in_cells[:, node.CELL : node.SIDE : 2]
    assert np.all(sides.max(axis=1) > 1e-9)
    assert top < 500


def test_leaves_too_thin_for_a_certificate_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """A proof whose boxes are thinner than a certificate can hold is one in floating point."""
    assert PROOF.MOST_HALVINGS == DEEPEST
    monkeypatch.setattr(PROOF, "_THINNEST", 0.1)
    result = solve(load("examples/paper.toml"), gap=1e-3, threads=1)
    assert (result.status, result.rigour) == ("certified", "floating-point")
    with pytest.raises(UsageError, match="halves boxes more than 50 times"):
        certificate_of(result)
