"""A scenario as numbers: the max-min ratio family that every solver works on."""

from nullpose.family.axis_field import AxisField
from nullpose.family.build import build_family
from nullpose.family.family import Family

__all__ = ["AxisField", "Family", "build_family"]
