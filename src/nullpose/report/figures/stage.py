"""What a figure of a scene has to show, from where it is seen, and how far it reaches."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from string import ascii_lowercase, ascii_uppercase

import numpy as np

from nullpose.antenna.harmonics import directions
from nullpose.physics import Pose
from nullpose.physics.types import FloatArray
from nullpose.report.geometry import outline_m
from nullpose.report.links import binding_nodes
from nullpose.report.numbers import capitalised, with_unit
from nullpose.scenario import Destination, Eavesdropper, Jammer, Node, NoFlyZone, Scenario, Terminal
from nullpose.solver import Result

# Lengths drawn, as shares of the scene's extent.
_MARGIN, _MARGIN_OF_ZONES = 0.12, 0.03  # free ground around the scene
_ROOFS = 0.5  # over drone and pattern, for roofs
_FAR = 3.0  # zones that reach farther from the scene's middle are left out
_LEAST_M = 1.0
_MOST_NUMBERS, _MOST_LETTERS = 4, 45  # nodes, and letters of all their names, with numbers beside them
_ZONE = "no-fly zone"
_SHORT, _LONG, _MOST_KEYS = 3, 8, 26  # letters of a name that is its own key, and of one that needs a key
AXIS = 1.5  # half-length of the antenna axis over the radius of the pattern


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """How a figure looks: its size, its camera, and lengths as shares of the scene's extent.

    Args:
        inches: width of each panel, height of the figure.
        elevation_deg: how high the camera stands.
        pattern: radius drawn where the gain is largest; a pattern has no size of its own.
        azimuth_deg: where the camera stands, from x (east) towards y (north).
        zoom: how much of its place a scene fills.
        is_small: whether a plan beside it has the names and the numbers of the axes on the ground.
    """

    inches: tuple[float, float]
    elevation_deg: float
    pattern: float
    azimuth_deg: float = -32.0
    zoom: float = 1.12
    is_small: bool = False

    @property
    def camera(self) -> FloatArray:
        """Direction towards the camera, shape ``(3,)``."""
        ring = directions(np.array([90.0 - self.elevation_deg]), np.array([self.azimuth_deg]))
        return np.asarray(ring[0, 0])


PANELS = View(inches=(4.6, 3.7), elevation_deg=20.0, pattern=0.15)
PAIR = View(inches=(4.8, 4.7), elevation_deg=38.0, pattern=0.11, zoom=0.97)
ALONE = View(inches=(6.6, 5.0), elevation_deg=38.0, pattern=0.11)


@dataclass(frozen=True, slots=True, kw_only=True)
class Stage:
    """What a figure has to show, and how.

    Args:
        scenario: the scene.
        poses: one for each panel; all show the same space.
        view: size, camera and lengths.
        uncertain: whether sets are drawn that jammers and eavesdroppers may be anywhere in.
        numbers: what each node gets, by its name.
        worst: nodes that get the least.
        note: how the nodes' names and numbers are to be read.
        key: what stands in the plan for names, of points (False) and of areas (True); empty for the names.
    """

    scenario: Scenario
    poses: tuple[Pose, ...]
    view: View
    uncertain: bool = False
    numbers: Mapping[str, str] = field(default_factory=dict)
    worst: frozenset[str] = frozenset()
    note: str = ""
    key: Mapping[tuple[bool, str], str] = field(default_factory=dict)

    @classmethod
    def of(cls, result: Result, view: View = ALONE, *, is_narrow: bool = False) -> Stage:
        """Set the stage of a result: with what each node gets, or of many with the names of the worst.

        Args:
            result: the result.
            view: size, camera and lengths.
            is_narrow: whether long names and those of many nodes are to stand in a key.
        """
        quantity, worst = result.objective.quantity, binding_nodes(result)
        numbers = {
            each.node: with_unit(quantity.in_unit(quantity.at(each)), quantity) for each in result.links
        }
        note = f"At nodes: {quantity.noun},\nthe smallest in bold"
        key = _key_of(result.scenario) if is_narrow else {}
        if key:
            note = f"Nodes with their {quantity.noun} in {quantity.unit}, the smallest in bold"
            numbers = {name: text.removesuffix(f" {quantity.unit}") for name, text in numbers.items()}
        elif len(numbers) > _MOST_NUMBERS or len("".join(numbers)) > _MOST_LETTERS:
            note = f"{capitalised(quantity.smallest)}: {numbers[min(worst)]},\nat nodes in bold"
            numbers = {}
        return cls(
            scenario=result.scenario,
            poses=(result.pose,),
            view=view,
            numbers=numbers,
            worst=worst,
            note=note,
            key=key,
        )

    @property
    def points(self) -> list[tuple[str, Node | Destination | Jammer | Eavesdropper]]:
        """All points with their kinds, those that a null is for before the nodes."""
        scene = self.scenario
        return [
            *(("jammer", point) for point in scene.jammers),
            *(("eavesdropper", point) for point in scene.eavesdroppers),
            *(("node", point) for point in scene.terminals),
        ]

    @property
    def keyed(self) -> list[tuple[str, str, str]]:
        """List the key: kind, name, and the words with what stands in the plan and the number."""
        nodes = [each for each in self.points if each[0] == "node"]
        others = [each for each in self.points if each[0] != "node"]
        zones = [(_ZONE, zone) for zone, _ in self.zones if zone is not None]
        words = []
        for kind, each in (*nodes, *others, *zones):
            parts = self.key[kind == _ZONE, each.name], each.name, self.numbers.get(each.name, "")
            words.append((kind, each.name, "  ".join(filter(None, dict.fromkeys(parts)))))
        return words

    @property
    def places_m(self) -> FloatArray:
        """All points and positions, (n, 3), metres."""
        return np.vstack([self.scenario.point_positions_m, *(pose.position_m for pose in self.poses)])

    @property
    def extent_m(self) -> float:
        """How wide the scene is, of which all drawn lengths are shares, metres."""
        return max(_LEAST_M, float(np.max(np.ptp(self.places_m[:, :2], axis=0))))

    @property
    def zones(self) -> list[tuple[NoFlyZone | None, FloatArray]]:
        """The fence (None) and the no-fly zones with their corners, those left out that reach far away."""
        airspace, places_m = self.scenario.airspace, self.places_m[:, :2]
        middle_m, far_m = 0.5 * (places_m.min(axis=0) + places_m.max(axis=0)), _FAR * self.extent_m
        fence = [] if airspace.geofence_m is None else [(None, airspace.geofence_outline_m)]
        outlines = [*((zone, outline_m(zone)) for zone in airspace.no_fly), *fence]
        return [outline for outline in outlines if np.all(np.abs(outline[1] - middle_m) <= far_m)]


def _key_of(scenario: Scenario) -> dict[tuple[bool, str], str]:
    """Number the nodes and letter other points and zones; empty if names have space, or a key has none."""
    nodes = [node.name for node in scenario.terminals]
    others = [each.name for points in (scenario.jammers, scenario.eavesdroppers) for each in points]
    zones = [zone.name for zone in scenario.airspace.no_fly]
    longest = max(map(len, (*nodes, *others)))
    if (len(nodes) <= _MOST_NUMBERS and longest <= _LONG) or len(nodes + others + zones) > _MOST_KEYS:
        return {}
    key = {(True, name): letter for name, letter in zip(zones, ascii_lowercase, strict=False)}
    if longest <= _SHORT:
        return key | {(False, name): name for name in nodes + others}
    key |= {(False, name): letter for name, letter in zip(others, ascii_uppercase, strict=False)}
    return key | {(False, name): f"{number}" for number, name in enumerate(nodes, start=1)}


def limits_m(stage: Stage) -> tuple[FloatArray, FloatArray]:
    """Compute the low and the high corner of the space drawn, each (3,), metres."""
    extent_m, points = stage.extent_m, stage.places_m
    hidden = [point for _, point in stage.points if not isinstance(point, Terminal) and stage.uncertain]
    points = np.vstack([points, *map(set_box_m, hidden)])
    positions = np.array([pose.position_m[:2] for pose in stage.poses])
    around = [(points[:, :2], _MARGIN), (positions, AXIS * stage.view.pattern)]  # the latter for the pattern
    around += [(corners_m, _MARGIN_OF_ZONES) for _, corners_m in stage.zones]
    low = np.min([places.min(axis=0) - share * extent_m for places, share in around], axis=0)
    high = np.max([places.max(axis=0) + share * extent_m for places, share in around], axis=0)
    top_m = max(pose.position_m[2] for pose in stage.poses) + 1.3 * stage.view.pattern * extent_m
    roofs_m = [
        min(max(top_m, each.heights_m[1]), top_m + _ROOFS * extent_m)
        for each in stage.scenario.buildings
        if np.all((each.outline_m.min(axis=0) < high) & (each.outline_m.max(axis=0) > low))
    ]
    return np.append(low, min(0.0, points[:, 2].min())), np.append(high, max(roofs_m, default=top_m))


def set_box_m(point: Jammer | Eavesdropper) -> FloatArray:
    """Compute the corners of the box around the set that a point may be anywhere in, ``(2, 3)``, metres."""
    half_m = np.linalg.norm(point.uncertainty_matrix_m, axis=1)
    return np.asarray(np.asarray(point.position_m) + np.stack([-half_m, half_m]))
