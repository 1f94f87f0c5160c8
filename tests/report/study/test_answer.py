"""The first paragraph is written from the data, for any spec, and says what is not there."""

import re
from collections.abc import Callable
from typing import Any

import pytest

from nullpose.report.study.answer import (
    answer_of,
    certainty_of,
    null_words,
    outage_words,
    unfinished_note,
)
from nullpose.report.study.markdown import gain_tables
from nullpose.report.study.summary import Summary

Summed = Callable[..., Summary]
Ladder = Callable[..., Any]
MINUS = "\N{MINUS SIGN}"
RATIOS = {"jammers.M.power_w": [0.2, 200.0]}
FREE, LEVEL = "an omnidirectional vehicle", "a level vehicle with a vertical dipole"
TILT = "a 10 degree tilt with a horizontal dipole"


def _gains(answer: str, phrase: str) -> list[str]:
    """Return the gains that an answer tells of a case: in the median and in the worst tenth."""
    told = re.split(r";|\. [A-Z]", answer.split(f"{phrase} gains ")[1])[0]
    return re.findall(rf"({MINUS}?[\d.]+) dB in the (?:median|worst tenth)", told)


def _differences(answer: str, phrase: str) -> list[str]:
    """Return how much less than the omnidirectional vehicle a case gains in the median and worst tenth."""
    told = re.split(r";|\. [A-Z]", answer.split(f"{phrase} gains ")[1])[0]
    return re.findall(r"([\d.]+ dB (?:less|more))", told)


def test_the_question(summed: Summed, ladder: Ladder) -> None:
    """What all of tilt gains in the median and in the worst tenth, and the smallest tilt with most of it."""
    cells = ladder(40, 1.9, 2.0, points=2)
    for scene in range(40):
        cells[scene][0] = [0.0, 0.5, 1.0]
    answer = answer_of(summed(cells, sweep=RATIOS))
    assert answer.startswith(
        f"Over 40 scenes at P_M/P = 100 {LEVEL} reaches a smallest SINR of {MINUS}21.00 dB"
    )
    assert f"Against it, on the same scenes, {FREE} gains" in answer
    assert (_gains(answer, FREE), _gains(answer, TILT)) == (["2.00", "2.00"], ["1.90", "1.90"])
    assert "(95 % confidence: 2.00 to 2.00)" in answer
    assert (_differences(answer, FREE), _differences(answer, TILT)) == ([], ["0.10 dB less"] * 2)
    assert f"{TILT} is the smallest tilt within 0.5 dB of the omnidirectional vehicle" in answer
    assert answer.endswith(f"For {FREE} the two gains are 1.00 and 1.00 dB at P_M/P = 0.1.")


def test_too_little(summed: Summed, ladder: Ladder) -> None:
    """No tilt of the study reaches most of the gain."""
    answer = answer_of(summed(ladder(40, 1.0, 2.0)))
    assert _differences(answer, TILT) == ["1.00 dB less", "1.00 dB less"]
    assert "Of these cases no other tilt is within 0.5 dB of the omnidirectional vehicle" in answer


@pytest.mark.parametrize(("case", "phrase"), [(1, TILT), (2, FREE)])
def test_a_loss_in_the_worst_tenth(summed: Summed, ladder: Ladder, case: int, phrase: str) -> None:
    """More in the median and less in the worst tenth, each with its own sign."""
    cells = ladder(40, 1.0, 2.0)
    for scene in range(30, 40):
        cells[scene][0][case] -= 9.0
    assert _gains(answer_of(summed(cells)), phrase) == [f"{case:.2f}", f"{MINUS}{9 - case:.2f}"]


def test_nothing_gained(summed: Summed, ladder: Ladder) -> None:
    """Where tilt gains nothing, the level vehicle is the smallest tilt that has it all."""
    answer = answer_of(summed(ladder(40, 0.0, 0.0)))
    assert _gains(answer, FREE) == ["0.00", "0.00"]
    assert f"{LEVEL} is the smallest tilt within 0.5 dB" in answer


@pytest.mark.parametrize("whole_db", [0.05, 0.0, -0.05])
def test_a_loss_over_a_gain_of_almost_nothing(summed: Summed, ladder: Ladder, whole_db: float) -> None:
    """A vehicle that loses .7 dB where all of tilt gains .05 dB is not told as -1400 per cent of that."""
    summary = summed(ladder(40, -0.7, whole_db))
    answer = answer_of(summary)
    assert _differences(answer, TILT) == [f"{0.7 + whole_db:.2f} dB less"] * 2
    assert "%" not in answer.replace("95 % confidence", "")
    headings = [heading for heading in gain_tables(summary) if "omnidirectional" in heading]
    assert headings == ["Difference from the omnidirectional vehicle's median gain, dB"]


def test_one_scene(summed: Summed, ladder: Ladder) -> None:
    """That it is only one, and no interval of it."""
    summary = summed(ladder(1, 1.0, 2.0))
    answer = answer_of(summary)
    assert answer.startswith(f"Over 1 scene {LEVEL}")
    assert (_gains(answer, FREE), _differences(answer, TILT)) == (["2.00", "2.00"], ["1.00 dB less"] * 2)
    assert "confidence" not in answer
    assert "With 1 scene the worst tenth is 1 scene, so its statistics are rough." in certainty_of(summary)


def test_one_case(summed: Summed, ladder: Ladder) -> None:
    """What it reaches, as there is nothing to set it against."""
    answer = answer_of(summed(ladder(10), cases=[{"name": "only"}]))
    assert answer == (
        f"Over 10 scenes {FREE} reaches a smallest SINR of {MINUS}6.00 dB in the median and "
        f"{MINUS}10.00 dB in the worst tenth."
    )


def test_other_cases_than_vehicles(summed: Summed, ladder: Ladder) -> None:
    """Without a level vehicle the first case is measured against, and that there is none is said."""
    cases = [{"name": "flat", "airframe": "tilt-30"}, {"name": "tilt-10", "airframe": "tilt-10"}]
    answer = answer_of(summed(ladder(10, -2.0), cases=cases))
    assert answer.startswith("Over 10 scenes a 30 degree tilt with a horizontal dipole reaches")
    assert _gains(answer, TILT) == [f"{MINUS}2.00", f"{MINUS}2.00"]
    assert re.search("There is no level vehicle.* and no omnidirectional vehicle in this study", answer)


def test_only_failures(summed: Summed) -> None:
    """Then there is nothing to compare."""
    summary = summed([[["no room"] * 3]] * 2)
    assert answer_of(summary).startswith("Every row of this study failed")
    assert certainty_of(summary).startswith("Of 6 rows: 6 failed.")


def test_a_case_that_always_fails(summed: Summed) -> None:
    """A case without values is not said to win or lose."""
    answer = answer_of(summed([[[0.0, 1.0, "no room"]]] * 3))
    assert FREE not in answer
    assert _gains(answer, TILT) == ["1.00", "1.00"]


def test_robust_cases_answer_for_themselves(summed: Summed) -> None:
    """What is guaranteed is told apart from what is reached if all is as stated."""
    cases = [
        {"name": name, "airframe": vehicle, **robust}
        for robust in ({}, {"robust": True})
        for name, vehicle in (
            (f"level{len(robust)}", "level-vertical"),
            (f"free{len(robust)}", "omnidirectional"),
        )
    ]
    answer = answer_of(summed([[[0.0, 3.0, -4.0, 1.0]]] * 40, cases=cases))
    assert f"{LEVEL} reaches a smallest SINR of 0.00 dB" in answer
    assert f"{LEVEL} in its robust pose guarantees a smallest SINR of {MINUS}4.00 dB" in answer
    assert _gains(answer, FREE) == ["3.00", "3.00"]
    assert _gains(answer, f"{FREE} in its robust pose") == ["5.00", "5.00"]


def test_not_finished(summed: Summed, ladder: Ladder) -> None:
    """How far it is stands first, in the note and in the sentence."""
    summary = summed(ladder(40, 1.0, 2.0), scenes=200)
    assert unfinished_note(summary).startswith("This study is not finished: 40 of 200 scenes (20 %) are done")
    assert answer_of(summary).startswith("Over 40 scenes done so far, of 200,")


def test_not_begun(summed: Summed) -> None:
    """No scene is done: nothing to say."""
    summary = summed([], scenes=200)
    assert answer_of(summary) == "No scene is solved yet."
    assert (outage_words(summary), certainty_of(summary)) == ("", "")


def test_outage(summed: Summed, ladder: Ladder) -> None:
    """How often each case misses the requirement; no word of it without one."""
    summary = summed(ladder(10, 1.0, 2.0), requirement=-4.5)
    told = outage_words(summary)
    assert told.startswith("A smallest SINR of -4.5 dB is missed in")
    for share, phrase in (("60.0", LEVEL), ("50.0", TILT), ("40.0", FREE)):
        assert f"{share} % of scenes by {phrase}" in told


def test_what_is_not_certified_is_counted(summed: Summed) -> None:
    """How many rows are how far proved, and what the others count as."""
    cells = [[[(0.0, "gap-not-reached"), (1.0, "best-found"), 2.0]], [["no room", 1.0, 2.0]]]
    told = certainty_of(summed(cells))
    assert told.startswith("Of 6 rows: 3 certified, 1 gap not reached, 1 best found and 1 failed.")
    assert "a lower bound of the optimum" in told


def test_rates_are_no_decibels(summed: Summed) -> None:
    """A study of secrecy speaks of rates in bits/s/Hz."""
    scene = {
        "objective": "secrecy-rate",
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "transmitter": {"power_w": 1.0},
        "nodes": [{"position_m": [0.0, 0.0, 0.0], "noise_w": 1e-3}],
        "eavesdroppers": [{"position_m": [20.0, 0.0, 0.0], "noise_w": 1e-3}],
    }
    summary = summed([[[0.0, 0.0, 3.0103]]] * 40, scene=scene, nodes=None, jammers=None)
    assert f"{FREE} gains 1 bits/s/Hz in the median (95 % confidence: 1 to 1)" in answer_of(summary)
    assert "dB" not in answer_of(summary)


def test_poses_on_a_null_are_counted(summed: Summed, ladder: Ladder) -> None:
    """They are those whose gain towards a jammer is that within a degree of a dipole's axis, 3.05e-4."""
    summary = summed(ladder(8, 1.0, 2.0))
    words = null_words(summary)
    assert words.startswith("The pose stands on a null towards a jammer")
    assert words.count("50.0 % of scenes by ") == 3
    assert list(summary.frame["null_share"]) == [0.5] * 3


def test_without_jammers_no_null_is_told(summed: Summed) -> None:
    """Rows without a pose have no gain either."""
    failed = summed([[["no room"] * 3]], requirement=0.0)
    assert (null_words(failed), outage_words(failed)) == ("", "")
