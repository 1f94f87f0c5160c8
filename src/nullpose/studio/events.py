"""What a worker tells its page about a version of the scene, besides answers."""

from __future__ import annotations

from dataclasses import dataclass

from nullpose.studio.answer import Answer
from nullpose.studio.case import Case
from nullpose.studio.field_map import FieldMap
from nullpose.study import ResultTable


@dataclass(frozen=True, slots=True, kw_only=True)
class Notice:
    """Why there is no answer: a case that cannot be solved, or kernels that are being compiled.

    Args:
        version: the version of the scene.
        case: the case that cannot be solved; None while the kernels are compiled, once after an installation.
        words: what to show.
    """

    version: int
    case: Case | None
    words: str


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PowerCurve:
    """The objective of several schemes against the jamming power, as far as it has been worked out.

    Args:
        version: the version of the scene.
        table: one row for each power, in dB, and scheme.
        complete: whether all powers are there.
    """

    version: int
    table: ResultTable
    complete: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Progress:
    """How far a proof that runs has come.

    Args:
        version: the version of the scene.
        case: the case that is proved.
        gap: the bound above the value, relative.
        target: the gap that is aimed at.
        boxes: how many were examined.
    """

    version: int
    case: Case
    gap: float
    target: float
    boxes: int


Event = Answer | Notice | FieldMap | PowerCurve | Progress
