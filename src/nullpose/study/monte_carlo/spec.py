"""The spec of a study: which scenes are drawn, what is solved in each, and what is swept."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from itertools import product
from typing import Annotated

from pydantic import Field
from pydantic_core import PydanticCustomError

from nullpose.errors import UsageError
from nullpose.files import PlainTable
from nullpose.problem.schemes import Scheme
from nullpose.scenario.crosscheck import shared_names
from nullpose.scenario.faults import (
    Place,
    collected,
    described,
    path_of,
    plain,
    rejection,
    require_value,
    unknown,
)
from nullpose.scenario.origin import DRAWN_LISTS
from nullpose.scenario.rules import Choice, Count, Limits, Rule, list_of_tables
from nullpose.scenario.section import Section, optional
from nullpose.scenario.units import Title
from nullpose.study.case import Case, Gap, NodeLimit, Seconds
from nullpose.study.monte_carlo.blocks import Blocks
from nullpose.study.monte_carlo.distribution import DrawnChannel
from nullpose.study.monte_carlo.layout import Eavesdroppers, Jammers, Nodes, Points
from nullpose.study.monte_carlo.scene import SceneBase
from nullpose.study.sweep import spaced

MOST_POINTS = 1_000_000  # combinations of swept values

_DEEPEST = 16  # parts of a path: no value of a scene is deeper
_VALUE = Limits("a number", -1e30, 1e30, "in the unit that the path ends in")
_SPACING = Choice("a spacing", ("linear", "log"))
_KEYS: dict[str, Rule] = {
    "from": _VALUE,
    "to": _VALUE,
    "points": Count("a number of values", 2, 100_000, "both ends included"),
    "spacing": _SPACING,
}

Axis = tuple[str, tuple[float, ...]]


class _SweptValues(Rule):
    """Swept values by path."""

    def read(self, value: object) -> tuple[Axis, ...]:
        value = dict(value) if isinstance(value, tuple) else value
        if not isinstance(value, Mapping):
            raise rejection(f"got {described(value)}, must be a table headed [sweep]")
        axes: list[Axis] = []
        faults: list[tuple[Place, str]] = []
        for path, raw in _paths(value):
            try:
                axes.append((path, _values(plain(raw))))
            except (PydanticCustomError, UsageError) as error:
                faults.append(((path,), str(error).replace("\n  ", "; ")))
        if faults:
            raise collected("sweep", faults)
        size = math.prod(len(values) for _, values in axes)
        require_value(
            size <= MOST_POINTS,
            f"the grid has {size} combinations of values, at most {MOST_POINTS} are allowed",
        )
        return tuple(axes)


SweepAxes = Annotated[tuple[Axis, ...], _SweptValues()]  # paths, each with the values that it is set to


def _paths(table: Mapping[object, object], at: Place = ()) -> Iterator[tuple[str, object]]:
    """Yield each path with its values; one without quotes has come as tables within tables."""
    for key, raw in table.items():
        if isinstance(raw, Mapping) and raw and not set(raw) & set(_KEYS) and len(at) < _DEEPEST:
            yield from _paths(raw, (*at, str(key)))
        else:
            yield (path_of((*at, str(key))) if at else str(key)), raw


def _values(raw: object) -> tuple[float, ...]:
    """Return the values that a list or a table of from, to, points and spacing states."""
    if isinstance(raw, list | tuple) and len(raw) > 0:
        values = tuple(_VALUE.read(value) for value in raw)
        require_value(len(set(values)) == len(values), "a value is given twice; keep one")
        return values
    if not isinstance(raw, Mapping):
        raise rejection(
            f"got {described(raw)}, must be a list of numbers or a table such as "
            '{ from = 0.1, to = 100, points = 4, spacing = "log" }'
        )
    for key in [each for each in raw if each not in _KEYS]:
        raise rejection(f"{key}: {unknown('key', str(key), _KEYS)}")
    missing = [key for key in ("from", "to", "points") if key not in raw]
    require_value(
        not missing, f"{', '.join(missing)} missing; a table here has from, to, points and perhaps spacing"
    )
    start, stop, points, spacing = (rule.read(raw.get(key, "linear")) for key, rule in _KEYS.items())
    return spaced(start, stop, points, log=spacing == "log")


MOST_SCENES = 999_999_999  # their numbers have nine digits in the names of parts


class StudySpec(Section, header="a table with the keys of a study's spec"):
    """Everything that decides the rows of a study.

    Args:
        name: a title.
        seed: of every draw, together with a scene's number.
        scenes: how many.
        gap: relative gap at which a proof is done; None for one by the number of nodes.
        time_limit_s: seconds after which a proof stops.
        node_limit: boxes after which a proof stops; None for the solver's own.
        scene: what is the same in all scenes.
        nodes, jammers, eavesdroppers, buildings: how they are drawn; None for those of the scene.
        cases: what is solved in every scene.
        sweep: paths and the values that they are set to.

    Raises:
        ScenarioError: with every fault of the values together.
    """

    name: Title = Field(default="", description="Title of the study.", examples=["Do we need to tilt?"])
    seed: Annotated[int, Count("a seed", 0, 1e15, "any whole number; another one gives other scenes")] = (
        Field(default=0, description="Seed of every draw: scene i is the same for equal seeds.", examples=[1])
    )
    scenes: (
        Annotated[int, Count("a number of scenes", 1, MOST_SCENES, "each is solved in every case")] | None
    ) = optional("Number of scenes. Left out with files: one for each.", 2000)
    gap: Gap | None = optional(
        "Relative gap between bound and value at which a proof is done. Left out: by the number "
        "of nodes, 1e-6 to 3, 1e-4 to 20, else 1e-3.",
        1e-3,
    )
    time_limit_s: Seconds = Field(
        default=60.0, description="Seconds after which a proof stops, its gap not reached.", examples=[10.0]
    )
    node_limit: NodeLimit | None = optional(
        "Boxes after which a proof stops; unlike time, the same on every machine.", 1_000_000
    )
    scene: SceneBase = Field(
        description="A table headed [scene]: what is the same in all scenes, a file or tables."
    )
    nodes: Nodes | None = optional(
        "A table headed [nodes]: how they are drawn. Left out: those of the scene."
    )
    jammers: Jammers | None = optional(
        "A table headed [jammers]: how they are drawn. Left out: those of the scene."
    )
    eavesdroppers: Eavesdroppers | None = optional(
        "A table headed [eavesdroppers]: how they are drawn. Left out: those of the scene."
    )
    buildings: Blocks | None = optional(
        "A table headed [buildings]: how they are drawn. Left out: those of the scene."
    )
    cases: Annotated[tuple[Case, ...], list_of_tables("cases", fewest=1)] = Field(
        default=(Case(name=Scheme.OPTIMUM.value),),
        description="Tables headed [[cases]], one for each thing that is solved in every scene. Left out: "
        "the best pose with the scene's own vehicle.",
    )
    sweep: SweepAxes = Field(
        default=(),
        description="A table headed [sweep]: paths, each with a list of values or from, to, points and "
        "spacing. Several make a grid.",
        examples=[{"jammers.M.power_w": [0.1, 1.0, 10.0]}],
    )

    def faults(self, raw: Mapping[str, object]) -> Iterable[tuple[Place, str]]:
        """Yield the faults between the parts of the spec, those that are None being at fault."""
        if self.scenes is None and self.scene is not None and not self.scene.files:
            yield ("scenes",), "missing; it must be given: how many scenes"
        yield from shared_names(
            {("cases", index): case for index, case in enumerate(self.cases or ()) if case is not None}
        )
        for key in ("x_m", "y_m") if self.buildings and not any(map(raw.get, DRAWN_LISTS)) else ():
            if getattr(self.buildings, key) is None:
                yield ("buildings", key), "missing; no points are drawn around which they could stand; add it"
        for index, (kind, points) in product(
            range(self.scene.size if self.scene else 0),
            [(kind, each) for kind, each in self.drawn.items() if isinstance(each, Points)],
        ):
            whole = self.scene.whole(index)
            if points.motion and whole.time is None:
                yield (
                    (kind, "motion"),
                    "given, but the scene has no [time]; add a table headed [scene.time] with duration_s and "
                    "step_s, or [time] to the scenario file",
                )
            replaced = filter(None, getattr(whole, kind))
            for key, values in points.values(list(replaced)).items():
                if len(values) > 1:
                    remedy = "add it" if key in type(points).model_fields else "give all of them the same"
                    yield (
                        (kind, key),
                        f"missing, and the scene's {kind}, which are to be replaced, differ: "
                        f"{values[0]!r} and {values[1]!r}; {remedy}",
                    )

    def to_dict(self) -> PlainTable:
        """Write plain numbers, texts, lists and tables, ready for JSON; keys left out stay out."""
        values = super().to_dict()
        values["sweep"] = {path: list(numbers) for path, numbers in self.sweep}
        return values

    @property
    def n_scenes(self) -> int:
        """How many scenes there are, stated or by the number of files."""
        return self.scene.size if self.scenes is None else self.scenes

    @cached_property
    def points(self) -> tuple[dict[str, float], ...]:
        """The combinations of swept values by path, the last varying fastest; one empty if none is swept."""
        return tuple(
            dict(zip(self.swept, values, strict=True))
            for values in product(*(values for _, values in self.sweep))
        )

    @property
    def swept(self) -> tuple[str, ...]:
        """The paths that are swept."""
        return tuple(path for path, _ in self.sweep)

    @property
    def case_names(self) -> tuple[str, ...]:
        """Names of the cases, in order."""
        return tuple(case.name for case in self.cases)

    @property
    def drawn(self) -> dict[str, Points | DrawnChannel | Blocks]:
        """What is drawn, by the key of a scenario, in the order in which it is drawn."""
        tables = {kind: getattr(self, kind) for kind in DRAWN_LISTS}
        tables |= {"channel": self.scene and self.scene.channel, "buildings": self.buildings}
        return {
            kind: each for kind, each in tables.items() if isinstance(each, Points | DrawnChannel | Blocks)
        }

    @cached_property
    def digest(self) -> str:
        """SHA-256 of all that decides a row; titles and the names of files are left out."""
        values = self.to_dict() | {"name": "", "scenes": self.n_scenes}
        for key in ("file", "files"):
            values["scene"].pop(key, None)
        for case in [each for each in values["cases"] if "mount_scenes" in each]:
            case["airframe"].pop("mount_deg", None)  # the scenes choose it, so it follows from the rest
        return hashlib.sha256(json.dumps(values, sort_keys=True, separators=(",", ":")).encode()).hexdigest()
