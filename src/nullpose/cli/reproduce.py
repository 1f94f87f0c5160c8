"""The verb ``reproduce``."""

from __future__ import annotations

from nullpose.cli.options import JsonOutput, OutFolder, Seed
from nullpose.cli.output import compiling_announced, tell
from nullpose.cli.progress import Ticker


def reproduce(out: OutFolder, seed: Seed = 0, json_output: JsonOutput = False) -> None:
    """Redraw the paper's Figure 2 and check each of its claims."""
    from nullpose.paper.pages import reproduction_view
    from nullpose.paper.reproduce import reproduce as reproduce_paper

    with compiling_announced(), Ticker("reproducing the paper") as ticker:
        reproduction = reproduce_paper(out, seed=seed, on_progress=ticker)
    tell(reproduction, reproduction_view, json_output)
