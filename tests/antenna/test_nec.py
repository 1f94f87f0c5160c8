"""Genuine output of nec2c: peaks, ripples and nulls as they are known from finer grids."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from pattern_files import DATA, written

from nullpose.antenna.files import read_pattern
from nullpose.antenna.summary import summary_of
from nullpose.antenna.table import PatternTable
from nullpose.errors import ScenarioError

# Peak (dBi), ripple round the equator and depth of the deepest null (dB), on grids of 1 degree.
KNOWN = {
    "alone_half": (2.14, 0.0, np.inf),
    "alone_short": (1.77, 0.0, np.inf),
    "hex35_above_10_half_off20mm": (3.4, 1.8, 32.0),
    "hex35_beside_10_half": (4.0, 4.1, 28.0),
}


@cache
def known(name: str) -> PatternTable:
    """Read a known pattern, once."""
    return read_pattern(DATA / f"{name}_5deg.out.gz")


@pytest.mark.parametrize(
    "name", [*list(KNOWN)[::3], *(pytest.param(name, marks=pytest.mark.slow) for name in list(KNOWN)[1:3])]
)
def test_known_patterns(name: str) -> None:
    """Peak, ripple and null are those of the finer grids, to what 5 degrees show; nothing is lost."""
    summary = summary_of(known(name))
    peak_dbi, ripple_db, null_db = KNOWN[name]
    assert summary.peak_dbi == pytest.approx(peak_dbi, abs=0.1)
    assert summary.ripple_db == pytest.approx(ripple_db, abs=0.2)
    assert min(summary.null_db, 99.0) == pytest.approx(min(null_db, 99.0), abs=5.0)
    assert summary.mean_db == pytest.approx(0.0, abs=0.03)
    assert np.isinf(summary.null_db) == np.isinf(null_db)
    assert summary.table.frequency_hz == 2.4e9


def test_the_short_dipole_is_the_formula() -> None:
    """The gain of the dipole alone is 1.5 sin^2 but for its length, a tenth of a wavelength."""
    table = known("alone_short")
    formula = 1.5 * np.sin(np.radians(table.theta_deg[1:-1]))[:, None] ** 2
    assert np.max(np.abs(10.0 * np.log10(table.gain[1:-1] / formula))) < 0.1


def test_a_table_of_averages_alone_is_passed_over(tmp_path: Path) -> None:
    """What an RP card asks for beside the pattern does not block it."""
    whole = read_pattern(_saved(tmp_path, written("nec", 10.0)))
    averages = "\n  ----- RADIATION PATTERNS -----\n\n AVERAGE POWER GAIN= 1.0\n 0.00000E+00  ANTENNA.NEC\n"
    np.testing.assert_array_equal(
        read_pattern(_saved(tmp_path, written("nec", 10.0) + averages)).gain, whole.gain
    )
    with pytest.raises(ScenarioError, match="no table of gains"):
        read_pattern(_saved(tmp_path, averages))


def _saved(folder: Path, text: str) -> Path:
    (path := folder / "pattern.out").write_text(text, encoding="utf-8")
    return path
