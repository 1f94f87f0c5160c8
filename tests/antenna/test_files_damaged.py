"""Files that are damaged: what is read is the truth, or the file is refused."""

from collections.abc import Callable
from pathlib import Path
from random import Random

import numpy as np
import pytest
from pattern_files import FIELDS, WRITERS, Field, write_omni_msi

from nullpose.antenna import PatternAntenna
from nullpose.antenna.files import read_pattern
from nullpose.antenna.harmonics import directions
from nullpose.antenna.pattern import deepest_null, table_harmonics
from nullpose.antenna.table import PatternTable
from nullpose.errors import ScenarioError

_FORMS = ("nec", "4nec2", "ffd", "old-ffd", "ffs", "cst", "cst-gains", "csv", "complex-csv", "hfss-csv")
_FORMS += ("hfss-linear", "msi")
_CLOSE_DB = 0.1
# a sign and a phase of a field are lost, the power staying; a row that few others show
_SUBTLE = (571, 989, 1125)


def errors_db(gain: np.ndarray, theta_deg: np.ndarray, phi_deg: np.ndarray, field: Field) -> np.ndarray:
    """Returns how far gains are from the truth where that is within 20 dB of its peak."""
    truth = np.sum(np.abs(field(*np.meshgrid(theta_deg, phi_deg, indexing="ij"))) ** 2, axis=-1)
    seen = truth > 1e-2 * np.max(truth)
    return np.abs(10.0 * np.log10(np.maximum(gain[seen], 1e-30) / truth[seen]))


def assert_true(table: PatternTable, field: Field) -> None:
    """Asserts that a table is a pattern, that solvers use that pattern, and that they use no deeper null."""
    used = table_harmonics(table)
    assert np.max(errors_db(table.gain, table.theta_deg, table.phi_deg, field)) < _CLOSE_DB
    between = np.arange(0.5, 180.0, 7.0), np.arange(0.5, 360.0, 7.0)
    gain = PatternAntenna("", "", used).gain(directions(*between))
    assert np.max(errors_db(gain, *between, field)) < _CLOSE_DB
    assert deepest_null(used)[0] >= np.min(table.gain) * (1.0 - 1e-6) - 1e-12


write = {form: writer for form, (_, writer) in WRITERS.items()} | {"msi": write_omni_msi}
FORMS = [(form, name) for form in _FORMS for name in FIELDS if form != "msi" or name == "omni"]
# that each form is read at all, of an antenna without symmetry, is in test_files.py
_REGULAR = [each if each[1] == "omni" else pytest.param(*each, marks=pytest.mark.slow) for each in FORMS]


@pytest.mark.parametrize(("form", "name"), _REGULAR)
def test_regular_files_are_read(tmp_path: Path, form: str, name: str) -> None:
    """Every form of every format gives each of three patterns, in UTF-8 or in UTF-16, to .1 dB."""
    path = tmp_path / "pattern.txt"
    path.write_text(write[form](FIELDS[name], 10.0), encoding="utf-16" if name == "omni" else "utf-8")
    assert_true(read_pattern(path), FIELDS[name])


def _in_a_number(random: Random, lines: list[str], at: int, change: Callable[[str], str]) -> None:
    words = lines[at].replace(",", " , ").split()
    places = [i for i, word in enumerate(words) if any(c.isdigit() for c in word)]
    if places:
        i = random.choice(places)
        words[i] = change(words[i])
    lines[at] = " ".join(words).replace(" , ", ",")


def damaged(random: Random, text: str) -> str:
    """Returns a text with one damage: lines or numbers lost, given twice, exchanged or wrong."""
    lines = text.split("\n")
    table = next(
        i for i in range(len(lines) - 20) if all(line[:1] in " -.0123456789" for line in lines[i : i + 20])
    )
    at, other = (random.randrange(table + 8, len(lines) - 1) for _ in range(2))
    kind = random.randrange(12)
    if kind == 0:
        return text[: random.randrange(len(text))]
    if kind == 1:
        del lines[at : at + random.choice([1, 1, 2, 50])]
    elif kind == 2:
        lines.insert(at, lines[other])
    elif kind == 3:
        lines[at], lines[other] = lines[other], lines[at]
    elif kind == 4:
        lines[at] = random.choice(["", "x", "1 2", "nan nan nan", lines[at][: len(lines[at]) // 2]])
    elif kind == 5:
        return (
            text.replace(".", ",")
            if random.random() < 0.5
            else "\n".join([*lines[:table], *(x.replace(".", ",") for x in lines[table:])])
        )
    elif kind == 6:
        start = random.randrange(max(1, table - 3))
        gone = random.randrange(1 + len(lines[start]))
        lines[start] = lines[start][:gone] + lines[start][gone + 1 :]
    elif kind == 7:
        del lines[random.randrange(table + 1)]
    else:
        digit = str(random.randrange(10))
        change: Callable[[str], str] = random.choice(
            [
                lambda word: word.replace("-", "") if "-" in word else f"-{word}",
                lambda word: random.choice(["-999.99", "1e9", "0", "inf", "1e-9", "99.9"]),
                lambda word: word[:-1] + digit,
                lambda word: digit + word[1:] if word[0] != "-" else f"-{digit}{word[2:]}",
                lambda word: word.replace(".", digit, 1),
                lambda word: word[:1] + word[2:],
            ]
        )
        _in_a_number(random, lines, at, change)
    return "\n".join(lines)


@pytest.mark.parametrize(
    "seed", [*range(24), *_SUBTLE, *(pytest.param(n, marks=pytest.mark.slow) for n in range(24, 150))]
)
def test_damaged_files_are_refused_or_read_right(tmp_path: Path, seed: int) -> None:
    """Of damaged files none is misread: what is accepted is the pattern to .1 dB, 20 dB down."""
    random = Random(seed)
    form, name = random.choice(FORMS)
    path = tmp_path / "pattern.txt"
    path.write_text(damaged(random, write[form](FIELDS[name], 10.0)), encoding="utf-8")
    try:
        table = read_pattern(path)
    except ScenarioError:
        return
    assert_true(table, FIELDS[name])
