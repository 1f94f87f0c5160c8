"""The studio's two maps: what each position gives at its best axis, and where the drone's pattern falls."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import NamedTuple

import numpy as np

from nullpose.channel import PointChannels, excess_gain
from nullpose.physics import Pose, antenna_gain
from nullpose.physics.types import FloatArray
from nullpose.problem.build import build_family
from nullpose.scenario import Scenario
from nullpose.solver.background_compiler import BackgroundCompiler
from nullpose.studio.answer import Answer, Event
from nullpose.studio.case import new_scenario
from nullpose.studio.look import scale_range
from nullpose.study import Field, value_map
from nullpose.study.value_map import CELLS, in_decibels, map_grid_m

MAPS = ("best value at each place", "pattern's footprint")
"""What the two maps are called, the first being that of the best values."""


_FINER_CELLS = 121  # along the longer side, among buildings, whose shadows on the ground have edges
_ANY_NODE = new_scenario().nodes[0]  # without a channel of its own


class Scale(NamedTuple):
    """A map and its colours.

    Args:
        field: the map.
        ends: values of the dark and of the bright end.
        of_value: whether it is of the value that is maximised, so that the pose's own has a place on it.
    """

    field: Field
    ends: tuple[float, float]
    of_value: bool


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FieldMap(Event):
    """The two maps of a version of the scene.

    Args:
        best: the objective at the best axis of each position, on a plane at the drone's altitude.
        footprint: the drone's gain over the path loss of a node's link, on the ground.
    """

    best: Field
    footprint: Field

    def scale(self, name: str) -> Scale | None:
        """Return the map of a name with its colours, or None.

        Args:
            name: one of ``MAPS``, or any other.
        """
        if name not in MAPS:
            return None
        field = self.best if name == MAPS[0] else self.footprint
        return Scale(field, scale_range(field.values, is_rate=field.unit != "dB"), name == MAPS[0])


def field_map(answer: Answer, go_on: Callable[[], None] = lambda: None) -> FieldMap:
    """Return the two maps of an answer.

    Args:
        answer: whose case, altitude and pose they are of.
        go_on: called now and then; what it raises ends the work.
    """
    scenario, pose = answer.result.scenario, answer.result.pose
    best = value_map(answer.result, go_on=go_on)
    east_m, north_m = map_grid_m(
        scenario, pose.position_m, CELLS if scenario.prisms is None else _FINER_CELLS
    )
    ground = np.stack(np.broadcast_arrays(*np.meshgrid(east_m, north_m), 0.0), -1)
    gain = np.empty(ground.shape[:2])
    for places_m, row in zip(ground, gain, strict=True):
        go_on()
        row[:] = _ground_gain(scenario, pose, places_m)
    footprint = replace(
        best,
        east_m=east_m,
        north_m=north_m,
        altitude_m=0.0,
        values=in_decibels(gain),
        unit="dB",
        title="gain over path loss, 0 straight below at full gain",
        name="footprint_db",
    )
    unlike = " without errors" if answer.case.robust else ""
    return FieldMap(
        version=answer.version, best=replace(best, title=f"{best.title}{unlike}"), footprint=footprint
    )


def _ground_gain(scenario: Scenario, pose: Pose, places_m: FloatArray) -> FloatArray:
    """Evaluate what the drone receives from nodes at places on the ground, (n,).

    It is a share of what it would receive at full gain from one straight below and in sight.
    """
    above_m, node = max(1.0, float(pose.position_m[2])), scenario.channel_of(_ANY_NODE)
    channels = PointChannels.of([node] * len(places_m), scenario.prisms, [False] * len(places_m))
    to_places_m = places_m - pose.position_m
    below = excess_gain(PointChannels.of([node]), np.array([[0.0, 0.0, -above_m]])) / above_m**2
    at = (pose.position_m, pose.orientation(scenario.antenna_record), places_m, scenario.antenna_record)
    gain = antenna_gain(*at) * excess_gain(channels, to_places_m, places_m)
    return np.asarray(gain / np.maximum(np.sum(to_places_m**2, axis=-1), 1e-12) / below)


@cache
def map_compiler() -> BackgroundCompiler:
    """Return the compiler, in another process, of the map's kernel, after one call that needs it."""
    from nullpose.solver.kernels.linear_algebra.axis import best_axis

    compiler = BackgroundCompiler()
    with compiler.in_use():
        best_axis(build_family(new_scenario()).ratios, np.array([5.0, 5.0, 9.0]), np.empty(3))
    return compiler
