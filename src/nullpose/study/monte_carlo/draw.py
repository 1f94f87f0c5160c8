"""From a study's spec and a number to a scene: the same everywhere, whatever else is drawn."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import cache
from types import MappingProxyType

import numpy as np

from nullpose.errors import ScenarioError, require_number
from nullpose.files import PlainTable
from nullpose.objectives import RECORDS, Quantity
from nullpose.physics.types import FloatArray
from nullpose.scenario import Override, Scenario, apply_overrides
from nullpose.scenario.faults import refusal, require
from nullpose.scenario.ground_points import GroundPoint
from nullpose.scenario.motion import places_m
from nullpose.scenario.origin import DRAWN_LISTS, POINT_LISTS
from nullpose.study.monte_carlo.blocks import Blocks, Town
from nullpose.study.monte_carlo.distribution import Distribution, DrawnChannel
from nullpose.study.monte_carlo.layout import MOST_POINTS, Points
from nullpose.study.monte_carlo.motion import drawn_motions
from nullpose.study.monte_carlo.spec import StudySpec

_Tables = Mapping[str, Points | DrawnChannel | Blocks]
_Swept = tuple[_Tables, list[tuple[str, float]]]  # what is drawn, and what is set after that

MOST_DRAWS = 100  # how often one kind is drawn before its scene is given up

_TRIED = 5  # scenes that tell what is maximised: one that cannot be drawn tells nothing

# The streams of chance. Their numbers are part of what a seed means: never change one.
_KINDS = {kind: number for number, kind in enumerate((*DRAWN_LISTS, "channel", "buildings"))}
_STREAMS = {
    "count": 0,
    "parents": 1,
    "place": 2,
    "height_m": 3,
    "power_w": 4,
    "power_dbm": 4,
    "weight": 5,
    "min_sinr_db": 5,
    "uncertainty_m": 6,
    "exponent": 7,
    "reference_distance_m": 8,
    "environment": 9,
    "a": 10,
    "b": 11,
    "los_loss_db": 12,
    "nlos_loss_db": 13,
    "blocked_loss_db": 14,
    "shadow_margin_m": 15,
    "waypoints": 16,
    "speed_m_s": 17,
    "direction_deg": 18,
    "pause_s": 19,
}


def draw_scene(spec: StudySpec, index: int) -> Scenario:
    """Return a scene before anything is swept.

    Every draw depends on the study's seed, the scene's number and what is drawn, and on nothing else: other
    jammers leave the nodes as they are, other powers the places, and more scenes the earlier ones.

    Args:
        spec: the study.
        index: the scene's number, from 0.

    Raises:
        UsageError: there is no such scene.
        ScenarioError: no valid scene was drawn.
    """
    return Draws(spec).base(require_number("scene", index, 0, spec.n_scenes - 1))


def scene_at(spec: StudySpec, index: int, point: int) -> Scenario:
    """Return a scene at one combination of swept values.

    Args:
        spec: the study.
        index: the scene's number, from 0.
        point: the combination's number, from 0.

    Raises:
        UsageError: there is no such scene or combination.
        ScenarioError: no valid scene was drawn, or a swept value makes it invalid.
    """
    return Draws(spec).at(
        require_number("scene", index, 0, spec.n_scenes - 1),
        require_number("point", point, 0, len(spec.points) - 1),
    )


def quantity_of(spec: StudySpec) -> Quantity:
    """Choose the quantity that a study maximises: the margin, if the nodes of any scene have one.

    Args:
        spec: the study.
    """
    draws, found = Draws(spec), set[Quantity]()
    for index in range(min(spec.n_scenes, max(spec.scene.size, _TRIED))):
        with suppress(ScenarioError):  # a scene that cannot be drawn has rows that say so
            found.add(Quantity.of(draws.at(index, 0)))
    quantities = [quantity for record in RECORDS.values() for quantity in record.quantities]
    return max(found or quantities[:1], key=quantities.index)


class Draws:
    """The scenes of a study; the one drawn last is kept, since it is asked for at every swept value.

    Args:
        spec: the study.
    """

    def __init__(self, spec: StudySpec) -> None:
        self._spec = spec
        self._swept = cache(lambda point: _of_point(spec, spec.points[point]))
        self._last: tuple[int, _Tables, Scenario] | None = None

    def base(self, index: int, values: Mapping[str, float] = MappingProxyType({})) -> Scenario:
        """Return a scene before anything is swept, or with some values set.

        Args:
            index: the scene's number, from 0.
            values: by path.
        """
        return self._set(index, _of_point(self._spec, values))

    def at(self, index: int, point: int) -> Scenario:
        """Return a scene at one combination of swept values.

        Args:
            index: the scene's number, from 0.
            point: the combination's number, from 0.
        """
        return self._set(index, self._swept(point))

    def _set(self, index: int, swept: _Swept) -> Scenario:
        drawn, settings = swept
        if self._last is None or self._last[:2] != (index, drawn):
            self._last = index, drawn, _scene(self._spec, index, drawn)
        scene = self._last[2]
        overrides = [each for path, value in settings for each in _settings(scene, path, value)]
        return apply_overrides(scene, overrides) if overrides else scene


def _of_point(spec: StudySpec, values: Mapping[str, float]) -> _Swept:
    """Split a combination of swept values into the keys of what is drawn and settings of the scene.

    A path may mean a key of what draws, as in ``nodes.count``, or one of a scene.
    """
    drawn, settings = spec.drawn, []
    for path, value in values.items():
        kind, _, key = path.partition(".")
        if kind in drawn and key in type(drawn[kind]).model_fields:
            # The key that states the same in another unit is dropped.
            others = {other for ways in drawn[kind].ways for other in ways.others(key)}
            drawn[kind] = drawn[kind].model_copy(update={**dict.fromkeys(others), key: value})
        else:
            settings.append((path, value))
    return drawn, settings


def _settings(scene: Scenario, path: str, value: float) -> list[Override]:
    """Return the overrides of a path; one for each point where it names all of a kind by a star."""
    kind, star, rest = path.partition(".*.")
    if not star or kind not in POINT_LISTS:
        return [Override(path, value)]
    return [Override(f"{kind}[{place}].{rest}", value) for place in range(len(getattr(scene, kind)))]


def _scene(spec: StudySpec, index: int, drawn: _Tables) -> Scenario:
    """Return a scene, drawing again what makes it invalid."""
    kept, attempts = spec.scene.kept(index, drawn), dict.fromkeys(drawn, 0)
    values = {kind: _draw(spec, index, kind, drawn, 0) for kind in drawn}
    while True:
        try:
            return _scene_of({**kept, "name": f"scene {index}", **values})
        except ScenarioError as error:
            # The kind to draw again: the last that a fault is about, or else the least often drawn.
            blamed = [kind for kind in attempts if any(each.path.startswith(kind) for each in error.faults)]
            rarest = min(attempts, key=lambda kind: attempts[kind], default=None)
            if (again := blamed[-1] if blamed else rarest) is None or attempts[again] + 1 >= MOST_DRAWS:
                if not any(attempts.values()):
                    raise
                fault = error.faults[0]
                raise refusal(fault.path, f"{fault.message} (after {MOST_DRAWS} draws)") from None
            attempts[again] += 1
            values[again] = _draw(spec, index, again, drawn, attempts[again])


def _scene_of(values: PlainTable) -> Scenario:
    """Validate a scene; a drawn block on which a ground point ever stands is left out."""
    if not isinstance(town := values.get("buildings"), Town):
        return Scenario.from_dict(values)
    scene = Scenario.from_dict(values | {"buildings": ()})
    times_s = scene.time.instants_s if scene.time else [0.0]
    passed_m = [places_m(point, scene.origin, times_s) for point in scene.points]
    return scene.model_copy(update={"buildings": town.around(np.concatenate(passed_m))})


def _draw(spec: StudySpec, index: int, kind: str, drawn: _Tables, attempt: int) -> object:
    """Draw what a key of a scene holds, as plain data; blocks before any is left out."""

    def chance(stream: str) -> np.random.Generator:
        key = (index, _KINDS[kind], _STREAMS[stream], attempt)
        return np.random.Generator(np.random.PCG64(np.random.SeedSequence(spec.seed, spawn_key=key)))

    if isinstance(what := drawn[kind], DrawnChannel):
        return what.draw(chance)
    if isinstance(what, Blocks):
        return what.draw(chance, [each.extent_m for each in drawn.values() if isinstance(each, Points)])
    scene = spec.scene.whole(index)
    return _points(what, getattr(scene, kind), scene.time.duration_s if scene.time else 0.0, chance)


def _points(
    points: Points,
    replaced: Sequence[GroundPoint],
    duration_s: float,
    chance: Callable[[str], np.random.Generator],
) -> list[PlainTable]:
    """Draw the points of one kind as plain data, with what they keep of those that they replace."""
    plane_m = _places(points, chance)
    count = len(plane_m)
    columns = {
        key: value.draw(chance(key), count).tolist() if isinstance(value, Distribution) else [value] * count
        for key, (value, *_) in points.values(replaced).items()
    }
    columns["position_m"] = np.column_stack([plane_m, columns.pop("height_m")]).tolist()
    columns |= drawn_motions(points, columns["position_m"], duration_s, chance)
    columns["name"] = points.names(count)
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def _places(points: Points, chance: Callable[[str], np.random.Generator]) -> FloatArray:
    """Return positions seen from above [m], (n, 2)."""
    counting, placing = chance("count"), chance("place")
    if points.layout == "poisson":
        round_m2 = math.pi * (points.radius_m or 0.0) ** 2
        mean = (points.density_per_m2 or 0.0) * (round_m2 or float(np.prod(np.diff(points.extent_m))))
        return points.evenly_m(placing, int(counting.poisson(_bounded(points, mean))))
    if points.layout != "clusters":
        return points.evenly_m(placing, _between(counting, points.count))
    centres_m = points.evenly_m(chance("parents"), _between(counting, points.parents))
    sizes = [_between(counting, points.count) for _ in centres_m]
    total = int(_bounded(points, sum(sizes)))
    around_m = (points.spread_m or 0.0) * placing.standard_normal((total, 2))
    return np.asarray(np.repeat(centres_m, sizes, axis=0) + around_m)


def _bounded(points: Points, count: float) -> float:
    """Return a number of points, unless it is more than a scene may have."""
    require(
        count <= MOST_POINTS,
        type(points).__name__.lower(),
        f"layout {points.layout} means {count:g} points, at most {MOST_POINTS} are allowed",
    )
    return count


def _between(counting: np.random.Generator, ends: tuple[int, int] | None) -> int:
    return int(counting.integers(*(ends or (0, 0)), endpoint=True))
