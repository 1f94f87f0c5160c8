"""A certificate: the claim about one scenario, and the leaves that prove it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from nullpose.certificate.profile import ProfileField
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.schemes import OPTIMUM, RECORDS
from nullpose.scenario import Scenario

WORLD = 0  # any axis, in the world frame
TOWARDS = 1  # any axis, in a frame that turns towards a point
AFFINE = 2  # the axis that the position gives
FAR = 3  # a node out of reach
KEPT_OUT = 4  # inside a keep-out ball or a forbidden zone
OFF_BAND = 5  # a cell of axes that the airframe does not reach
PROFILE = 6  # any axis of an antenna that is the same all round

DEEPEST = 50  # halvings of a root or of a cell of axes: with more a middle is no floating-point number

# What is known of each leaf: kind and shape of the entry, by the name of the column.
COLUMNS: Mapping[str, tuple[type, tuple[int, ...]]] = {
    "box": (int, (6,)),
    "cell": (int, (5,)),
    "test": (int, ()),
    "point": (int, ()),
    "level": (float, ()),
    "mix": (int, ()),
    "sides": (float, (2,)),
    "band": (float, ()),
    "ball": (int, ()),
    "ball_multiplier": (float, ()),
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Leaves:
    """Boxes of positions, some with a cell of axes, and the test that excludes each.

    A box is a dyadic part of the tree's root: along each axis, part ``index`` of ``2^depth`` equal ones.

    Args:
        box: (l, 6) depth and index along x, y and z.
        cell: (l, 5) face of the cube of axes, -1 for every axis, then depth and index along its two sides;
            for ``PROFILE`` the chart, then depth and index of the angle from the anchor and of the spin,
            of all that there are, or, from the zenith, of those that the airframe reaches.
        test: (l,) which test: ``WORLD``, ``TOWARDS``, ``AFFINE``, ``FAR``, ``KEPT_OUT``, ``OFF_BAND`` or
            ``PROFILE``.
        point: (l,) the point that the frame turns towards, the anchor, the ratio that is out of reach, or
            the keep-out ball or zone; -1 where there is none, or where the zenith is the anchor.
        level: (l,) the smallest ratio that no pose of the leaf reaches.
        mix: (l,) index into ``mixes``; -1 where none is needed.
        mixes: multipliers of ratios, each a mapping from ratio to weight.
        sides: (l, 2) multipliers of the cell's two sides.
        band: (l,) multiplier of the band's upper end, or, if negative, minus that of its lower end; for
            ``PROFILE`` of the largest angle from the vertical, or minus that of the least.
        ball: (l,) the keep-out ball that counts in the box, or, counted on from the balls, the zone; or -1.
        ball_multiplier: (l,) the ball's multiplier, 1/m^2; a zone's are found anew.
    """

    box: IntArray
    cell: IntArray
    test: IntArray
    point: IntArray
    level: FloatArray
    mix: IntArray
    mixes: tuple[Mapping[int, float], ...]
    sides: FloatArray
    band: FloatArray
    ball: IntArray
    ball_multiplier: FloatArray

    def __len__(self) -> int:
        return len(self.box)

    @property
    def face(self) -> IntArray:
        """The face of the cube of axes, (l,), -1 for every axis; the chart for ``PROFILE``."""
        return self.cell[:, 0]

    @property
    def depths(self) -> IntArray:
        """The depths along x, y, z and the two sides of the cell, (l, 5)."""
        return np.concatenate([self.box[:, 0::2], self.cell[:, 1::2]], axis=1)

    @property
    def indices(self) -> IntArray:
        """The indices that belong to the depths, (l, 5)."""
        return np.concatenate([self.box[:, 1::2], self.cell[:, 2::2]], axis=1)

    def chosen(self, rows: IntArray | np.ndarray) -> Leaves:
        """Select leaves by a mask or indices."""
        return replace(self, **{name: getattr(self, name)[rows] for name in COLUMNS})


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Tree:
    """The proof for one axis field.

    Args:
        axis: ``"free"``, ``"band"``, ``"vertical"``, ``"broadside"``, ``"null NAME"`` with a jammer's name,
            or ``"profile"`` for an antenna that is no dipole.
        root_m: (2, 3) lowest and highest corner of the root box, metres.
        leaves: they cover the root.
    """

    axis: str
    root_m: FloatArray
    leaves: Leaves


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Certificate:
    """The claim that a pose has a value and that no pose exceeds a bound.

    Args:
        scenario: what the claim is about.
        scheme: the case: which axes are allowed.
        null_jammer: zero interference only: the one jammer that was to be nulled, or None for any of them.
        value: the smallest ratio at the pose, over all instants of a scene in motion: an SINR, a margin where
            nodes state weights or requirements, or, for the secrecy rate, two to the power of it.
        upper_bound: no allowed pose has its smallest ratio above it.
        position_m: (3,) the pose's position, metres, ENU.
        roll_rad: its roll.
        pitch_rad: its pitch.
        yaw_rad: its yaw.
        trees: one for each axis field of the scheme.
        instants: of a scene in motion, in which the pose is held: the instants whose ratios the trees are
            about, counted from 0 over those of the scenario, in the order of the ratios.
        provenance: what produced it; not part of the claim.
    """

    scenario: Scenario
    scheme: str
    null_jammer: str | None
    value: float
    upper_bound: float
    position_m: FloatArray
    roll_rad: float
    pitch_rad: float
    yaw_rad: float
    trees: tuple[Tree, ...]
    instants: tuple[int, ...] = ()
    provenance: Mapping[str, object] = field(default_factory=dict)


def claimed_axes(scenario: Scenario, scheme: str, null_jammer: str | None) -> Mapping[str, AxisField] | None:
    """Return the axis fields of a scheme by the names they have in a certificate; None if there are none.

    They are those of one antenna in the scene as stated, uncertainties and arrays left out.

    Args:
        scenario: nodes, jammers and airframe.
        scheme: the case.
        null_jammer: for a scheme that nulls a jammer: which, or None for any.
    """
    if (record := RECORDS.get(scheme)) is None or (null_jammer is not None and not record.nulls_a_jammer):
        return None
    if scenario.time is not None and record is not OPTIMUM:  # whose axes alone do not move with the points
        return None
    if (antenna := scenario.antenna_record).is_quadratic:
        return record.fields(scenario, null_jammer)
    if not (record.any_antenna and antenna.is_axisymmetric):
        return None
    return {"profile": ProfileField.of(antenna, scenario)}
