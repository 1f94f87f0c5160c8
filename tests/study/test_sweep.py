"""Sweeps: the same answers as single solves, and every value checked before the first solve."""

import dataclasses
import itertools
import sys

import pytest

from nullpose import Scenario, ScenarioError, UsageError, load, solve
from nullpose.scenario import apply_overrides
from nullpose.solver.branch_and_bound import INTERRUPT
from nullpose.study import least_tilt, sweep
from scenes import EXAMPLES

POWER = "jammers.M.power_w"


def test_a_sweep_is_so_many_solves(paper: Scenario) -> None:
    """Each row is what a solve at that value gives."""
    ticks: list[tuple[int, int]] = []
    table = sweep(
        paper,
        POWER,
        [0.1, 10.0],
        schemes=["optimum", "vertical"],
        on_progress=lambda *tick: ticks.append(tick),
    )
    assert [(row.value, row.scheme) for row in table.rows] == [
        (0.1, "optimum"),
        (0.1, "vertical"),
        (10.0, "optimum"),
        (10.0, "vertical"),
    ]
    alone = solve(apply_overrides(paper, [f"{POWER}=10"]))
    assert table.of("optimum")[1].pose == alone.pose
    assert table.of("optimum")[1].min_sinr == alone.objective.value
    assert ticks == [(1, 4), (2, 4), (3, 4), (4, 4)]


def test_all_four_cases_unless_told_otherwise(paper: Scenario) -> None:
    """The default is the paper's four cases."""
    table = sweep(paper, POWER, [1.0])
    assert table.names == ("optimum", "zero-interference", "maximum-gain", "vertical")


def test_more_jamming_never_helps(paper: Scenario) -> None:
    """No scheme's value grows with the jammer's power."""
    table = sweep(paper, POWER, [1e-3, 1e-1, 1.0, 1e2, 1e5])
    for scheme in table.names:
        values = [row.min_sinr for row in table.of(scheme)]
        assert all(later <= earlier * (1.0 + 1e-9) for earlier, later in itertools.pairwise(values))


def test_schemes_that_do_not_apply_are_left_out_with_the_reason(paper: Scenario) -> None:
    """Without a jammer zero interference is missing from the rows; named, it is an error."""
    calm = Scenario.from_dict({**paper.to_dict(), "jammers": []})
    table = sweep(calm, "receiver.noise_w", [1e-3])
    assert "zero-interference" not in table.names
    assert "jammer" in table.left_out["zero-interference"]
    with pytest.raises(UsageError, match="jammer"):
        sweep(calm, "receiver.noise_w", [1e-3], schemes=["zero-interference"])


def test_faults_come_before_the_first_solve(paper: Scenario) -> None:
    """A bad value at the end stops the sweep before it starts, with one message for all such values."""
    ticks: list[int] = []
    with pytest.raises(ScenarioError) as caught:
        sweep(paper, POWER, [1.0, -1.0, -2.0], on_progress=lambda done, _: ticks.append(done))
    assert len(caught.value.faults) == 1
    assert "at -1 and 1 other value)" in str(caught.value)
    assert ticks == []


@pytest.mark.parametrize(
    ("path", "options", "error", "words"),
    [
        ("jammers.M.powr_w", {}, ScenarioError, r"jammers\.M\.power_w"),
        (POWER, {"gap": 0.0}, UsageError, "gap"),
        (POWER, {"time_limit_s": -1.0}, UsageError, "time"),
        (POWER, {"node_limit": 0}, UsageError, "node"),
    ],
)
def test_a_faulty_sweep_is_refused(
    paper: Scenario, path: str, options: dict[str, object], error: type[Exception], words: str
) -> None:
    """An unknown path, told with the nearest one, and limits that are none."""
    with pytest.raises(error, match=words):
        sweep(paper, path, [1.0], **options)


def test_equal_seeds_give_equal_tables() -> None:
    """To the last digit, whatever was solved before."""
    field = load(EXAMPLES / "field.toml")
    tables = [sweep(field, "jammers.van.power_w", [1.0], certify=False, seed=3) for _ in range(2)]
    assert [row.pose for row in tables[0].rows] == [row.pose for row in tables[1].rows]


def test_every_row_is_certified_unless_told_otherwise(paper: Scenario) -> None:
    """Each case has a bound within the gap; a wider gap may be asked for, and no proof at all."""
    for row in sweep(paper, POWER, [1e-2, 1.0, 1e3]).rows:
        assert (row.status, row.reason) == ("certified", "")
        assert row.min_sinr <= row.objective.upper_bound <= row.min_sinr * (1.0 + 1e-6)
        assert row.objective.relative_gap == pytest.approx(
            row.objective.upper_bound / row.min_sinr - 1.0, abs=1e-15
        )
        assert row.upper_bound_db > row.min_sinr_db
    (wide,) = sweep(paper, POWER, [1.0], schemes=["optimum"], gap=0.1).rows
    assert 1e-6 < wide.objective.relative_gap <= 0.1
    (fast,) = sweep(paper, POWER, [1.0], schemes=["optimum"], certify=False).rows
    assert (fast.status, fast.objective.upper_bound, fast.upper_bound_db) == ("best-found", None, None)


def test_a_limit_is_told_in_its_row(paper: Scenario) -> None:
    """A proof stopped by a limit leaves a row with a valid bound and the reason."""
    (best,) = sweep(paper, POWER, [1.0], schemes=["optimum"]).rows
    (row,) = sweep(paper, POWER, [1.0], schemes=["optimum"], node_limit=5).rows
    assert (row.status, row.reason) == ("gap-not-reached", "the node limit of 5")
    assert row.objective.upper_bound >= best.min_sinr
    field = load(EXAMPLES / "field.toml")
    best, row = (
        sweep(field, "jammers.van.power_w", [1.0], schemes=["optimum"], **limits).rows[0]
        for limits in ({"certify": False}, {"time_limit_s": 1e-9})
    )
    assert (row.status, row.reason) == ("gap-not-reached", "the time limit of 1e-09 s")
    assert row.objective.upper_bound >= best.min_sinr


def test_an_interrupted_proof_ends_the_sweep(paper: Scenario, monkeypatch: pytest.MonkeyPatch) -> None:
    """A solve that comes back interrupted is not taken for a row."""
    stopped = dataclasses.replace(solve(paper), reason=INTERRUPT)
    monkeypatch.setattr(sys.modules["nullpose.study.sweep"], "solve", lambda *_, **__: stopped)
    with pytest.raises(KeyboardInterrupt):
        sweep(paper, POWER, [1.0, 2.0], schemes=["optimum"])


def test_a_sweep_of_least_tilts_is_so_many_least_tilts(paper: Scenario) -> None:
    """Both sides of each mount at each value, in every form of the table."""
    ticks: list[tuple[int, int]] = []
    values, mounts_deg = [0.01, 1.0], [0.0, 90.0]
    table = sweep(
        paper,
        POWER,
        values,
        mounts_deg=mounts_deg,
        share=0.95,
        on_progress=lambda *tick: ticks.append(tick),
    )
    alone = [
        mount
        for value in values
        for mount in least_tilt(
            apply_overrides(paper, [f"{POWER}={value}"]), share=0.95, mounts_deg=mounts_deg
        ).mounts
    ]
    sides = [(mount.mount_deg, 0.95, mount.suffices_deg, mount.fails_deg) for mount in alone]
    assert [tuple(row.tilts.values()) for row in table.rows] == sides
    assert [row.objective.value for row in table.rows] == [mount.value for mount in alone]
    assert [row.status for row in table.rows] == ["certified"] * 4
    assert any(mount.fails_deg is None for mount in alone)
    keys = ["mount_deg", "share", "least_tilt_deg", "too_little_deg"]
    assert [tuple(row[key] for key in keys) for row in table.to_dict()["rows"]] == sides
    assert list(table.frame()[keys[2]]) == [mount.suffices_deg for mount in alone]
    assert table.to_xarray()[keys[2]].shape == (2, 2)
    assert ticks == [(1, 4), (2, 4), (3, 4), (4, 4)]


def test_where_no_tilt_is_proved_to_be_enough_there_is_none(paper: Scenario) -> None:
    """A proof that is cut short leaves no side, and the row says so."""
    (row,) = sweep(paper, POWER, [1.0], mounts_deg=[0.0], node_limit=1).rows
    assert (row.tilts["least_tilt_deg"], row.status) == (None, "gap-not-reached")
    assert "not known" in row.reason


@pytest.mark.parametrize(
    ("path", "options"),
    [
        (POWER, {"mounts_deg": []}),
        (POWER, {"mounts_deg": [0.0], "schemes": ["optimum"]}),
        ("airframe.tilt_max_deg", {"mounts_deg": [0.0]}),
    ],
)
def test_least_tilts_have_mounts_and_neither_schemes_nor_airframes(
    paper: Scenario, path: str, options: dict[str, object]
) -> None:
    """What has no meaning beside mounts is refused."""
    with pytest.raises(UsageError, match="mounts: given"):
        sweep(paper, path, [1.0], **options)
