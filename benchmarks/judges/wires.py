"""nec2c as a judge: patterns of dipoles, and how two of them couple."""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from benchmarks.judges.verdict import Verdict
from nullpose.antenna.dipoles import half_wave_harmonics
from nullpose.antenna.files import read_pattern
from nullpose.physics import dipole_gain

_MHZ = 299.792458  # a wavelength of one metre
_ALLOWED_DB = 0.1
_DEEP_DB = 30.0
_SHORT_M, _THIN_M = 0.02, 1e-5
_DISTANCES_M = (20.0, 40.0)


def verdicts() -> Iterator[Verdict]:
    """Yield what nec2c says of a short dipole, a half-wave dipole and a link of two dipoles."""
    program = shutil.which("nec2c")
    if program is None:
        for what in ("short dipole", "half-wave dipole", "coupled dipoles"):
            yield Verdict(
                "nec2c", what, 0, None, _ALLOWED_DB, "dB", "not on the path; on Debian: apt install nec2c"
            )
        return
    yield _pattern("pattern of a short dipole", _SHORT_M, lambda theta: np.sin(theta) ** 2)
    axial = half_wave_harmonics()
    yield _pattern(
        "pattern of a half-wave dipole", 0.5, lambda theta: axial.on_grid(theta, np.zeros(1))[:, 0]
    )
    yield from _coupling()


def wire(tag: int, segments: int, middle: np.ndarray, axis: np.ndarray, length_m: float) -> str:
    """Return the card of a straight wire."""
    ends = [middle - 0.5 * length_m * axis, middle + 0.5 * length_m * axis]
    places = " ".join(f"{x:.9f}" for end in ends for x in end)
    return f"GW {tag} {segments} {places} {_THIN_M:g}"


def deck(wires: list[str], fed: int, segment: int, more: list[str]) -> str:
    """Return a deck in free space with one wire fed in its middle segment."""
    lines = ["CM nullpose", "CE", *wires, "GE 0", f"FR 0 1 0 0 {_MHZ} 0", f"EX 0 {fed} {segment} 0 1.0 0.0"]
    return "\n".join([*lines, *more, "EN", ""])


def run(text: str, keep: Path) -> Path:
    """Return the output of nec2c for a deck."""
    source, output = keep / "deck.nec", keep / "deck.out"
    source.write_text(text)
    subprocess.run(["nec2c", "-i", source, "-o", output], check=True, capture_output=True, timeout=120)
    return output


def current(output: str, tag: int, segment: int) -> float:
    """Return the magnitude of the current in a wire's segment, counted from 1.

    Raises:
        ValueError: the output has no such segment.
    """
    _, found, table = output.partition("CURRENTS AND LOCATION")
    rows = [line.split() for line in table.splitlines() if re.match(r"\s*\d+\s+\d+\s", line)]
    of_wire = [row for row in rows if int(row[1]) == tag]
    if not found or len(of_wire) < segment:
        raise ValueError(f"no current in segment {segment} of wire {tag}")
    return float(of_wire[segment - 1][8])


def _pattern(what: str, length_m: float, gain: object) -> Verdict:
    """Return how a dipole's pattern differs from a formula."""
    up = np.array([0.0, 0.0, 1.0])
    text = deck([wire(1, 51, np.zeros(3), up, length_m)], 1, 26, ["RP 0 91 36 1000 0.0 0.0 2.0 10.0"])
    with tempfile.TemporaryDirectory() as folder:
        table = read_pattern(run(text, Path(folder)))
    theirs = 10.0 * np.log10(np.maximum(table.gain / table.gain.max(), 1e-12))
    ours = 10.0 * np.log10(np.maximum(gain(np.radians(table.theta_deg)), 1e-12))  # type: ignore[operator]
    near = ours > -_DEEP_DB
    deviation = np.abs(theirs[near] - ours[near, None])
    return Verdict("nec2c", what, int(deviation.size), float(deviation.max()), _ALLOWED_DB, "dB")


def _coupling() -> Iterator[Verdict]:
    """Yield how the link of an upright and a tilted dipole differs, and the two ways of feeding it."""
    rng = np.random.default_rng(3)
    up, ours, one_way, other_way = np.array([0.0, 0.0, 1.0]), [], [], []
    while len(ours) < 24:
        way, axis = rng.normal(size=(2, 3))
        place = way / np.linalg.norm(way) * rng.choice(_DISTANCES_M)
        axis /= np.linalg.norm(axis)
        gain = float(dipole_gain(place, axis, np.zeros((1, 3)), up[None])[0])
        if gain < 10.0 ** (-_DEEP_DB / 10.0):
            continue
        wires = [wire(1, 3, np.zeros(3), up, _SHORT_M), wire(2, 3, place, axis, _SHORT_M)]
        with tempfile.TemporaryDirectory() as folder:
            for fed, heard, values in ((1, 2, one_way), (2, 1, other_way)):
                output = run(deck(wires, fed, 2, ["XQ"]), Path(folder)).read_text()
                values.append(20.0 * np.log10(current(output, heard, 2)))
        ours.append(10.0 * np.log10(gain / np.sum(place**2)))
    theirs, level = np.array(one_way), np.array(one_way) - ours
    deviation = float(np.max(np.abs(level - np.median(level))))
    yield Verdict("nec2c", "link of an upright and a tilted dipole", len(ours), deviation, _ALLOWED_DB, "dB")
    both = float(np.max(np.abs(theirs - other_way)))
    yield Verdict("nec2c", "the same, the other one fed", len(ours), both, _ALLOWED_DB, "dB")
