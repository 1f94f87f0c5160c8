"""The verb ``reproduce``."""

from __future__ import annotations

from nullpose.cli.options import JsonOutput, OutFolder, Seed
from nullpose.cli.output import compiling_announced, tell
from nullpose.cli.progress import Ticker


def reproduce(out: OutFolder, seed: Seed = 0, json_output: JsonOutput = False) -> None:
    """Redraw the paper's Figure 2 and its poses."""
    from nullpose import paper

    with compiling_announced(), Ticker("reproducing the paper") as ticker:
        reproduction = paper.reproduce(out, seed=seed, on_progress=ticker)
    tell(reproduction, paper.reproduction_view, json_output, files=reproduction.files)
