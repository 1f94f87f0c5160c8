"""The first paragraph is written from the data, for any spec, and says what is not there."""

from collections.abc import Callable
from typing import Any

from nullpose.report.study.answer import answer_of
from nullpose.report.study.notes import certainty_of, outage_words, unfinished_note
from nullpose.report.study.summary import Summary

Summed = Callable[..., Summary]
Ladder = Callable[..., Any]
MINUS = "\N{MINUS SIGN}"
RATIOS = {"jammers.M.power_w": [0.2, 200.0]}


def test_the_question(summed: Summed, ladder: Ladder) -> None:
    """What all of tilt gains in the median and in the worst tenth, and which tilt buys most."""
    cells = ladder(40, 1.9, 2.0, points=2)
    for scene in range(40):
        cells[scene][0] = [0.0, 0.5, 1.0]
    assert answer_of(summed(cells, sweep=RATIOS)) == (
        "Over 40 scenes at P_M/P = 100 an omnidirectional vehicle beats a level vehicle with a vertical "
        "dipole "
        "by 2.00 dB in the median (95 % confidence: 2.00 to 2.00) and 2.00 dB in the worst tenth (95 % "
        "confidence: 2.00 to 2.00). A 10 degree tilt with a horizontal dipole buys 95 % of the median gain "
        "and "
        "95 % of that in the worst tenth. The least of these that buys most of it (90 % or more of both) "
        "is a "
        "10 degree tilt with a horizontal dipole. For an omnidirectional vehicle the two gains are 1.00 and "
        "1.00 dB at P_M/P = 0.1."
    )


def test_all_or_too_little(summed: Summed, ladder: Ladder) -> None:
    """A tilt that buys all says so, and so does a study in which none buys most."""
    assert "tilt with a horizontal dipole buys all of it." in answer_of(summed(ladder(40, 2.0, 2.0)))


def test_too_little(summed: Summed, ladder: Ladder) -> None:
    """No tilt of the study buys most of the gain."""
    answer = answer_of(summed(ladder(40, 1.0, 2.0)))
    assert "buys 50 % of the median gain" in answer
    assert answer.endswith("None of these buys most of it (90 % or more of both).")


def test_a_loss_in_the_worst_tenth(summed: Summed, ladder: Ladder) -> None:
    """It is a loss in words, not a negative share."""
    cells = ladder(40, 1.0, 2.0)
    for scene in range(30, 40):
        cells[scene][0][1] -= 9.0
    answer = answer_of(summed(cells))
    assert "buys 50 % of the median gain, but loses 8.00 dB in the worst tenth" in answer


def test_a_gain_that_turns(summed: Summed, ladder: Ladder) -> None:
    """More in the median and less in the worst tenth, each with its own sign."""
    cells = ladder(40, 1.0, 2.0)
    for scene in range(30, 40):
        cells[scene][0][2] -= 9.0
    answer = answer_of(summed(cells))
    assert "by 2.00 dB in the median (95 % confidence: 2.00 to 2.00) but loses 7.00 dB in" in answer


def test_nothing_gained(summed: Summed, ladder: Ladder) -> None:
    """No share of a gain of nothing."""
    answer = answer_of(summed(ladder(40, 0.0, 0.0)))
    assert "gains nothing over a level vehicle with a vertical dipole, in the median or" in answer
    assert "buys" not in answer


def test_one_scene(summed: Summed, ladder: Ladder) -> None:
    """Neither a median nor a worst tenth of one scene, and that it is only one."""
    summary = summed(ladder(1, 1.0, 2.0))
    assert answer_of(summary).startswith(
        "In the one scene an omnidirectional vehicle beats a level vehicle with a vertical dipole by 2.00 "
        "dB. "
        "A 10 degree tilt with a horizontal dipole buys 50 % of the gain."
    )
    assert "With 1 scene the worst tenth is 1 scene: take it as an indication only." in certainty_of(summary)


def test_one_case(summed: Summed, ladder: Ladder) -> None:
    """What it reaches, as there is nothing to set it against."""
    answer = answer_of(summed(ladder(10), cases=[{"name": "only"}]))
    assert answer == (
        f"Over 10 scenes the smallest SINR reached by an omnidirectional vehicle is {MINUS}6.00 dB in the "
        f"median and "
        f"{MINUS}10.00 dB in the worst tenth; there is no other case to set it against."
    )


def test_other_cases_than_vehicles(summed: Summed, ladder: Ladder) -> None:
    """Without a level vehicle the first case is measured against, and that there is none is said."""
    cases = [{"name": "flat", "airframe": "tilt-30"}, {"name": "tilt-10", "airframe": "tilt-10"}]
    answer = answer_of(summed(ladder(10, -2.0), cases=cases))
    assert answer.startswith(
        "Over 10 scenes a 10 degree tilt with a horizontal dipole falls behind a 30 degree tilt with a "
        "horizontal "
        "dipole by 2.00 dB in the median"
    )
    assert answer.endswith("There is no level vehicle and no omnidirectional one in this study.")


def test_only_failures(summed: Summed) -> None:
    """Then there is nothing to compare."""
    summary = summed([[["no room"] * 3]] * 2)
    assert answer_of(summary).startswith("Every row of this study is a failure")
    assert "6 rows failed, without a pose, and are left out." in certainty_of(summary)


def test_a_case_that_always_fails(summed: Summed) -> None:
    """A case without values is not said to win or lose."""
    answer = answer_of(summed([[[0.0, 1.0, "no room"]]] * 3))
    assert "no scene has a value of both an omnidirectional vehicle and a level vehicle" in answer


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
    assert "beats a level vehicle with a vertical dipole by 3.00 dB in the median" in answer
    assert "In what is guaranteed under the errors stated an omnidirectional vehicle in its robust" in answer
    assert "dipole in its robust pose by 5.00 dB in the median" in answer


def test_not_finished(summed: Summed, ladder: Ladder) -> None:
    """How far it is stands first, in the note and in the sentence."""
    summary = summed(ladder(40, 1.0, 2.0), scenes=200)
    assert unfinished_note(summary).startswith("This study is not finished: 40 of 200 scenes (20 %) are done")
    assert answer_of(summary).startswith("Over 40 scenes done so far, of 200, an omnidirectional")


def test_not_begun(summed: Summed) -> None:
    """No scene is done: nothing to say."""
    summary = summed([], scenes=200)
    assert answer_of(summary) == "No scene is done yet, so there is nothing to say."
    assert (outage_words(summary), certainty_of(summary)) == ("", "")


def test_outage(summed: Summed, ladder: Ladder) -> None:
    """How often each case misses the requirement; no word of it without one."""
    summary = summed(ladder(10, 1.0, 2.0), requirement=-4.5)
    assert outage_words(summary) == (
        "A smallest SINR of -4.5 dB is missed in 60.0 % of scenes by a level vehicle with a vertical dipole, "
        "50.0 % of scenes by a 10 degree tilt with a horizontal dipole and 40.0 % of scenes by an "
        "omnidirectional "
        "vehicle."
    )


def test_what_is_not_certified_is_counted(summed: Summed) -> None:
    """How many rows are how far proved, and what the others count as."""
    cells = [[[(0.0, "gap-not-reached"), (1.0, "best-found"), 2.0]], [["no room", 1.0, 2.0]]]
    assert certainty_of(summed(cells)) == (
        "Of 6 rows, 3 are certified. 1 with a proof that stopped before its gap and 1 of which nothing is "
        "proved "
        "enter by what their pose reaches, which is a lower bound of the best. 1 row failed, without a "
        "pose, and is "
        "left out. With 2 scenes the worst tenth is 1 scene: take it as an indication only."
    )


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
    assert "by 1 bits/s/Hz in the median (95 % confidence: 1 to 1)" in answer_of(summary)
    assert "dB" not in answer_of(summary)
