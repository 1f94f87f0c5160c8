"""A family: the ratios of which the smallest is maximised, and the positions over which it is."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from nullpose.objectives import FloatArray, IntArray, Ratios
from nullpose.problem.records import Domain


@dataclass(frozen=True, init=False, eq=False)
class Family:
    """Ratios over the link forms of points, and their domain.

    Args:
        fields: those of :class:`nullpose.objectives.Ratios` and of :class:`Domain`; arrays that could be
            written to are copied, and the copies cannot.
    """

    ratios: Ratios
    domain: Domain

    def __init__(self, **fields: Any) -> None:
        kept = DEFAULTS | {name: _read_only(value) for name, value in fields.items()}
        object.__setattr__(self, "ratios", Ratios(*map(kept.pop, Ratios._fields)))
        object.__setattr__(self, "domain", Domain(**kept))

    def __reduce__(self) -> tuple[partial[Family], tuple[()]]:
        return partial(Family, **self.fields), ()

    def changed(self, **fields: object) -> Family:
        """Copy the family with other values in the fields named."""
        return Family(**self.fields | fields)

    def at(self, position_m: FloatArray) -> Family:
        """Narrow the family to one position, (3,), metres, whether the airspace allows it or not."""
        return Family(
            **self.ratios._asdict(),
            **Domain(position_m, position_m, np.zeros((0, 3)), self.domain.keep_out_m)._asdict(),
        )

    @property
    def required_ratios(self) -> Family:
        """The ratios of a mean that have requirements, each over its own: met where none is below 1."""
        kept = np.flatnonzero(self.ratios.requirements)
        least, none = self.ratios.requirements[kept], np.zeros(0)
        return self.changed(
            numerator_isotropic=self.ratios.numerator_isotropic[kept] / least,
            numerator_weight=self.ratios.numerator_weight[kept] / least,
            numerator_point=self.ratios.numerator_point[kept],
            denominator_of=self.ratios.denominator_of[kept],
            shares=none,
            requirements=none,
        )

    @property
    def fields(self) -> dict[str, FloatArray | IntArray | float]:
        """Every array by name, and the keep-out radius."""
        return self.ratios._asdict() | self.domain._asdict()

    @property
    def digest(self) -> str:
        """SHA-256 of every number in the family: two families with the same digest are the same problem."""
        sha = hashlib.sha256()
        for name, values in sorted(self.fields.items()):
            array = np.ascontiguousarray(values)
            sha.update(f"{name}:{array.dtype.str}:{array.shape};".encode())
            sha.update(array.tobytes())
        return sha.hexdigest()


def _read_only(value: object) -> Any:
    if not isinstance(value, np.ndarray):
        return value
    if value.flags.writeable or not value.flags.c_contiguous or value.dtype not in _KINDS:
        value = np.array(value, dtype=_KINDS[value.dtype.kind in "iu"], order="C")
        value.flags.writeable = False
    return value


_KINDS = np.dtype(np.float64), np.dtype(np.int64)  # those that kernels are compiled for
DEFAULTS = {
    name: _read_only(value) for name, value in (Ratios._field_defaults | Domain._field_defaults).items()
}
"""The arrays of a family that are not stated, read-only."""
