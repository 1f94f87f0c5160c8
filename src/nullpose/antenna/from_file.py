"""Antennas whose pattern is from a file: the same all round, or any other."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path, PurePath

import numpy as np

from nullpose.antenna.kind import AntennaKind
from nullpose.antenna.pattern import (
    PatternAntenna,
    harmonics_of_rows,
    normalised,
    profile_harmonics,
    table_harmonics,
)
from nullpose.files import PlainTable

# The readers of files are imported where one is read: most scenarios name none.

ESTIMATE = "estimate from two cuts"
"""What the antenna's label and the scenario's name say where two cuts do not tell the pattern."""
_KEYS = ("file", "format", "frequency_hz", "normalise", "harmonics")


def pattern_antenna(
    kind: str,
    *,
    harmonics: Sequence[Sequence[float]] | None,
    file: str | None,
    frequency_hz: float | None,
    normalise: str,
    two_cuts: str | None = None,
    **_: object,
) -> PatternAntenna:
    """Make the antenna of a table ``[antenna]`` whose file has been read.

    Args:
        kind: its kind.
        harmonics: the terms of its gain, by degree.
        file: where they are from, for its label.
        frequency_hz: likewise.
        normalise: "peak" for a largest gain of 1.
        two_cuts: None unless it is an estimate.
    """
    found = harmonics_of_rows(harmonics or ())
    of_file = f" of {PurePath(file).name}" if file else ""
    at = "" if frequency_hz is None else f" at {frequency_hz / 1e6:.7g} MHz"
    estimate = "" if two_cuts is None else f" ({ESTIMATE})"
    return PatternAntenna(
        kind, f"{kind}{of_file}{at}{estimate}", normalised(found) if normalise == "peak" else found
    )


def _read_profile(path: Path, _: PlainTable) -> tuple[PlainTable, tuple[str, ...]]:
    from nullpose.antenna.files import read_profile

    angle_deg, gain, notes = read_profile(path)
    return {"harmonics": profile_harmonics(angle_deg, gain).rows()}, notes


def with_profile(table: PlainTable, path: Path) -> tuple[PlainTable, tuple[str, ...]]:
    """Fill in a raw ground point what the file of its upright antenna holds, with notes.

    Args:
        table: of any antenna; only a profile has a file.
        path: of the file.

    Raises:
        ScenarioError: the file cannot be read, or would mislead.
    """
    from nullpose.antenna.files import read_profile

    if table.get("antenna") != "profile":
        return table, ()
    angle_deg, gain, notes = read_profile(path)
    rows = np.column_stack([90.0 - angle_deg, 10.0 * np.log10(np.maximum(gain, 1e-10))])  # -100 dBi
    return {**table, "antenna_profile": rows[::-1].tolist()}, notes


def _read_pattern(path: Path, table: PlainTable) -> tuple[PlainTable, tuple[str, ...]]:
    from nullpose.antenna.files import read_pattern
    from nullpose.antenna.files.block import refuse

    is_estimate = table.get("two_cuts") is not None
    pattern = read_pattern(path, table.get("format"), table.get("frequency_hz"), estimate=is_estimate)
    if is_estimate and not pattern.caveat:
        refuse("two_cuts has no meaning: the file tells the whole pattern; remove the key")
    frequency = {} if pattern.frequency_hz is None else {"frequency_hz": pattern.frequency_hz}
    return {**frequency, "harmonics": table_harmonics(pattern).rows()}, pattern.notes


PROFILE = AntennaKind(
    "one that is the same all round, by its gain over the angle from its axis",
    partial(pattern_antenna, "profile"),
    _KEYS,
    _read_profile,
)
PATTERN = AntennaKind("any other", partial(pattern_antenna, "pattern"), (*_KEYS, "two_cuts"), _read_pattern)
