"""Mutations of certificates: the first of the ten thousand of each kind."""

import copy
import dataclasses

import pytest
from benchmarks.mutations.__main__ import main
from benchmarks.mutations.bases import KINDS, bases_of, optima_of
from benchmarks.mutations.changes import CLASSES, HELD, MORE
from benchmarks.mutations.run import FALSE, REFUSED, REJECTED, TRUE, Mutations

import nullpose.certificate

COUNT = len((*CLASSES, *MORE))  # one of each


@pytest.fixture(
    scope="module",
    params=[next(iter(KINDS)), *(pytest.param(kind, marks=pytest.mark.slow) for kind in list(KINDS)[1:])],
)
def mutations(request: pytest.FixtureRequest) -> Mutations:
    """Returns the mutations of a kind."""
    return Mutations(request.param, bases_of(request.param), optima_of(request.param))


@pytest.mark.parametrize("count", [COUNT, pytest.param(200, marks=pytest.mark.slow)])
def test_no_false_certificate_is_accepted(mutations: Mutations, count: int) -> None:
    """What the verifier accepts is true; all classes of changes occur, and every other outcome."""
    for base in mutations.bases:
        assert mutations.judged(base) == (TRUE, "")
    tally = mutations.tally(0, count)
    assert tally.falsehoods == []
    assert tally.counts.total() == count
    assert {outcome for _, outcome in tally.counts} == {REFUSED, REJECTED, TRUE}
    assert {change for change, _ in tally.counts} >= {*CLASSES, *MORE} - {
        "null_jammer", "airframe, claim redone", "no_fly, claim redone", "antenna, claim redone",
        "channel, claim redone", "band", "objective, claim redone",
        *(() if mutations.kind == "held poses" else HELD),
            "cell halved", "cell moved", *(["sides"] if count == COUNT else []),
    }  # fmt: skip


def test_a_number_gives_the_same_mutation(mutations: Mutations) -> None:
    """Every mutation is another certificate, made from its number alone."""
    for number in (0, 7, 33):
        change, data = mutations.mutation(number)
        assert (change, data) == mutations.mutation(number)
        assert data not in mutations.bases


def test_what_is_false_is_noticed(mutations: Mutations) -> None:
    """Bounds, values and poses that are wrong by little would be found out if they were accepted."""
    for base, optimum in zip(mutations.bases, mutations.optima, strict=True):
        low = copy.deepcopy(base)
        low["upper_bound"] = optimum["value"] * (1.0 - 1e-5)
        if low["upper_bound"] > low["value"]:
            assert "above the bound" in mutations.truth.falsehood(low)
        low["upper_bound"] = base["value"] * (1.0 - 1e-12)
        assert mutations.truth.falsehood(low) == "bound below the value"
        assert mutations.truth.falsehood(base | {"value": base["value"] * (1.0 - 1e-7)}) == "value"
        for changed, words in (
            ({"position_m": [*base["pose"]["position_m"][:2], 7.999]}, {"pose outside"}),
            ({"position_m": [16.9, 15.1, 8.0]}, {"value", "pose kept out", "axis"}),
            ({"roll_rad": 1.5}, {"value", "tilt", "axis"}),
        ):
            assert mutations.truth.falsehood(base | {"pose": base["pose"] | changed}) in words


def test_a_lenient_verifier_is_found_out(mutations: Mutations, monkeypatch: pytest.MonkeyPatch) -> None:
    """With a verifier that accepts whatever can be read, false certificates are counted as such."""

    def lenient(certificate: nullpose.certificate.Certificate) -> nullpose.certificate.Verdict:
        return dataclasses.replace(nullpose.certificate.verify(certificate), proved=True)

    monkeypatch.setattr("benchmarks.mutations.run.verify", lenient)
    tally = mutations.tally(0, COUNT)
    assert len(tally.falsehoods) > 4
    false = sum(count for (_, outcome), count in tally.counts.items() if outcome == FALSE)
    assert false == len(tally.falsehoods)


def test_the_command_prints_a_table(capsys: pytest.CaptureFixture[str]) -> None:
    """The counts of each kind add up; nothing false means success."""
    assert main(["--count", "4", "--kind", "margins", "--workers", "1", "--by-change"]) == 0
    printed = capsys.readouterr().out
    assert "| margins | 4 |" in printed
    assert "| all | 4 |" in printed
