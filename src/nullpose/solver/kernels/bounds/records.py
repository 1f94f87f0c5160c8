"""What the kernels of the proof hand to each other, by name."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nullpose.objectives import FloatArray

WORLD = 0
TOWARDS_POINT = 1


class Frame(NamedTuple):
    """A frame at a box's centre: WORLD, or TOWARDS_POINT, whose third axis turns with the way to a point.

    Args:
        kind: which of the two.
        anchor: that point.
        basis: (3, 3) its axes at the centre, in columns.
        radius_m: distance of the anchor from the centre, about which the frame turns; infinity at rest.
        least_radius_m: the least such distance in the box.
    """

    kind: int
    anchor: int
    basis: FloatArray
    radius_m: float
    least_radius_m: float


class Goal(NamedTuple):
    """What a run is after.

    Args:
        best: the incumbent's smallest ratio; a box's centre that beats it ends the call.
        multipliers: a row with the multipliers at the incumbent, which are tried on every box.
        spare: by how much of a box's size multipliers must exclude its centre, so that its axes stay whole.
        price: (7,) a vector c, a place q and a number a where ``log(a + ratio) + c . (p - q)`` is maximised;
            (0,) otherwise.
    """

    best: float
    multipliers: FloatArray
    spare: float
    price: FloatArray = np.zeros(0)


class Workspace(NamedTuple):
    """Room for numbers of each ratio, denominator and point, made once for a run.

    Args:
        weights: (ratios + 4,) multipliers, of constraints too.
        values: (ratios,).
        gradients: (ratios, 3).
        sums: (points,) coefficients of links.
        expanded_side: (points,) whether the box's expansion of a link is there: 1 from above, -1 from below.
        forms: (points, 6) expansions: forms at the centre.
        form_slopes: (points, 3, 6) their slopes.
        bends: (points, 2) bounds on the second derivatives of forms and of link vectors.
        jets: (points, JET).
        denominators: (denominators, 6) forms.
        log_denominators: (denominators,).
        matrix: (6,) the last sum of forms at a box's centre.
        slopes: (3, 6) its slopes.
        rest: (6,) a form that is no less than what is left out of both over the box.
        numerator_weight: (ratios,) as the box has them.
        denominator_weight: (entries,) likewise.
        no_sides: (0, 5).
        place: (3,) where a pose is that beats the best.
        tilt: (4,) a price by metre that the test of boxes knows of, and the level at the centre; or zeros.
    """

    weights: FloatArray
    values: FloatArray
    gradients: FloatArray
    sums: FloatArray
    expanded_side: FloatArray
    forms: FloatArray
    form_slopes: FloatArray
    bends: FloatArray
    jets: FloatArray
    denominators: FloatArray
    log_denominators: FloatArray
    matrix: FloatArray
    slopes: FloatArray
    rest: FloatArray
    numerator_weight: FloatArray
    denominator_weight: FloatArray
    no_sides: FloatArray
    place: FloatArray
    tilt: FloatArray
