"""The validation page's rows, each held to its tolerance, and the correction that one of them carries."""

import pytest
from known_answers import Known, known_answers, solve


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
