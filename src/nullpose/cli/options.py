"""The options, each declared once, and what is made of those that several verbs share."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from nullpose.scenario import Scenario


class CombiningName(StrEnum):
    """The ways to combine an array's elements, by name."""

    DIGITAL = "digital"
    ANALOGUE = "analogue"


class FigureWidth(StrEnum):
    """The widths of figures in print, by name."""

    COLUMN = "column"
    PAGE = "page"


class TableKind(StrEnum):
    """The ways to write a table, by name."""

    TEXT = "text"
    LATEX = "latex"


ScenarioFile = Annotated[
    Path, typer.Argument(metavar="FILE", help="Scenario file (TOML).", show_default=False)
]

AllowOutside = Annotated[
    bool,
    typer.Option("--allow-outside", help="Allow a file to name others outside its own folder (nodes_from)."),
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

Seed = Annotated[int, typer.Option("--seed", metavar="N", min=0, help="Seed of the random starts.")]

Gap = Annotated[
    float | None,
    typer.Option(
        "--gap",
        metavar="G",
        help="Relative gap between bound and value at which the proof stops.",
        show_default="1e-6 to 3 nodes, 1e-4 to 20, else 1e-3",
    ),
]

TimeLimit = Annotated[
    float, typer.Option("--time-limit", metavar="S", help="Seconds after which a proof stops.")
]

NodeLimit = Annotated[int, typer.Option("--node-limit", metavar="N", help="Boxes after which a proof stops.")]

Fast = Annotated[bool, typer.Option("--fast", help="Search only, more thoroughly, and prove nothing.")]

Robust = Annotated[
    bool,
    typer.Option("--robust", help="Maximise what is guaranteed under the errors that the scenario states."),
]

NullJammer = Annotated[
    str | None,
    typer.Option(
        "--null-jammer",
        metavar="NAME",
        help="Zero interference: the jammer to point the null at. Without it each is tried.",
        show_default=False,
    ),
]

CertificateFile = Annotated[
    Path | None,
    typer.Option(
        "--certificate",
        metavar="FILE",
        help="Write the proof here, for `nullpose verify`; compressed if the name ends in .gz.",
        show_default=False,
    ),
]

Verified = Annotated[
    bool, typer.Option("--verify", help="Check the proof in outward-rounded arithmetic, as `verify` does.")
]

GeoJsonFile = Annotated[
    Path | None,
    typer.Option(
        "--geojson",
        metavar="FILE",
        help="Write the pose, the nodes and the airspace here, for a map, as GeoJSON; needs an origin.",
        show_default=False,
    ),
]

Combining = Annotated[
    CombiningName | None,
    typer.Option(
        "--combining",
        help="With an [array]: weights for each node, or one beam for all.",
        show_default="digital",
    ),
]

FigureFile = Annotated[
    Path | None,
    typer.Option(
        "--figure",
        metavar="FILE",
        help="Draw what was found into a file named .png, .svg, .pdf or .pgf.",
        show_default=False,
    ),
]

Width = Annotated[
    FigureWidth | None,
    typer.Option(
        "--width",
        help="Size the figure for print: a column of 88 mm, or a page of 181 mm.",
        show_default="for a screen",
    ),
]

JsonOutput = Annotated[bool, typer.Option("--json", help="Print one JSON object instead of tables.")]

Table = Annotated[
    TableKind, typer.Option("--table", help="Print the table for a screen, or for a LaTeX document.")
]

OutFolder = Annotated[
    Path,
    typer.Option(
        "--out", metavar="DIR", help="Folder for the files; made if it is missing.", show_default=False
    ),
]


def solve_options(
    gap: float | None, time_limit: float, node_limit: int, fast: bool, seed: int
) -> dict[str, Any]:
    """Return the options of a solve as the solver takes them.

    Args:
        gap: relative gap asked for, or None.
        time_limit: seconds after which a proof stops.
        node_limit: boxes after which it stops.
        fast: whether nothing is to be proved.
        seed: of the searches.
    """
    return {
        "gap": gap,
        "time_limit_s": time_limit,
        "node_limit": node_limit,
        "certify": not fast,
        "seed": seed,
    }


def read_scenario(file: Path, overrides: list[str] | None, allow_outside: bool) -> Scenario:
    """Return the scenario of a file with some of its values changed; warn of what looks like a mistake.

    Args:
        file: TOML.
        overrides: changes as ``PATH=VALUE``, or None.
        allow_outside: whether it may name files outside its folder.

    Raises:
        ScenarioError: with every fault of the file or of the changes.
    """
    from nullpose.scenario import apply_overrides, doubts, load

    scenario = apply_overrides(load(file, allow_outside=allow_outside), overrides or [])
    for doubt in doubts(scenario):
        typer.echo(f"warning: {doubt}", err=True)
    return scenario


def refuse(where: str, **given: object) -> None:
    """Raise a UsageError if an option was given where it has no meaning.

    Args:
        where: the case that has no such option, as in "with --robust".
        given: the options by their names, false or None where not given.

    Raises:
        UsageError: one of them was.
    """
    from nullpose.errors import UsageError

    for name, value in given.items():
        if value:
            option = name.replace("_", "-")
            raise UsageError(f"--{option}: given {where}, which has none; leave out one of the two")
