"""The frame in which a scheme's proof is made."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

__all__ = ["Frame", "FrameNumbers"]

FrameNumbers: TypeAlias = tuple[int, int, int, int]

# as in kernels.expansion, which is not imported here: it would load the compiler
_WORLD, _TOWARDS_POINT, _ABOUT_LINE = 0, 1, 2


@dataclass(frozen=True, slots=True)
class Frame:
    """Which frame field a scheme uses, and whether its third axis is the antenna's.

    Args:
        fixed: whether the antenna lies along the frame's third axis; otherwise its axis is free and so is
        the frame.
        kind: 0 for the world, 1 for one that turns towards a point, 2 for one that turns about a line of two.
        anchor: index of the point, or of the line's first.
        other: index of the line's second point.
    """

    fixed: bool
    kind: int = _WORLD
    anchor: int = -1
    other: int = -1

    @classmethod
    def free(cls) -> Frame:
        """Return the frame of a free axis: chosen for each box as suits it."""
        return cls(fixed=False)

    @classmethod
    def vertical(cls) -> Frame:
        """Return the frame whose third axis is up."""
        return cls(fixed=True)

    @classmethod
    def towards(cls, point: int) -> Frame:
        """Return the frame whose third axis points at one of the family's points.

        Args:
            point: its index.
        """
        return cls(True, _TOWARDS_POINT, point)

    @classmethod
    def across(cls, first: int, second: int) -> Frame:
        """Return the frame whose third axis is broadside to two of the family's points.

        Args:
            first: index of one.
            second: index of the other.
        """
        return cls(True, _ABOUT_LINE, first, second)

    @property
    def numbers(self) -> FrameNumbers:
        """The frame as the kernels take it."""
        return (int(self.fixed), self.kind, self.anchor, self.other)
