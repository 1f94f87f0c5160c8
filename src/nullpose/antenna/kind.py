"""What a kind of antenna states of itself to scenario files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, TypeAlias

from nullpose.antenna.pattern import PatternAntenna
from nullpose.antenna.quadratic import QuadraticAntenna
from nullpose.files import PlainTable

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
