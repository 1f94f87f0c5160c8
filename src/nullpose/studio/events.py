"""What a worker tells its page about a version of the scene, besides answers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nullpose.studio.answer import Answer
from nullpose.studio.case import Case
from nullpose.study import SweepTable

__all__ = ["Compiling", "Event", "Failure", "Field", "FieldMap", "PowerCurve"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Failure:
    """A case that could not be solved.

    Args:
        version: the version of the scene.
        case: the case.
        message: what the solver said.
    """

    version: int
    case: Case
    message: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Compiling:
    """The kernels are being compiled, which happens once after an installation.

    Args:
        version: the version of the scene.
    """

    version: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Field:
    """A number at every point of a level grid.

    Args:
        east_m: (nx,) metres.
        north_m: (ny,) metres.
        altitude_m: of the plane, metres.
        values: (ny, nx), not a number where there is none.
        unit: as in "dB".
    """

    east_m: FloatArray
    north_m: FloatArray
    altitude_m: float
    values: FloatArray
    unit: str


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


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PowerCurve:
    """The objective of several schemes against the jamming power, as far as it has been worked out.

    Args:
        version: the version of the scene.
        table: one row for each power, in dB, and scheme.
        complete: whether all powers are there.
    """

    version: int
    table: SweepTable
    complete: bool


Event = Answer | Failure | Compiling | FieldMap | PowerCurve
