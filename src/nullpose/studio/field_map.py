"""The studio's two maps: what each position gives at its best axis, and where the drone's pattern falls."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import NamedTuple

import numpy as np

from nullpose.physics import antenna_gain
from nullpose.problem.build import build_family
from nullpose.solver.background_compiler import BackgroundCompiler
from nullpose.studio.answer import Answer
from nullpose.studio.case import new_scenario
from nullpose.studio.look import scale_range
from nullpose.study import Field, value_map
from nullpose.study.value_map import in_decibels

MAPS = ("best value at each place", "pattern's footprint")
"""What the two maps are called, the first being that of the best values."""


_asking = threading.Lock()


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
class FieldMap:
    """The two maps of a version of the scene.

    Args:
        version: the version of the scene.
        best: the objective at the best axis of each position, on a plane at the drone's altitude.
        footprint: the drone's gain over the path loss, on the ground.
    """

    version: int
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
    ground = np.stack(np.broadcast_arrays(*np.meshgrid(best.east_m, best.north_m), 0.0), -1)
    loss = np.sum((ground - pose.position_m) ** 2, axis=-1) / max(1.0, float(pose.position_m[2]) ** 2)
    at = (pose.position_m, pose.orientation(scenario.antenna_record), ground.reshape(-1, 3))
    gain = antenna_gain(*at, scenario.antenna_record).reshape(loss.shape)
    footprint = replace(
        best,
        altitude_m=0.0,
        values=in_decibels(gain / np.maximum(loss, 1e-12)),
        unit="dB",
        title="gain over path loss on the ground, 0 straight below at full gain",
        name="footprint_db",
    )
    unlike = " without errors" if answer.case.robust else ""
    best = replace(best, title=f"{best.title}{unlike}")
    return FieldMap(version=answer.version, best=best, footprint=footprint)


def map_kernel_is_ready() -> bool:
    """Tell whether the map needs no compiling; the first call has another process compile its kernel."""
    with _asking:
        return not _compiler().is_busy()


@cache
def _compiler() -> BackgroundCompiler:
    """Return the compiler of the kernel, after one call that needs it."""
    from nullpose.solver.kernels.linear_algebra.axis import best_axis

    compiler = BackgroundCompiler()
    with compiler.in_use():
        best_axis(build_family(new_scenario()).arrays, np.array([5.0, 5.0, 9.0]), np.empty(3))
    return compiler
