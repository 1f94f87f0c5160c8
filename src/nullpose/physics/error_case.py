"""Error cases: where everything that is uncertain may actually be."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike

from nullpose.errors import require_usage
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario
from nullpose.scenario.section import read_only


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ErrorCase:
    """Where everything actually is, from where it was meant or thought to be; world frame.

    One case, or several with the same leading shape ``(...)``.

    Args:
        position_offset_m: shape ``(..., 3)``, the drone's actual position less the commanded one, metres.
        rotation_world: shape ``(..., 3, 3)``, the rotation that takes the commanded antenna axis to the
            actual one.
        jammer_offsets_m: shape ``(..., n_jammers, 3)``, actual less stated positions, metres.
        eavesdropper_offsets_m: shape ``(..., n_eavesdroppers, 3)``, likewise.
    """

    position_offset_m: FloatArray
    rotation_world: FloatArray
    jammer_offsets_m: FloatArray
    eavesdropper_offsets_m: FloatArray

    def __post_init__(self) -> None:
        shapes = {"position_offset_m": (3,), "rotation_world": (3, 3)}
        for field in fields(self):
            array = np.array(getattr(self, field.name), dtype=float)
            wanted = shapes.get(field.name, (*array.shape[-2:-1], 3))
            require_usage(
                array.shape[-len(wanted) :] == wanted and np.all(np.isfinite(array)),
                f"error case {field.name} must be finite, of shape {wanted}; given {array.tolist()}",
            )
            object.__setattr__(self, field.name, read_only(array, array.shape))

    @classmethod
    def none(cls, scenario: Scenario) -> ErrorCase:
        """Return the case in which everything is as stated."""
        return cls(
            position_offset_m=np.zeros(3),
            rotation_world=np.eye(3),
            jammer_offsets_m=np.zeros((len(scenario.jammers), 3)),
            eavesdropper_offsets_m=np.zeros((len(scenario.eavesdroppers), 3)),
        )

    def is_same(self, other: ErrorCase) -> bool:
        """Compare with another case of the same scenario, to the last bit."""
        return all(
            np.array_equal(getattr(self, field.name), getattr(other, field.name)) for field in fields(self)
        )

    def pose(
        self, scenario: Scenario, position_m: ArrayLike, axis: ArrayLike
    ) -> tuple[FloatArray, FloatArray]:
        """Place and turn the drone as it actually is.

        Args:
            scenario: its antenna says whether the gain depends on an axis or on an attitude.
            position_m: the commanded position, shape ``(..., 3)``, metres.
            axis: the commanded unit antenna axis, shape ``(..., 3)``; the attitude ``(..., 3, 3)`` of an
                antenna with a pattern.
        """
        position = np.asarray(position_m, dtype=float) + self.position_offset_m
        turned = np.asarray(axis, dtype=float)
        if not scenario.antenna_record.is_quadratic:
            return position, np.asarray(self.rotation_world @ turned)
        return position, np.asarray((self.rotation_world @ turned[..., None])[..., 0])

    def sources_m(self, scenario: Scenario) -> FloatArray:
        """Place the nodes and then the jammers as they actually are, ``(..., n_sources, 3)``, metres."""
        jammers_m = scenario.jammer_positions_m.reshape(-1, 3) + self.jammer_offsets_m
        nodes_m = np.broadcast_to(
            scenario.node_positions_m, (*jammers_m.shape[:-2], *scenario.node_positions_m.shape)
        )
        return np.concatenate([nodes_m, jammers_m], axis=-2)

    @property
    def rotation_rad(self) -> float:
        """Angle of the rotation, radians: for the smallest that turns the axis so, the error of the axis."""
        sine = 0.5 * np.linalg.norm(
            [self.rotation_world[j, i] - self.rotation_world[i, j] for i, j in ((0, 1), (1, 2), (2, 0))]
        )
        return math.atan2(float(sine), 0.5 * (float(np.trace(self.rotation_world)) - 1.0))


def rotation_between(first: ArrayLike, second: ArrayLike) -> FloatArray:
    """Build the smallest rotation that takes one unit vector to another.

    ``R = I + [v]x + [v]x^2 / (1 + c)`` with ``v = a x b`` and ``c = a.b`` (Rodrigues' formula).

    Args:
        first: ``a``, shape ``(3,)``, of unit length.
        second: ``b``, shape ``(3,)``, of unit length and not opposite to it.

    Returns:
        Array of shape ``(3, 3)``.
    """
    a, b = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    x, y, z = np.cross(a, b)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + cross + cross @ cross / (1.0 + float(a @ b)))
