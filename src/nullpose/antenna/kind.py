"""What a kind of antenna states of itself to scenario files, and antennas whose gain is a quadratic form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, Literal, NamedTuple, TypeAlias

from nullpose.antenna.harmonics import FloatArray
from nullpose.antenna.pattern import PatternAntenna
from nullpose.files import PlainTable


@dataclass(frozen=True, slots=True, kw_only=True)
class QuadraticAntenna:
    """An antenna of gain ``g = (1 - e) sin^2(gamma) + e``: 1 broadside, and e along its axis.

    Its link to a point at r, gain over squared distance, is ``u^T M(r) u`` for a unit axis u, with
    ``M(r) = (1 - e) T(r) + e I / |r|^2`` and ``T(r) = (|r|^2 I - r r^T) / |r|^4``. Solver and certificate
    need no more than e of it. It is polarised as a short dipole is.

    Args:
        name: as in a scenario file.
        label: in sentences and tables.
        leak: e, the gain along the axis, a power ratio from 0 to 1; 0 is a perfect null.
    """

    is_quadratic: ClassVar[Literal[True]] = True
    is_axisymmetric: ClassVar[bool] = True
    is_even: ClassVar[bool] = True
    has_polarisation: ClassVar[bool] = True
    peak: ClassVar[float] = 1.0

    name: str
    label: str
    leak: float

    @property
    def mean(self) -> float:
        """Mean gain over the sphere."""
        return (2.0 + self.leak) / 3.0

    def gain(self, sine_squared: FloatArray) -> FloatArray:
        """Evaluate the power gain at an angle from the axis, 1 broadside.

        Args:
            sine_squared: ``sin^2(gamma)``, of any shape.
        """
        return self.leak + (1.0 - self.leak) * sine_squared


AnyAntenna: TypeAlias = QuadraticAntenna | PatternAntenna
"""An antenna of the drone."""


class AntennaKind(NamedTuple):
    """A kind of antenna, as ``kind`` in the table ``[antenna]`` names it.

    Args:
        summary: what it is, for the schema of scenario files.
        make: from the values of ``keys``, by name, to the antenna.
        keys: of the table ``[antenna]`` that have a meaning for it, beside ``kind`` and ``gain_dbi``.
        read: from the path of its file and the table to the keys that the file fills in, and notes on how it
            is read; None where the kind has no file.
    """

    summary: str
    make: Callable[..., AnyAntenna]
    keys: tuple[str, ...] = ()
    read: Callable[[Path, PlainTable], tuple[PlainTable, tuple[str, ...]]] | None = None
