"""Options that several verbs share."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

__all__ = [
    "AllowOutside",
    "CombiningName",
    "Fast",
    "Gap",
    "JsonOutput",
    "NodeLimit",
    "OutFolder",
    "Overrides",
    "ScenarioFile",
    "Seed",
    "TimeLimit",
]


class CombiningName(StrEnum):
    """The ways to combine an array's elements, by name."""

    DIGITAL = "digital"
    ANALOGUE = "analogue"


ScenarioFile = Annotated[
    Path, typer.Argument(metavar="FILE", help="Scenario file (TOML).", show_default=False)
]

AllowOutside = Annotated[
    bool,
    typer.Option("--allow-outside", help="Let a file name others outside its folder, as by nodes_from."),
]

Overrides = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="PATH=VALUE",
        help="Change one value of the scenario, as in jammers.M.power_w=10. Can be repeated.",
        show_default=False,
    ),
]

Seed = Annotated[int, typer.Option("--seed", min=0, help="Seed of the random starts.")]

Gap = Annotated[
    float | None,
    typer.Option(
        "--gap",
        metavar="G",
        help="Relative gap between bound and value at which the proof is done.",
        show_default="1e-6 to 3 nodes, 1e-4 to 20, else 1e-3",
    ),
]

TimeLimit = Annotated[
    float, typer.Option("--time-limit", metavar="S", help="Seconds after which a proof stops.")
]

NodeLimit = Annotated[int, typer.Option("--node-limit", metavar="N", help="Boxes after which a proof stops.")]

Fast = Annotated[bool, typer.Option("--fast", help="Search only, more thoroughly, and prove nothing.")]

JsonOutput = Annotated[bool, typer.Option("--json", help="Print one JSON object instead of tables.")]

OutFolder = Annotated[
    Path,
    typer.Option(
        "--out", metavar="DIR", help="Folder for the files; made if it is missing.", show_default=False
    ),
]
