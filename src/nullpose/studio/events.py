"""What a worker tells its page about a version of the scene, besides answers."""

from __future__ import annotations

from dataclasses import dataclass

from nullpose.studio.answer import Answer
from nullpose.studio.case import Case
from nullpose.studio.field_map import FieldMap
from nullpose.study import SweepTable

__all__ = ["Compiling", "Event", "Failure", "PowerCurve"]


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
