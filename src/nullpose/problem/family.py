"""A family: the ratios of which the smallest is maximised, and the positions over which it is.

Of a scene in motion those of several instants are joined: one pose serves all of them.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import accumulate
from typing import Any

import numpy as np

from nullpose.objectives import FloatArray, IntArray, Ratios
from nullpose.problem.records import Domain
from nullpose.scenario import Scenario


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


_INDICES = {  # of which array of another field each counts the rows
    "numerator_point": "points_m",
    "denominator_point": "points_m",
    "denominator_of": "denominator_isotropic",
}
_STARTS = {
    "denominator_start": "denominator_point",
    "shadows_of_point": "shadow_start",
    "shadow_start": "shadow_sides",
}


def still_scenes(scenario: Scenario) -> list[Scenario]:
    """List the still scenes of a scene in motion, one for each of its instants; a still scene alone."""
    return [scenario] if scenario.time is None else [scenario.at(float(t_s)) for t_s in scenario.instants_s]


def join_instants(families: Sequence[Family], chosen: Sequence[int]) -> Family:
    """Join the ratios of some instants, whose smallest is that of a pose held at all of them.

    The points of every instant are kept clear of, whether it is chosen or not.

    Args:
        families: of the scene at every instant, with equally many ratios of which the smallest is maximised.
        chosen: indices of the instants whose ratios count.
    """
    ratios = [families[i].ratios for i in chosen]
    fields = {name: _joined(ratios, name) for name in Ratios._fields if name not in ("leak", "offset")}
    domain, balls = families[0].domain, [family.domain.keep_out_points_m for family in families]
    kept_out_m = np.unique(np.vstack(balls), axis=0)
    return Family(**fields, leak=ratios[0].leak, **domain._replace(keep_out_points_m=kept_out_m)._asdict())


def _joined(ratios: Sequence[Ratios], name: str) -> FloatArray | IntArray:
    """Join an array of the ratios of several instants; what counts rows of another counts on."""
    parts = [getattr(each, name) for each in ratios]
    if (rows := _INDICES.get(name) or _STARTS.get(name)) is None:
        return np.concatenate(parts)
    lengths = [len(getattr(each, rows)) - (rows == "shadow_start") for each in ratios]
    before = accumulate(lengths, initial=0)
    if name in _INDICES:
        return np.concatenate([part + first for part, first in zip(parts, before, strict=False)])
    begins = [part[:-1] + first for part, first in zip(parts, before, strict=False)]
    return np.append(np.concatenate(begins), sum(lengths))
