"""Two cuts from a planning tool: .msi, .pln, .prn."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from nullpose.antenna.files.block import DBD, Block, Lines, from_db, numbers, refuse, require, rows_of
from nullpose.antenna.harmonics import FloatArray

_CUTS = ("HORIZONTAL", "VERTICAL")
_KEYS = ("GAIN", "FREQUENCY", *_CUTS)
_OMNI_DB = 1.5  # peak to peak of the horizontal cut
_CROSSING_DB = 1.0
_WEAK_DB = 20.0  # below the peak; what is weaker may differ
_LIKE_ZENITH_DEG = 30.0  # a beam is taken for one measured from the zenith so near to straight down
_WIDEST_DEG = 10.0  # between two rows of a cut
_NEGATIVE_DB = 0.05
_NUMBER = re.compile(r"(?!GAIN|FREQ|HORIZ|VERT|MECH)[A-Z].* ([-+]?\d+\.?\d*)", re.IGNORECASE)
_CAVEAT = (
    "it is an estimate by the sum of losses: its horizontal cut changes by {:.1f} dB, and two cuts do not "
    "tell what is between them"
)


def read_msi(lines: Lines) -> Iterator[Block]:
    """Yield the profile of an antenna that is the same all round, or an estimate of another one's pattern.

    Losses are positive; the vertical angle grows downwards from ahead, and behind is 180 degrees. The
    estimate is the sum of losses ``L(theta, phi) = H(phi) + w (V(theta, ahead) - V(90, ahead)) + (1 - w)
    (V(theta, behind) - V(90, behind))`` with ``w = (1 + cos phi) / 2``, which meets both cuts where they
    cross; it is no less than H(phi) or the mean of both V(theta) with the weights w and 1 - w.

    Source: 3GPP TR 38.901, table 7.3-1, for the sum. The weights, which join both halves smoothly, are ours.

    Args:
        lines: of the file.

    Raises:
        ScenarioError: a cut or the gain is missing or faulty, or the cuts contradict each other.
    """
    keys: dict[str, tuple[int, str]] = {}
    for i, (line, text) in enumerate(lines):
        key = text.split()[0].upper()
        require(key not in {*keys} & {*_KEYS}, f"{key} is given twice; keep one antenna in a file", line)
        keys[key] = i, text.split(None, 1)[-1]
    for name in _CUTS:
        require(name in keys, f"the cut {name} is missing; both must be there. Is the file cut short?")
    across, down = (_loss_db(lines, keys, name) for name in _CUTS)
    _require_crossing(across, down)
    least_db = min(np.min(across), np.min(down))
    require(
        least_db <= _CROSSING_DB,
        f"no direction has a loss below {least_db:g} dB; GAIN is that of the direction with a loss of 0",
    )
    more = {key: found[1] for key, (_, text) in keys.items() if (found := _NUMBER.fullmatch(f"{key} {text}"))}
    tilts_deg = {key: round(float(number)) for key, number in more.items() if "TILT" in key}
    for key, tilt_deg in tilts_deg.items():
        below_db = float(down[tilt_deg % 360] - np.min(down))
        require(
            tilt_deg == 0 or below_db <= _CROSSING_DB,
            f"{key} is {tilt_deg} degrees, where the vertical cut is {below_db:.1f} dB below its peak, at "
            f"{np.argmin(down)}; ask for the cuts at that tilt, with the angle growing downwards",
            lines[keys[key][0]][0],
        )
    unread = ", ".join(key for key in more if key not in tilts_deg)
    at, text = keys.get("GAIN", (0, ""))
    amount = [(lines[at][0], re.sub(r"dB[id]?\s*$", "", text.strip(), flags=re.IGNORECASE))]
    gain_dbi = numbers(amount, 1, "GAIN, in dBd unless dBi is stated")[0, 0]
    unit, more_db = ("dBi", 0.0) if "dbi" in text.lower() else ("dBd", DBD)
    theta, phi = np.meshgrid(np.arange(181), np.arange(360), indexing="ij")
    halves_db, ripple_db = (down[(theta - 90) % 360], down[(270 - theta) % 360]), float(np.ptp(across))
    is_profile = ripple_db <= _OMNI_DB
    gain, note = _profile(*halves_db, ripple_db) if is_profile else _estimate(*halves_db, across[-phi % 360])
    frequency_hz, of_frequency = _frequency_hz(keys.get("FREQUENCY", (0, ""))[1].strip())
    yield Block(
        theta_deg=theta.ravel().astype(float),
        phi_deg=phi.ravel().astype(float),
        gain=(gain * from_db(gain_dbi + more_db)).ravel(),
        frequency_hz=frequency_hz,
        notes=(
            f"Its gain is read as {unit}.",
            note,
            of_frequency,
            *([f"Not read: {unread}."] if unread else []),
        ),
        caveat="" if is_profile else _CAVEAT.format(ripple_db),
    )


def _require_crossing(across: FloatArray, down: FloatArray) -> None:
    """Refuse cuts that contradict each other ahead or behind, where they cross."""
    peaks_deg = [int(np.argmin(cut)) for cut in (across, down)]
    advice = (
        f"The horizontal cut is strongest at {peaks_deg[0]} degrees and the vertical one at {peaks_deg[1]}: "
        "ask for cuts without the beam's tilt, which cross ahead at the horizon"
    )
    if abs(peaks_deg[1] % 180 - 90) < _LIKE_ZENITH_DEG:
        advice = "Is the vertical angle measured from the zenith? It must be 0 ahead and 90 below"
    for at_deg, where in ((0, "ahead"), (180, "behind")):
        both_db = across[at_deg], down[at_deg]
        require(
            min(both_db) >= _WEAK_DB or abs(both_db[0] - both_db[1]) <= _CROSSING_DB,
            f"{where}, where its cuts cross, the horizontal one has a loss of {both_db[0]:g} dB and the "
            f"vertical one {both_db[1]:g} dB; must be the same. {advice}",
        )


def _profile(front_db: FloatArray, back_db: FloatArray, ripple_db: float) -> tuple[FloatArray, str]:
    """Return the gain of an antenna that is the same all round, and a note on what is left out."""
    strong = np.minimum(front_db, back_db) < _WEAK_DB
    apart_db = float(np.max(np.abs(front_db - back_db)[strong], initial=0.0))
    note = (
        "Read as the same all round, by the mean of the vertical cut's halves. Not modelled: the "
        f"horizontal cut's ripple of {ripple_db:.1f} dB, and {apart_db:.1f} dB between the halves."
    )
    return 0.5 * (from_db(-front_db) + from_db(-back_db)), note


def _estimate(front_db: FloatArray, back_db: FloatArray, round_db: FloatArray) -> tuple[FloatArray, str]:
    """Return the gain by the sum of losses, by polar angle and azimuth, and a note on how these are read."""
    ahead = 0.5 + 0.5 * np.cos(np.radians(np.arange(round_db.shape[1])))
    down_db = ahead * front_db + (1.0 - ahead) * back_db
    sum_db = round_db + down_db - ahead * front_db[90] - (1.0 - ahead) * back_db[90]
    gain = from_db(-np.maximum(sum_db, np.minimum(round_db, down_db)))
    gain[[0, -1]] = np.mean(gain[[0, -1]], axis=1, keepdims=True)  # where all azimuths are one direction
    return gain, "The file's azimuths grow clockwise seen from above; they are turned the other way round."


def _frequency_hz(text: str) -> tuple[float | None, str]:
    """Return the frequency that a file states, None for a range or none, and a note on how it is read."""
    try:
        frequency_hz = 1e6 * float(re.sub(r"MHz$", "", text, flags=re.IGNORECASE))
    except ValueError:
        return None, f"Its FREQUENCY, {text[:40]!r}, is not one number in MHz: not known."
    return frequency_hz, f"Its FREQUENCY, {text}, is read in MHz."


def _loss_db(lines: Lines, keys: dict[str, tuple[int, str]], name: str) -> FloatArray:
    """Return a cut's loss at every whole degree, (360,)."""
    at, count = keys[name]
    rows = numbers([(lines[at][0], count)], 1, f"how many rows the cut {name} has")[0, 0]
    values = rows_of(lines, at + 1, rows, 2, "an angle and a loss in dB")
    end = at + 1 + len(values)
    if end < len(lines) and re.match(r"[-+.\d]", lines[end][1].strip()):
        refuse(f"the cut {name} has more rows than the {rows:g} that are announced", lines[end][0])
    angle, order, which = np.unique(np.round(values[:, 0] % 360.0, 3), return_index=True, return_inverse=True)
    gaps = np.diff(angle, append=angle[0] + 360.0)
    far = f"is too far from the next: rows go all round, at most {_WIDEST_DEG:g} degrees apart"
    for wrong, why in [
        (values[:, 1] < -_NEGATIVE_DB, "has a loss below 0; losses are positive"),
        (values[:, 1] != values[order, 1][which], "is given twice, with other losses; keep one"),
        (np.isin(np.arange(len(values)), order[gaps > _WIDEST_DEG]), far),
    ]:
        for i in np.flatnonzero(wrong)[:1]:
            refuse(f"the cut {name} at {values[i, 0]:g} degrees {why}", lines[at + 1 + i][0])
    return np.asarray(np.interp(np.arange(360.0), angle, values[order, 1], period=360.0))
