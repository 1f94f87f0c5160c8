"""Two cuts from a planning tool: .msi, .pln."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import suppress

import numpy as np

from nullpose.antenna.files.block import Block, FloatArray, Lines, from_db, numbers, refuse, rows_of

_DBD = 2.15  # dB: a half-wave dipole over an isotropic antenna
_FLAT_DB = 0.5
_WEAK_DB = 20.0  # below the peak; what is weaker may differ from side to side
_CLOCKWISE = "The file's azimuths grow clockwise seen from above; they are turned the other way round."
_ALL_ROUND = "Two cuts, and the horizontal one is flat: read as the same all round the z axis."
_DOUBT = (
    "it is not the same all round: its cuts change by {:.1f} dB from side to side; two cuts do not tell what "
    "is between them, and an estimate is off by 4 to 18 dB. Ask the maker for the whole pattern"
)


def read_msi(lines: Lines) -> Iterator[Block]:
    """Yield the pattern of an antenna that is the same all round, or an estimate of another one's.

    Losses are positive; the vertical angle grows downwards from ahead, and behind is 180 degrees.

    Args:
        lines: of the file.

    Raises:
        ScenarioError: a cut or the gain is missing or faulty.
    """
    keys = {text.split()[0].upper(): (i, text.split(None, 1)[-1]) for i, (_, text) in enumerate(lines)}
    across, down = (_loss_db(lines, keys, name) for name in ("HORIZONTAL", "VERTICAL"))
    at, gain = keys.get("GAIN", (0, ""))
    amount = [(lines[at][0], re.sub(r"dB[id]?\s*$", "", gain.strip(), flags=re.IGNORECASE))]
    gain_dbi = numbers(amount, 1, "GAIN, in dBd unless dBi is stated")[0, 0]
    stated = "dBi" if "dbi" in gain.lower() else "dBd"
    theta, phi = np.meshgrid(np.arange(181), np.arange(360), indexing="ij")
    front, back = down[(theta - 90) % 360], down[(270 - theta) % 360]
    strong = np.minimum(front, back) < np.min(down) + _WEAK_DB
    uneven_db = max(float(np.ptp(across)), float(np.max(np.abs(front - back)[strong])))
    # between the cuts: the vertical one by its weight ahead, and what the horizontal one adds at the equator
    ahead = 0.5 + 0.5 * np.cos(np.radians(phi))
    added = across[-phi % 360] - ahead * across[0] - (1.0 - ahead) * across[180]
    loss = ahead * front + (1.0 - ahead) * back + added * np.sin(np.radians(theta))
    loss = np.maximum(loss, min(np.min(across), np.min(down)))
    frequency_hz = None
    with suppress(KeyError, ValueError):  # a range of frequencies is none
        frequency_hz = 1e6 * float(keys["FREQUENCY"][1])
    yield Block(
        theta_deg=theta.ravel().astype(float),
        phi_deg=phi.ravel().astype(float),
        gain=from_db(gain_dbi + (_DBD if stated == "dBd" else 0.0) - loss).ravel(),
        frequency_hz=frequency_hz,
        notes=(
            f"Its gain is read as {stated}.",
            _CLOCKWISE,
            *([_ALL_ROUND] if uneven_db <= _FLAT_DB else []),
        ),
        doubt=_DOUBT.format(uneven_db) if uneven_db > _FLAT_DB else "",
    )


def _loss_db(lines: Lines, keys: dict[str, tuple[int, str]], name: str) -> FloatArray:
    """Return a cut's loss at every whole degree, (360,)."""
    if name not in keys:
        refuse(f"the cut {name} is missing; both must be there. Is the file cut short?")
    at, count = keys[name]
    rows = numbers([(lines[at][0], count)], 1, f"how many rows the cut {name} has")[0, 0]
    values = rows_of(lines, at + 1, rows, 2, "an angle and a loss in dB")
    angle, order = np.unique(values[:, 0] % 360.0, return_index=True)
    return np.asarray(np.interp(np.arange(360.0), angle, values[order, 1], period=360.0))
