"""What a figure of a scene has to show, and how far it reaches."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from string import ascii_lowercase, ascii_uppercase

import numpy as np

from nullpose.physics import Pose
from nullpose.physics.types import FloatArray
from nullpose.report.geometry import outline_m
from nullpose.report.links import binding_nodes
from nullpose.report.numbers import capitalised, with_unit
from nullpose.scenario import Destination, Eavesdropper, Jammer, Node, NoFlyZone, Scenario, Terminal
from nullpose.solver import Result

# Lengths drawn, as shares of the scene's extent.
_MARGIN, _MARGIN_OF_ZONES = 0.12, 0.03  # free ground around the scene
_FAR = 3.0  # zones that reach farther from the scene's middle are left out
_LEAST_M = 1.0
_MOST_NUMBERS, _MOST_LETTERS = 4, 45  # nodes, and letters of all their names, with numbers beside them
_ZONE = "no-fly zone"
_SHORT, _LONG, _MOST_KEYS = 3, 8, 26  # letters of a name that is its own key, and of one that needs a key


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanScene:
    """What a figure has to show.

    Args:
        scenario: the scene.
        poses: one for each panel; all show the same space.
        axis: half-length drawn of the antenna's axis, as a share of the scene's extent.
        uncertain: whether sets are drawn that jammers and eavesdroppers may be anywhere in.
        numbers: what each node gets, by its name.
        worst: nodes that get the least.
        note: how the nodes' names and numbers are to be read.
        key: what stands in the plan for names, of points (False) and of areas (True); empty for the names.
    """

    scenario: Scenario
    poses: tuple[Pose, ...]
    axis: float = 0.165
    uncertain: bool = False
    numbers: Mapping[str, str] = field(default_factory=dict)
    worst: frozenset[str] = frozenset()
    note: str = ""
    key: Mapping[tuple[bool, str], str] = field(default_factory=dict)

    @classmethod
    def of(cls, result: Result, *, is_narrow: bool = False) -> PlanScene:
        """Set the scene of a result: with what each node gets, or of many with the names of the worst.

        Args:
            result: the result.
            is_narrow: whether long names and those of many nodes are to stand in a key.
        """
        quantity, worst = result.objective.quantity, binding_nodes(result)
        numbers = {
            each.node: with_unit(quantity.in_unit(quantity.at(each)), quantity) for each in result.links
        }
        bold = ", the smallest in bold" if worst else ""
        note = f"At nodes: {quantity.noun}{bold}"
        key = _key_of(result.scenario) if is_narrow else {}
        if key:
            note = f"Nodes with their {quantity.noun} in {quantity.unit}{bold}"
            numbers = {name: text.removesuffix(f" {quantity.unit}") for name, text in numbers.items()}
        elif len(numbers) > _MOST_NUMBERS or len("".join(numbers)) > _MOST_LETTERS:
            value = with_unit(quantity.in_unit(result.objective.value), quantity)
            note = f"{capitalised(quantity.smallest)}: {value}{', at nodes in bold' if worst else ''}"
            numbers = {}
        return cls(
            scenario=result.scenario,
            poses=(result.pose,),
            numbers=numbers,
            worst=worst,
            note=note,
            key=key,
        )

    @property
    def points(self) -> list[tuple[str, Node | Destination | Jammer | Eavesdropper]]:
        """All points with their kinds, those that a null is for before the nodes."""
        return [
            *(("jammer", point) for point in self.scenario.jammers),
            *(("eavesdropper", point) for point in self.scenario.eavesdroppers),
            *(("node", point) for point in self.scenario.terminals),
        ]

    @property
    def keyed(self) -> list[tuple[str, str, str]]:
        """List the key: kind, name, and the words with what stands in the plan and the number."""
        rows: list[tuple[str, Node | Destination | Jammer | Eavesdropper | NoFlyZone]] = [
            *sorted(self.points, key=lambda row: row[0] != "node"),
            *((_ZONE, zone) for zone, _ in self.zones if zone is not None),
        ]
        parts = [(self.key[kind == _ZONE, it.name], it.name, self.numbers.get(it.name)) for kind, it in rows]
        words = ("  ".join(dict.fromkeys(filter(None, each))) for each in parts)
        return [(kind, it.name, text) for (kind, it), text in zip(rows, words, strict=True)]

    @property
    def places_m(self) -> FloatArray:
        """All points and positions from above, (n, 2), metres."""
        return np.vstack([self.scenario.point_positions_m, *(pose.position_m for pose in self.poses)])[:, :2]

    @property
    def extent_m(self) -> float:
        """How wide the scene is, of which all drawn lengths are shares, metres."""
        return max(_LEAST_M, float(np.max(np.ptp(self.places_m, axis=0))))

    @property
    def box_m(self) -> FloatArray:
        """Low and high corner of what is drawn from above, (2, 2), metres."""
        hidden = [point for _, point in self.points if self.uncertain and not isinstance(point, Terminal)]
        around = [
            (np.vstack([self.places_m, *map(set_outline_m, hidden)]), _MARGIN),
            (np.array([pose.position_m[:2] for pose in self.poses]), self.axis),
        ]
        around += [(corners_m, _MARGIN_OF_ZONES) for _, corners_m in self.zones]
        ends = [places_m + sign * share * self.extent_m for places_m, share in around for sign in (-1.0, 1.0)]
        return np.stack([np.vstack(ends).min(axis=0), np.vstack(ends).max(axis=0)])

    @property
    def zones(self) -> list[tuple[NoFlyZone | None, FloatArray]]:
        """The fence (None) and the no-fly zones with their corners, those left out that reach far away."""
        airspace, places_m = self.scenario.airspace, self.places_m
        middle_m, far_m = 0.5 * (places_m.min(axis=0) + places_m.max(axis=0)), _FAR * self.extent_m
        outlines = [
            *((zone, outline_m(zone)) for zone in airspace.no_fly),
            *([] if airspace.geofence_m is None else [(None, airspace.geofence_outline_m)]),
        ]
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


def set_outline_m(point: Jammer | Eavesdropper) -> FloatArray:
    """List places around the set that a point may be anywhere in, from above, (n, 2), metres."""
    around = np.linspace(0.0, math.tau, 73)
    away_m = point.uncertainty_reach_m * np.stack([np.cos(around), np.sin(around)], axis=1)
    return np.asarray(away_m + point.position_m[:2])
