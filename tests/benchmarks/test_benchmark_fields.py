"""The workload "fields": scenes that can be had again; hits, times and rivals counted as they should be."""

from collections.abc import Iterator

import numpy as np
import pytest
from benchmarks.peers import Answer, Budget, FivePose
from benchmarks.workloads.fields.fields import Fields
from benchmarks.workloads.fields.record import Record
from benchmarks.workloads.fields.running import (
    NULLPOSE,
    PROVED,
    REFERENCE,
    UNBOXED,
    run_nullpose,
    run_peer,
    run_proved,
)
from benchmarks.workloads.fields.scenes import Scene, scenes
from benchmarks.workloads.fields.standing import (
    best_values,
    first_hit_s,
    nearest_rival,
    rivals_within,
    standings,
)

from nullpose.solver import Status, solve

A = Scene(nodes=2, jammers=1, jamming_ratio=1.0, seed=0)
B = Scene(nodes=3, jammers=1, jamming_ratio=1.0, seed=0)


def record(scene: Scene, method: str, value: float, seconds: float, stage: str = "end") -> Record:
    """Return an answer."""
    return Record(scene=scene, method=method, stage=stage, value=value, seconds=seconds)


RECORDS = [
    record(A, NULLPOSE, 1.0, 0.01),
    record(B, NULLPOSE, 2.0, 0.03),
    record(A, REFERENCE, 1.0, 9.0),
    record(B, UNBOXED, 7.0, 0.01),
    record(A, "fast", 1.0, 0.05),
    record(B, "fast", 1.9, 0.05),
    record(A, "good", 0.5, 0.1, "early"),
    record(B, "good", 2.0, 0.1, "early"),
    record(A, "good", 1.0 - 0.9e-6, 0.5, "late"),
    record(B, "good", 2.0, 0.7, "late"),
    record(A, "weak", 1.0, 0.2),
    Record(scene=B, method="weak", stage="failed", status="ValueError: no"),
]


def test_there_are_200_different_scenes() -> None:
    """The full workload has the 200 scenes that were asked for, no two alike."""
    assert len({scene.scenario().node_positions_m.tobytes() for scene in scenes(quick=False)}) == 200


def test_a_scene_is_made_from_its_parameters_alone() -> None:
    """A scene comes out the same each time, its jammers share the stated power, its box is optional."""
    scene = Scene(nodes=3, jammers=3, jamming_ratio=10.0, seed=4)
    scenario = scene.scenario()
    assert scenario == scene.scenario()
    assert np.sum(scenario.jammer_powers_w) == pytest.approx(10.0)
    assert np.all(scenario.node_positions_m[:, 2] == 0.0)
    assert scene.scenario(boxed=False).airspace.x_m is None
    assert np.array_equal(scene.scenario(boxed=False).node_positions_m, scenario.node_positions_m)


def test_records_come_back_from_rows() -> None:
    """A record turned into a row and back is the same record."""
    whole = Record(scene=A, method="m", stage="s", value=1.5, seconds=0.1, evaluations=7, pose=(1.0, 2.0))
    assert Record.from_row(whole.to_row()) == whole


def test_best_value_is_over_every_method_in_the_box() -> None:
    """The best value known counts the reference search, and leaves out what was found without the box."""
    assert best_values(RECORDS) == {A: 1.0, B: 2.0}


def test_standings_count_hits_and_failures() -> None:
    """Each stage has its own hits, a failure counts as a miss, and what is not ranked is left out."""
    found = {(s.method, s.stage): s for s in standings(RECORDS)}
    assert set(found) == {
        (NULLPOSE, "end"),
        ("fast", "end"),
        ("good", "early"),
        ("good", "late"),
        ("weak", "end"),
    }
    assert found[NULLPOSE, "end"].hits == 2
    assert found["fast", "end"].hits == 1
    assert found["fast", "end"].worst_shortfall == pytest.approx(0.05)
    assert found["good", "early"].hits == 1
    assert found["good", "late"].hits == 2
    assert (found["weak", "end"].hits, found["weak", "end"].failures, found["weak", "end"].scenes) == (
        1,
        1,
        2,
    )
    assert found["weak", "end"].worst_shortfall == 1.0


def test_method_that_never_answers_is_a_row() -> None:
    """A method that failed in every scene stands in the table with no hits."""
    found = standings([RECORDS[0], Record(scene=A, method="broken", stage="failed", status="OSError: no")])
    assert (found[1].method, found[1].hits, found[1].failures) == ("broken", 0, 1)


def test_nearest_rival_hits_as_often() -> None:
    """The rival is the fastest stage that hits as often as nullpose, not the fastest of all."""
    found = standings(RECORDS)
    rival = nearest_rival(found, {"fast", "good", "weak"})
    assert (rival.method, rival.stage, rival.median_s) == ("good", "late", 0.6)


def test_without_an_equal_the_rival_is_the_best_of_the_others() -> None:
    """If no peer hits as often, the rival is the fastest of those that hit most often."""
    assert nearest_rival(standings(RECORDS), {"fast", "weak"}).method == "fast"


def test_only_equals_count_against_the_lead() -> None:
    """A peer counts within so many times nullpose's time only if it hits as often."""
    found = standings(RECORDS)
    everyone = {"fast", "good", "weak"}
    assert rivals_within(found, 10.0, everyone) == []
    assert [(s.method, s.stage) for s in rivals_within(found, 31.0, everyone)] == [("good", "late")]


def test_first_hit_is_at_the_first_stage_that_hits() -> None:
    """The time to the answer is that of the first stage with a hit, and there is none without one."""
    first = first_hit_s(RECORDS, best_values(RECORDS))
    assert first["good", B] == 0.1
    assert first["good", A] == 0.5
    assert ("fast", B) not in first


def test_proof_has_a_row_of_its_own() -> None:
    """The search alone proves nothing, `solve` as it comes does; the two do not compete as peers."""
    alone, proved = (*run_nullpose(A), *run_proved(A))
    assert (alone.method, alone.certified) == (NULLPOSE, False)
    assert (proved.method, proved.certified) == (PROVED, True)
    assert proved.value == pytest.approx(alone.value, rel=1e-6)
    rows = [found.to_row() for found in (alone, proved, record(A, "direct", 0.1, 9.0))]
    rows.append(record(A, "multistart-slsqp", 0.1, 9.0).to_row())
    keys = {metric.key for metric in Fields().metrics(rows)}
    assert "fields.nullpose-certified.median_ms" in keys
    assert "fields.nullpose-certified.hit_rate" not in keys


class _Stub:
    name = "stub"
    label = "stub"
    general_purpose = True
    settings = ""

    def answers(self, problem: FivePose, budget: Budget, seed: int) -> Iterator[Answer]:
        yield Answer(stage="search", x=np.array([0.5, 0.5, 0.0, 0.5, 0.5]))
        raise ArithmeticError("out of luck")


def test_failing_peer_leaves_a_row() -> None:
    """A peer's answers are kept, and what stopped it becomes a row with its reason."""
    rows = list(run_peer(_Stub(), A, Budget(evaluations=1, starts=1, samples=1)))
    assert [(row.stage, row.status) for row in rows] == [
        ("search", "ok"),
        ("failed", "ArithmeticError: out of luck"),
    ]
    assert rows[0].pose[:3] == (50.0, 50.0, 8.0)


def test_metrics_carry_the_promises() -> None:
    """The hit rate and the lead over general solvers are promised, and judged from the rows alone."""
    rows = [
        record(scene, method, 1.0, 1.0 + 20.0 * (method != NULLPOSE)).to_row()
        for scene in (A, B)
        for method in (NULLPOSE, "direct", "multistart-slsqp")
    ]
    promised = {m.key: m for m in Fields().metrics(rows) if m.limit is not None}
    assert set(promised) == {"fields.nullpose.hit_rate", "fields.rivals_within_ten_times"}
    assert all(m.meets_limit for m in promised.values())


def test_a_pose_that_the_search_missed_is_found_in_the_proof() -> None:
    """A proof that does not end looks for a better pose where it stopped, and then ends soon."""
    scenario = Scene(nodes=10, jammers=3, jamming_ratio=0.1, seed=57).scenario(boxed=False)
    searched, proved = solve(scenario, certify=False), solve(scenario)
    assert proved.objective.value >= searched.objective.value * (1.0 - 1e-9)
    assert proved.status is Status.CERTIFIED
    assert proved.stats.boxes < 50_000
