"""What is proved of a set of values, in numbers and words that never claim too much."""

from dataclasses import replace

from hypothesis import given, strategies as st

from nullpose import Pose, Status
from nullpose.objectives import RECORDS, USUAL
from nullpose.report.answer import certainty_lines, counted
from nullpose.report.numbers import rounded_up
from nullpose.solver import Objective
from nullpose.study import Case, ResultRow, ResultTable

POSE = Pose((0.0, 0.0, 8.0), 0.0, 0.0)
VALUE = Objective(quantity=RECORDS[USUAL].quantities[0], value=1.0, value_db=0.0)
SEARCHED = ResultRow(
    value=1.0,
    case=Case(name="optimum", scheme="optimum"),
    scenario=None,
    scheme="optimum",
    status=Status.BEST_FOUND,
    objective=VALUE,
    pose=POSE,
    links=(),
    stats=None,
    provenance={},
)
NEAR, FAR = (replace(VALUE, upper_bound=1.0 + gap, relative_gap=gap) for gap in (9e-7, 0.25))
PROVED = replace(SEARCHED, status=Status.CERTIFIED, objective=NEAR)
OPEN = replace(SEARCHED, status=Status.GAP_NOT_REACHED, objective=FAR, reason="a limit")


def test_statuses_are_counted() -> None:
    """Every status is counted, and the widest gap is of those with a bound."""
    found = counted([PROVED, PROVED, OPEN, SEARCHED])
    assert list(found.values()) == [4, 2, 1, 1, 0.25]


def test_lines_name_the_curves_that_are_not_proved() -> None:
    """One line when all is proved; otherwise each curve is named with what is proved of it."""
    (line,) = certainty_lines(ResultTable("x", (PROVED,)))
    assert line.startswith("Each point is certified optimal within 9e-7 (relative)")
    vertical = replace(OPEN, case=Case(name="vertical", scheme="vertical"))
    gain = replace(SEARCHED, case=Case(name="maximum-gain", scheme="maximum-gain"))
    lines = certainty_lines(ResultTable("x", (PROVED, vertical, gain)))
    assert lines[0].startswith("Optimum: each point is certified optimal within 9e-7")
    assert "Vertical: all bounds are valid" in lines[1]
    assert "not reached at 1 of 1 points; relative gap up to 0.25" in lines[1]
    assert lines[2] == "Maximum gain: best found by search, no upper bound"
    assert certainty_lines(ResultTable("x", (SEARCHED,))) == ["Best found by search, no upper bound"]


@given(number=st.floats(-1e12, 1e12).filter(lambda x: x == 0.0 or abs(x) > 1e-12), digits=st.integers(1, 6))
def test_rounding_is_outward(number: float, digits: int) -> None:
    """What is at most a number is never stated as less."""
    slack = 1e-8 * abs(number)
    assert float(rounded_up(number, digits)) >= number - slack
