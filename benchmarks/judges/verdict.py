"""What a judge found, and the page that tells it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

PAGE = Path(__file__).parents[2] / "docs" / "judges.md"

_HEAD = """# Judged by other engines

`make judges` has two programs of others evaluate what nullpose evaluates. They share no code with it. This
page is written by that command.

- **Sionna RT** traces the line of sight between the drone and every ground point, with its own antennas and
  polarisation, in single precision. In two scenes it does so past buildings, as meshes of walls, roofs and
  floors: the town of `examples/town.toml`, and a grid of turned blocks with courtyards, corners, passages and
  intervals of heights, of which jammers have the lower roofs.
- **nec2c** solves for the currents on wires: patterns of dipoles, and the coupling between an upright dipole
  on the ground and a tilted one in the air, either of them fed.

A deviation of the SINR is relative to it, or to what an antenna 40 dB above its null would get where that is
more. One in dB is the largest where the gain is less than 30 dB below its peak. Of lines of sight it is how
many differ; a link that buildings a millimetre larger or smaller would change is left out. Blocked links have
200 dB of loss here, for the ray tracer has nothing of them.

"""


@dataclass(frozen=True, slots=True)
class Verdict:
    """One comparison: the largest deviation of values; None where no judge could be asked."""

    judge: str
    what: str
    cases: int
    deviation: float | None
    allowed: float
    unit: str = ""
    reason: str = ""

    @property
    def agrees(self) -> bool:
        """Whether nothing speaks against nullpose."""
        return self.deviation is None or self.deviation <= self.allowed

    def row(self) -> str:
        """Return the row of a Markdown table."""
        if self.deviation is None:
            cells = ("0", "-", f"{self.allowed:g} {self.unit}", f"not asked: {self.reason}")
            return f"| {self.judge} | {self.what} | {' | '.join(cells)} |"
        word = "agrees" if self.agrees else "**disagrees**"
        cells = (f"{self.deviation:.2g} {self.unit}", f"{self.allowed:g} {self.unit}", word)
        return f"| {self.judge} | {self.what} | {self.cases} | {' | '.join(cells)} |"


def page(verdicts: Sequence[Verdict]) -> str:
    """Return the page that tells what every judge found."""
    head = ["| judge | what | values | largest deviation | allowed | verdict |", "|---|---|---|---|---|---|"]
    return _HEAD + "\n".join([*head, *(verdict.row() for verdict in verdicts)]) + "\n"
