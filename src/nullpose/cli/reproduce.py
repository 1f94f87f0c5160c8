"""The verb ``reproduce``."""

from __future__ import annotations

from nullpose.cli.options import JsonOutput, OutFolder, Seed
from nullpose.cli.output import Ticker, compiling_announced, show, show_json

__all__ = ["reproduce"]


def reproduce(out: OutFolder, seed: Seed = 0, json_output: JsonOutput = False) -> None:
    """Redraw the paper's Figure 2 and check each of its claims."""
    from nullpose.paper.pages import claims_view
    from nullpose.paper.reproduce import reproduce as reproduce_paper

    with compiling_announced(), Ticker("reproducing the paper") as ticker:
        reproduction = reproduce_paper(out, seed=seed, on_progress=ticker)
    if json_output:
        show_json(reproduction.to_dict())
    else:
        show(claims_view(reproduction.claims, reproduction.table, reproduction.files))
