"""The validation page's rows, each held to its tolerance, and the correction that one of them carries."""

import pytest
from known_answers import SCENARIO, Known, known_answers, solve

import nullpose


@pytest.mark.parametrize(
    "known", known_answers(), ids=lambda known: f"{known.scheme}-{known.jamming_ratio:g}"
)
def test_known_answer_is_reproduced(known: Known) -> None:
    """The value is certified and agrees to the digits given, and the position to a centimetre."""
    row = solve(known)
    assert row.error_db == pytest.approx(0.0, abs=known.tolerance_db)
    assert row.position_m[: len(known.position_m)] == pytest.approx(known.position_m, abs=0.01)
    assert row.certified
    assert row.min_sinr_db <= row.upper_bound_db <= row.min_sinr_db + 4.4e-6
    assert row.agrees


def test_correction_is_due() -> None:
    """Beside the jammer, not straight above it, an upright dipole does better than the value first given."""
    scenario = nullpose.load(SCENARIO)
    beside = nullpose.Pose(position_m=(16.9974, 15.0054, 8.0), roll_rad=0.0, pitch_rad=0.0)
    corrected = [known for known in known_answers() if known.given_db]
    assert [(known.scheme, known.jamming_ratio, known.given_db) for known in corrected] == [
        ("vertical", 1.0, "-2.1608")
    ]
    smallest_db = min(link.sinr_db for link in nullpose.evaluate(scenario, beside))
    assert smallest_db == pytest.approx(float(corrected[0].min_sinr_db), abs=5e-5)
    assert smallest_db > float(corrected[0].given_db) + 4e-4
