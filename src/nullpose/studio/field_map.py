"""The studio's two maps: what each position gives at its best axis, and where the drone's pattern falls."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from nullpose.physics import antenna_gain
from nullpose.studio.answer import Answer
from nullpose.study.value_map import Field, in_decibels, value_map

MAPS = ("best value at each place", "pattern's footprint")
"""What the two maps are called, the first being that of the best values."""


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

    def named(self, name: str) -> Field | None:
        """Return the map of a name, or None.

        Args:
            name: one of ``MAPS``, or any other.
        """
        return dict(zip(MAPS, (self.best, self.footprint), strict=True)).get(name)


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
