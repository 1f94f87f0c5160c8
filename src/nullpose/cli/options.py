"""The options, each declared once, and what is made of those that several verbs share."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields, is_dataclass
from enum import StrEnum
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from nullpose.cli.printing import say

if TYPE_CHECKING:
    from nullpose.scenario import Scenario
    from nullpose.solver import ErrorSizes, SolveKeywords


class FigureWidth(StrEnum):
    """The widths of figures in print, by name."""

    COLUMN = "column"
    PAGE = "page"
    COLUMN_SERIF = "column-serif"
    PAGE_SERIF = "page-serif"


REACH = 0.99  # of the omnidirectional value; :data:`nullpose.study.case.SHARE`, too slow to import for help
MOUNTS = "0,45,90"  # degrees; the mounts that are looked at unless others are stated

ScenarioFile = Annotated[
    Path, typer.Argument(metavar="FILE", help="Scenario file (TOML).", show_default=False)
]

AllowOutside = Annotated[
    bool,
    typer.Option("--allow-outside", help="Allow the scenario to read files of other folders (nodes_from)."),
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

At = Annotated[
    float | None,
    typer.Option(
        "--at",
        metavar="SECONDS",
        help="Of a scene in motion: the instant that counts.",
        show_default="0, if anything moves",
    ),
]

Seed = Annotated[int, typer.Option("--seed", metavar="N", min=0, help="Seed of the random starts.")]

TimeLimit = Annotated[
    float | None,
    typer.Option(
        "--time-limit",
        metavar="S",
        help="Stop each proof after S seconds.",
        show_default="60, and the time in which kernels are compiled",
    ),
]

Fast = Annotated[bool, typer.Option("--fast", help="No proof, only a search from more starts.")]

Off = Annotated[
    str | None,
    typer.Option(
        "--off",
        metavar="ERRORS",
        help="The largest errors of the table If things are off, as in attitude_deg=2,position_m=3,"
        "jammers_m=200, and of a robust solve if the scenario states none.",
        show_default="attitude_deg=1,position_m=1,jammers_m=10",
    ),
]

FigureFiles = Annotated[
    list[Path] | None,
    typer.Option(
        "--figure",
        metavar="FILE",
        help="Write a figure to FILE: .png, .svg or .pdf. Can be repeated.",
        show_default=False,
    ),
]

Width = Annotated[
    FigureWidth | None,
    typer.Option(
        "--width",
        help="Size of the figure in print: a column (88 mm) or a page (181 mm), perhaps in serif letters.",
        show_default="a size for screens",
    ),
]

JsonOutput = Annotated[bool, typer.Option("--json", help="Print one JSON object instead of tables.")]

OutFolder = Annotated[
    Path,
    typer.Option(
        "--out", metavar="DIR", help="Folder for the files. It is created if necessary.", show_default=False
    ),
]


@dataclass(frozen=True, kw_only=True)
class SceneOptions:
    """The scenario file of a verb, and how it is read."""

    file: ScenarioFile
    overrides: Overrides = None
    allow_outside: AllowOutside = False
    at_s: At = None

    def read(self, in_motion: bool = False) -> Scenario:
        """Read the scenario with its values changed, still at an instant; warn of what looks like a mistake.

        Args:
            in_motion: whether all instants are asked for, and not one.

        Raises:
            ScenarioError: with every fault of the file or of the changes.
            UsageError: the instant is not in the scene.
        """
        from nullpose.scenario import doubts, load

        scenario = load(
            self.file,
            allow_outside=self.allow_outside,
            overrides=self.overrides or [],
            on_note=lambda note: say(note, err=True),
        )
        for warning in doubts(scenario):
            say(f"warning: {warning}", err=True)
        if in_motion:
            refuse("with --hover", at=self.at_s is not None)
        return scenario if in_motion else scenario.still(self.at_s)

    def check_outputs(self, outputs: Iterable[tuple[str, Path | None]]) -> None:
        """Make sure, before any work, that outputs can be written and take no input's place.

        Raises:
            OutputError: an output is an input or another output too, or it or its folder cannot be written.
        """
        from nullpose.files import check_outputs
        from nullpose.scenario.loading import files_of

        check_outputs(files_of(self.file, self.overrides or ()), outputs)


@dataclass(frozen=True, kw_only=True)
class ProofOptions:
    """The options of every verb that proves."""

    gap: Annotated[
        float | None,
        typer.Option(
            "--gap",
            metavar="G",
            help="Stop the proof at this relative gap: (bound - value) / value, as power ratios.",
            show_default="1e-6 for 1 to 3 nodes, 1e-4 for 4 to 20, 1e-3 for more",
        ),
    ] = None
    time_limit: TimeLimit = None
    node_limit: Annotated[
        int, typer.Option("--node-limit", metavar="N", help="Stop each proof after N branch-and-bound boxes.")
    ] = 10**9
    seed: Seed = 0

    def keywords(self, fast: bool = False) -> SolveKeywords:
        """Name the options as the solver takes them."""
        return {
            **({} if self.time_limit is None else {"time_limit_s": self.time_limit}),
            "gap": self.gap,
            "node_limit": self.node_limit,
            "certify": not fast,
            "seed": self.seed,
        }


def expanded(verb: Callable[..., None]) -> Callable[..., None]:
    """Give a verb the options of each group that it takes, one by one, as Typer reads them."""
    groups: dict[str, Any] = {}
    parameters: list[Parameter] = []
    for name, parameter in signature(verb, eval_str=True).parameters.items():
        members = [parameter]
        if is_dataclass(parameter.annotation):
            groups[name] = parameter.annotation
            members = list(signature(groups[name], eval_str=True).parameters.values())
        parameters += [member.replace(kind=Parameter.KEYWORD_ONLY) for member in members]

    def run(**values: object) -> None:
        for name, group in groups.items():
            values[name] = group(**{member.name: values.pop(member.name) for member in fields(group)})
        verb(**values)

    run.__name__, run.__doc__ = verb.__name__, verb.__doc__
    run.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    run.__dict__["__signature__"] = Signature(parameters)
    return run


def error_sizes(text: str | None) -> ErrorSizes:
    """Read the largest errors from a text such as ``attitude_deg=2,jammers_m=200``.

    Those left out have their default; None leaves out all.

    Raises:
        UsageError: an unknown name, or no number.
    """
    from nullpose.errors import require_usage
    from nullpose.solver.sensitivity import ErrorSizes

    names, sizes = [field.name for field in fields(ErrorSizes)], dict[str, float]()
    allowed = f"{', '.join(names)}, each once with a number, as in attitude_deg=2,jammers_m=200"
    for part in [] if text is None else text.split(","):
        name, _, number = part.strip().replace("eavesdroppers_m", "jammers_m").partition("=")
        is_one = name in names and name not in sizes
        require_usage(is_one, f"--off: given {part.strip()!r}; allowed: {allowed}")
        sizes |= zip([name], numbers_of(f"--off {name}", number, allowed, 1), strict=True)
    return ErrorSizes(**sizes)


def mounts_of(text: str) -> tuple[float, ...]:
    """Read mounts such as ``0,45,90``, or none from ``best``.

    Raises:
        UsageError: it is neither.
    """
    allowed = "angles in degrees from 0 to 90, as in 0,45,90, or best"
    return () if text.strip() == "best" else tuple(numbers_of("--mount", text, allowed))


def numbers_of(option: str, text: str, allowed: str, count: int | None = None) -> list[float]:
    """Read finite numbers that are separated by commas, so many if a count is stated.

    Raises:
        UsageError: they are not.
    """
    from nullpose.errors import require_usage

    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    require_usage(
        numbers and all(map(math.isfinite, numbers)) and count in (None, len(numbers)),
        f"{option}: given {text!r}; allowed: {allowed}",
    )
    return numbers


def refuse(where: str, **options: object) -> None:
    """Refuse options where they have no meaning, as in "with --robust"; a false value is not given.

    Raises:
        UsageError: one of them was.
    """
    from nullpose.errors import UsageError

    for option in [name.replace("_", "-") for name, value in options.items() if value]:
        raise UsageError(f"--{option}: given {where}, which has none; leave out one of the two")
