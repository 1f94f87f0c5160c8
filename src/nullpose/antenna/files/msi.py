"""Two cuts of a planning tool: .msi, .pln."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nullpose.antenna.files.block import Block, Lines, from_db, numbers, refuse

_DBD = 2.15  # dB over an isotropic antenna of a half-wave dipole, which gains are over unless dBi is stated
_FLAT_DB = 0.5
_ESTIMATE = (
    "Two cuts do not tell a pattern: between them gains are an estimate, off by 4 to 18 dB for antennas that "
    "are not the same all round."
)


def is_msi(lines: Lines) -> bool:
    """Return whether a file has the two cuts."""
    heads = {line.split()[0].upper() for _, line in lines if line.split()}
    return {"HORIZONTAL", "VERTICAL"} <= heads


def read_msi(lines: Lines, estimate: bool = False) -> Iterator[Block]:
    """Yield the pattern of an antenna that is the same all round, or an estimate of another one's.

    Losses are positive. The vertical angle grows downwards from the horizon ahead, the azimuth clockwise.

    Args:
        lines: of the file.
        estimate: whether a horizontal cut that is not flat is taken all the same.
    """
    keys: dict[str, str] = {}
    cuts: dict[str, np.ndarray] = {}
    at = 0
    while at < len(lines):
        line, text = lines[at]
        word, _, rest = text.strip().partition(" ")
        at += 1
        if word.upper() in ("HORIZONTAL", "VERTICAL"):
            count = int(numbers(rest, line, 1, "the count of a cut's rows")[0])
            rows = lines[at : at + count]
            if len(rows) < count:
                refuse(f"the cut has {len(rows)} rows, must be {count}: the file is cut short", line)
            cuts[word.upper()] = np.array(
                [numbers(row, n, 2, "an angle and a loss in dB") for n, row in rows]
            )
            at += count
        else:
            keys[word.upper()] = rest.strip()
    if cuts.keys() != {"HORIZONTAL", "VERTICAL"}:
        refuse("the cuts HORIZONTAL and VERTICAL are not both there, must be")
    across, down = (_loss(cuts[name]) for name in ("HORIZONTAL", "VERTICAL"))
    ripple = float(np.ptp(across))
    if ripple > _FLAT_DB and not estimate:
        refuse(
            f"the horizontal cut changes by {ripple:.1f} dB. {_ESTIMATE} Only a flat horizontal cut can be "
            "solved for; ask the maker for the whole pattern"
        )
    theta, phi = np.meshgrid(np.arange(0.0, 181.0), np.arange(0.0, 360.0), indexing="ij")
    front, back = down[(theta - 90.0).astype(int) % 360], down[(270.0 - theta).astype(int) % 360]
    ahead = 0.5 * (1.0 + np.cos(np.radians(phi)))
    loss = ahead * front + (1.0 - ahead) * back
    if ripple > _FLAT_DB:
        side = across[(-phi).astype(int) % 360]
        loss = loss + (side - ahead * across[0] - (1.0 - ahead) * across[180]) * np.sin(np.radians(theta))
    block = Block(theta_deg=theta.ravel(), phi_deg=phi.ravel(), gain=from_db(_gain_dbi(keys) - loss).ravel())
    block.frequency_hz = _frequency(keys)
    block.notes = (
        [_ESTIMATE] if ripple > _FLAT_DB else ["Read as the same all round: its horizontal cut is flat."]
    )
    yield block


def _loss(rows: np.ndarray) -> np.ndarray:
    """Return the loss at each whole degree."""
    angle, order = np.unique(np.mod(rows[:, 0], 360.0), return_index=True)
    return np.asarray(np.interp(np.arange(360.0), angle, rows[order, 1], period=360.0))


def _gain_dbi(keys: dict[str, str]) -> float:
    words = keys.get("GAIN", "").split()
    if not words:
        refuse("GAIN is missing, must be told in dBd or dBi")
    value = numbers(words[0].rstrip("dBbiID"), 0, 1, "GAIN")[0]
    return value if "DBI" in keys["GAIN"].upper() else value + _DBD


def _frequency(keys: dict[str, str]) -> float | None:
    try:
        return float(keys["FREQUENCY"].split()[0]) * 1e6
    except (KeyError, IndexError, ValueError):
        return None
