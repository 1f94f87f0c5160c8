"""Buildings over a box of positions: each link counts as clear or as blocked, whichever is the better."""

from __future__ import annotations

from nullpose.channel.model import BLOCKED
from nullpose.objectives.ratios import Ratios
from nullpose.solver.kernels.bounds.expansion import min_square
from nullpose.solver.kernels.bounds.link_field import excess_end
from nullpose.solver.kernels.bounds.node import CENTRE, HALF, LEVEL
from nullpose.solver.kernels.compiler.jit import inner_kernel, rare_kernel, small_kernel
from nullpose.solver.kernels.compiler.scratch import scratch, scratch_int
from nullpose.solver.kernels.linear_algebra.links import most_heard
from nullpose.solver.kernels.linear_algebra.symmetric import copy_into
from nullpose.solver.kernels.linear_algebra.vectors import dot, norm

_SMALL_M = 2.0  # half diagonal of boxes in which shadows are compared
_TOUCHES = 1e-9  # m, as in :mod:`nullpose.channel.buildings`
_PARALLEL = 1e-9  # the least square of the sine between two sides
_PIECES, _SIDES = 8, 32  # that are compared at most
_ROWS = 256  # their sides together
_ENTRIES = 62  # of denominators that are looked at: bits of a number


@rare_kernel
def blocked_end(family, j, is_above, centre, half):
    """Return the share that link j keeps among buildings all over a box: the most or least, by ``is_above``.

    A shadow is convex: beyond one of its sides the box is clear of it, inside of all it is in it.
    """
    sides, start = family.shadow_sides, family.shadow_start
    for shadow in range(family.shadows_of_point[j], family.shadows_of_point[j + 1]):
        piece = sides[start[shadow] : start[shadow + 1]]
        if not is_outside(piece, centre, half):
            inside = True
            for s in range(piece.shape[0]):
                inside = inside and reach_beyond(piece[s], centre, half) < 0.0
            if inside or not is_above:
                return family.channels[j, BLOCKED]
    return 1.0


@small_kernel
def excess_range(family, j, centre, half):
    """Return the least and the largest excess gain of point j in a box, buildings included."""
    low = excess_end(family, j, False, centre, half)
    high = excess_end(family, j, True, centre, half)
    if family.shadow_sides.shape[0] > 0:
        low *= blocked_end(family, j, False, centre, half)
        high *= blocked_end(family, j, True, centre, half)
    return low, high


@inner_kernel
def reach_beyond(side, centre, half):
    """Return the largest distance of a box beyond a side."""
    return dot(side, centre) - side[3] + norm_along(side, half)


@inner_kernel
def is_implied(side, inside, count, centre, half):
    """Check whether all in a box that is inside of some sides is inside of another, as two of them show."""
    rest = scratch(4)
    if reach_beyond(side, centre, half) <= _TOUCHES:
        return True
    for a in range(count):
        for b in range(a, count):
            across = dot(inside[a], inside[b]) if b > a else 0.0
            with_a, with_b = dot(side, inside[a]), (dot(side, inside[b]) if b > a else 0.0)
            det = 1.0 - across * across
            if det < _PARALLEL:
                continue
            x, y = (with_a - across * with_b) / det, (with_b - across * with_a) / det
            if x >= 0.0 and y >= 0.0:
                for m in range(4):
                    rest[m] = side[m] - x * inside[a, m] - y * inside[b, m]
                if reach_beyond(rest, centre, half) <= _TOUCHES:
                    return True
    return False


@inner_kernel
def add_shadow(shadow, centre, half, inside, size):
    """Add the sides of a shadow that cut a box to others; return how many there are."""
    for s in range(shadow.shape[0]):
        if size < _SIDES and reach_beyond(shadow[s], centre, half) > 0.0:
            copy_side(shadow[s], 1.0, inside[size])
            size += 1
    return size


@inner_kernel
def is_covered(inside, size, pieces, ends, count, centre, half):
    """Check whether convex pieces together hold all that is inside of some sides in a box.

    What is beyond the first side of the first piece must be in the others; then what is inside of that side
    and beyond the second; and so on.

    Args:
        inside: the sides; rows beyond are written to.
        size: how many sides.
        pieces: (t, 4) the sides of all pieces.
        ends: where those of each end; the next ones begin there.
        count: how many pieces.
        centre: of the box.
        half: its half sides.
    """
    sizes, places = scratch_int(_PIECES), scratch_int(_PIECES)
    depth, sizes[0], places[0] = (0 if count > 0 else -1), size, 0
    while depth >= 0:
        s, size = places[depth], sizes[depth]
        if s == ends[depth]:  # the rest is inside of all sides
            depth -= 1
            if depth >= 0:
                copy_side(pieces[places[depth] - 1], 1.0, inside[sizes[depth]])
                sizes[depth] += 1
            continue
        places[depth] += 1
        if not is_implied(pieces[s], inside, size, centre, half):
            if depth + 1 == count or size == _SIDES:
                return False
            copy_side(pieces[s], -1.0, inside[size])
            depth += 1
            places[depth], sizes[depth] = ends[depth - 1], size + 1
    return count > 0


@inner_kernel
def copy_side(side, sign, out):
    """Copy a side, or what is beyond it with a sign of -1."""
    for m in range(4):
        out[m] = sign * side[m]


@inner_kernel
def must_be_seen(family, row, k):
    """Check whether a ratio is too weak all over a box where its point's link is blocked."""
    if family.shares.shape[0] > 0 or family.pairs.shape[0] > 0:  # of a mean no ratio must be anything
        return False
    j, least = family.numerator_point[k], family.denominator_isotropic[family.denominator_of[k]]
    square = min_square(family.points_m, j, row[CENTRE:HALF], row[HALF:LEVEL])
    clear = most_heard(family, k, square) - family.numerator_isotropic[k]
    return family.numerator_isotropic[k] + clear * family.channels[j, BLOCKED] < row[LEVEL] * least


@inner_kernel
def fill_pieces(family, domain, row, pieces, ends):
    """Fill what of a box is forbidden or hides a node that must be seen; return how many pieces that is."""
    sides, start, of_point = family.shadow_sides, family.shadow_start, family.shadows_of_point
    centre, half, count = row[CENTRE:HALF], row[HALF:LEVEL], 0
    for piece in range(domain.piece_start.shape[0] - 1):
        first, last = domain.piece_start[piece], domain.piece_start[piece + 1]
        if domain.piece_sides[first, 0] == 0.0:
            count = add_piece(domain.piece_sides[first:last, 1:], centre, half, pieces, ends, count)
    for k in range(family.numerator_point.shape[0]):
        if must_be_seen(family, row, k):
            node = family.numerator_point[k]
            for shadow in range(of_point[node], of_point[node + 1]):
                count = add_piece(sides[start[shadow] : start[shadow + 1]], centre, half, pieces, ends, count)
    return count


@rare_kernel
def is_seen_with_nodes(family, domain, j, row):
    """Check whether point j is in sight wherever all nodes are that must be, and the drone may be.

    Its shadows are then in those of the nodes and in what is forbidden, such as the building itself. No
    smaller box tells them apart at a building's wall and at its edges, where shadows meet.
    """
    sides, start, of_point = family.shadow_sides, family.shadow_start, family.shadows_of_point
    centre, half = row[CENTRE:HALF], row[HALF:LEVEL]
    pieces, ends, inside = scratch(_ROWS, 4), scratch_int(_PIECES), scratch(_SIDES, 4)
    count = fill_pieces(family, domain, row, pieces, ends)
    for shadow in range(of_point[j], of_point[j + 1]):
        piece = sides[start[shadow] : start[shadow + 1]]
        if not is_outside(piece, centre, half):
            size = add_shadow(piece, centre, half, inside, 0)
            if not is_covered(inside, size, pieces, ends, count, centre, half):
                return False
    return True


@inner_kernel
def shadows_in_box(family, j, row):
    """Count the shadows of point j that reach into a box, and return the last of them."""
    sides, start, count, last = family.shadow_sides, family.shadow_start, 0, -1
    for shadow in range(family.shadows_of_point[j], family.shadows_of_point[j + 1]):
        if not is_outside(sides[start[shadow] : start[shadow + 1]], row[CENTRE:HALF], row[HALF:LEVEL]):
            count, last = count + 1, shadow
    return count, last


@rare_kernel
def is_hidden_by_several(family, j, row):
    """Check whether shadows of point j that touch or overlap hold all of a box."""
    if shadows_in_box(family, j, row)[0] < 2:
        return False
    pieces, ends, inside, count = scratch(_ROWS, 4), scratch_int(_PIECES), scratch(_SIDES, 4), 0
    centre, half, sides, start = row[CENTRE:HALF], row[HALF:LEVEL], family.shadow_sides, family.shadow_start
    for shadow in range(family.shadows_of_point[j], family.shadows_of_point[j + 1]):
        count = add_piece(sides[start[shadow] : start[shadow + 1]], centre, half, pieces, ends, count)
    return is_covered(inside, 0, pieces, ends, count, centre, half)


@inner_kernel
def hidden_nowhere(family, domain, row):
    """Find interferers that are hidden together nowhere in a small box, of which each counts as hidden.

    Positions that are forbidden, and those from which a node is hidden that must be seen, do not count.

    Returns:
        A bit for each entry of the denominators that is of them; of no interferer can be done without.
    """
    found = 0
    if norm(row[HALF:LEVEL]) < _SMALL_M:
        pieces, ends = scratch(_ROWS, 4), scratch_int(_PIECES)
        count = fill_pieces(family, domain, row, pieces, ends)
        for e in range(min(_ENTRIES, family.denominator_point.shape[0])):
            j = family.denominator_point[e]
            if shadows_in_box(family, j, row)[0] == 1 and not is_seen_with_nodes(family, domain, j, row):
                found |= 1 << e
        if not meet_nowhere(family, found, row, pieces, ends, count):
            return 0
        for e in range(_ENTRIES):
            fewer = found & ~(1 << e)
            if fewer != found and fewer != 0 and meet_nowhere(family, fewer, row, pieces, ends, count):
                found = fewer
    return found


@inner_kernel
def meet_nowhere(family, entries, row, pieces, ends, count):
    """Check whether the shadows of some entries of the denominators meet only in some pieces, in a box."""
    sides, start, centre, half = family.shadow_sides, family.shadow_start, row[CENTRE:HALF], row[HALF:LEVEL]
    inside, size = scratch(_SIDES, 4), 0
    for e in range(_ENTRIES):
        if entries >> e & 1:
            _, shadow = shadows_in_box(family, family.denominator_point[e], row)
            size = add_shadow(sides[start[shadow] : start[shadow + 1]], centre, half, inside, size)
    return entries != 0 and is_covered(inside, size, pieces, ends, count, centre, half)


@inner_kernel
def add_piece(piece, centre, half, pieces, ends, count):
    """Add a convex piece to others unless it is outside of a box; return how many there are."""
    if count == _PIECES or piece.shape[0] > _SIDES or is_outside(piece, centre, half):
        return count
    first = ends[count - 1] if count > 0 else 0
    for s in range(piece.shape[0]):
        copy_side(piece[s], 1.0, pieces[first + s])
    ends[count] = first + piece.shape[0]
    return count + 1


@inner_kernel
def is_outside(piece, centre, half):
    """Check whether all of a box is beyond one side of a convex piece."""
    for s in range(piece.shape[0]):
        if reach_beyond(piece[s], centre, half) >= 2.0 * norm_along(piece[s], half):
            return True
    return False


@inner_kernel
def norm_along(side, half):
    """Return half the extent of a box along the normal of a side."""
    return abs(side[0]) * half[0] + abs(side[1]) * half[1] + abs(side[2]) * half[2]


@small_kernel
def multiply_by_sight(family, domain, points, is_above, seen, row, weights):
    """Multiply weights by what buildings leave of their points' links, at best, all over a row's box."""
    if family.shadow_sides.shape[0] > 0:
        for k in range(weights.shape[0]):
            j, half = points[k], row[HALF:LEVEL]
            left = blocked_end(family, j, is_above, row[CENTRE:HALF], half)
            if left < 1.0 and not is_above and norm(half) < _SMALL_M:
                left = 1.0 if j == seen or is_seen_with_nodes(family, domain, j, row) else left
            if left == 1.0 and is_above and is_hidden_by_several(family, j, row):
                left = family.channels[j, BLOCKED]
            weights[k] *= left


@small_kernel
def in_sight(family, domain, seen, row, workspace):
    """Return the ratios as a row's box has them, without buildings: their shadows are in the weights.

    The interferer ``seen`` counts as in sight, -1 being none.
    """
    copy_into(family.numerator_weight, workspace.numerator_weight)
    copy_into(family.denominator_weight, workspace.denominator_weight)
    nodes, others = family.numerator_point, family.denominator_point
    multiply_by_sight(family, domain, nodes, True, seen, row, workspace.numerator_weight)
    weights, split = workspace.denominator_weight, others.shape[0]
    if family.pairs.shape[0] > 0:  # what jams an eavesdropper is wanted
        split = family.denominator_start[family.denominator_of[family.pairs[0, 1]]]
    multiply_by_sight(family, domain, others[:split], False, seen, row, weights[:split])
    multiply_by_sight(family, domain, others[split:], True, seen, row, weights[split:])
    return Ratios(
        family.points_m, family.numerator_isotropic, workspace.numerator_weight, family.numerator_point,
        family.denominator_of, family.denominator_isotropic, family.denominator_start,
        family.denominator_point, workspace.denominator_weight, family.turn, family.leak,
        family.ground_axes, family.ground_leaks, family.channels, family.shadows_of_point,
        family.shadow_start, workspace.no_sides, family.shares, family.offset, family.requirements,
        family.pairs,
    )  # fmt: skip
