"""Boxes of floating-point numbers contain the exact dyadic ones, and their parts cover them."""

from fractions import Fraction

import numpy as np
from hypothesis import given, strategies as st
from tests.certificate.plain import boxes_at, make_leaves

from nullpose.certificate.boxes import Boxes, boxes_of, parts
from nullpose.certificate.pose_value import exact
from nullpose.certificate.weighted_sum import mix_slots

ends = st.one_of(
    st.floats(-1e3, 1e3),
    st.floats(-1e9, 1e9),
    st.sampled_from([0.0, 8.0, 30.0, -1e-300, 1e-300, 5e-324, 0.1, -0.1]),
)
sides = st.tuples(ends, ends).map(sorted)
places = st.integers(0, 50).flatmap(lambda d: st.tuples(st.just(d), st.integers(0, (1 << d) - 1)))


def span(boxes: Boxes, b: int, i: int) -> tuple[Fraction, Fraction]:
    """Return the exact ends of a box along one axis."""
    centre, half = Fraction(float(boxes.centre[b, i])), Fraction(float(boxes.half[b, i]))
    return centre - half, centre + half


@given(root=st.tuples(sides, sides, sides), place=st.tuples(places, places, places))
def test_boxes_contain_the_exact_ones(root: tuple, place: tuple) -> None:
    """Centre and half side, and the hull, enclose the dyadic part of the root, and hardly more."""
    leaves = make_leaves(1, box=[x for pair in place for x in pair])
    boxes = boxes_of(np.array(root).T, leaves)
    hull = boxes.hull
    for i, ((low, high), (depth, index)) in enumerate(zip(root, place, strict=True)):
        side = Fraction(high) - Fraction(low)
        first = Fraction(low) + side * Fraction(index, 1 << depth)
        last = Fraction(low) + side * Fraction(index + 1, 1 << depth)
        below, above = span(boxes, 0, i)
        assert below <= first <= last <= above
        assert float(hull.low[i, 0]) <= below <= above <= float(hull.high[i, 0])
        slack = Fraction(1, 10**14) * (abs(Fraction(low)) + abs(Fraction(high))) + Fraction(1, 10**300)
        assert above - below <= last - first + slack


@given(root=st.tuples(sides, sides, sides), place=st.tuples(places, places, places))
def test_parts_cover_their_parent(root: tuple, place: tuple) -> None:
    """The eight parts meet in the middle and reach the ends, along every axis, and keep the leaf."""
    leaves = make_leaves(1, box=[x for pair in place for x in pair])
    boxes = boxes_of(np.array(root).T, leaves)
    eight = parts(boxes)
    assert eight.leaf.tolist() == [0] * 8
    for i in range(3):
        low, high = span(boxes, 0, i)
        firsts = [span(eight, c, i) for c in range(8) if not c >> i & 1]
        seconds = [span(eight, c, i) for c in range(8) if c >> i & 1]
        assert max(a for a, _ in firsts) <= low
        assert min(b for _, b in firsts) >= max(a for a, _ in seconds)
        assert min(b for _, b in seconds) >= high


@given(seed=st.integers(0, 2**32 - 1), scale=st.sampled_from([1e-6, 1.0, 1e6]))
def test_distances_are_bounds(seed: int, scale: float) -> None:
    """No exact position of a box is nearer or farther than the bounds, and the bounds are met."""
    rng = np.random.default_rng(seed)
    boxes = boxes_at(
        scale * rng.normal(size=(1, 3)), scale * rng.uniform(0.0, 1.0, (1, 3)) * rng.integers(0, 2, (1, 3))
    )
    point = scale * rng.normal(size=3)
    low, high = np.array([span(boxes, 0, i) for i in range(3)]).T
    q = exact(point)
    near2 = sum(max(a - x, x - b, Fraction(0)) ** 2 for a, b, x in zip(low, high, q, strict=True))
    far2 = sum(max(abs(a - x), abs(b - x)) ** 2 for a, b, x in zip(low, high, q, strict=True))
    half2 = sum(((b - a) / 2) ** 2 for a, b in zip(low, high, strict=True))
    assert float(boxes.nearest2(point)[0]) <= near2
    assert float(boxes.farthest2(point)[0]) >= far2
    assert float(boxes.half2.low[0]) <= half2 <= float(boxes.half2.high[0])
    assert float(boxes.farthest2(point)[0]) <= float(far2) * (1.0 + 1e-13)
    assert float(boxes.nearest2(point)[0]) >= float(near2) - 1e-13 * float(far2)


def test_mixes_fill_slots() -> None:
    """Each box gets its leaf's mix; unused slots, and leaves without a mix, weigh nothing."""
    leaves = make_leaves(3, mix=[1, -1, 0], mixes=({2: 0.25, 0: 0.75}, {1: 1.0}))
    ratio, weight = mix_slots(leaves.chosen(np.array([2, 0, 1])))
    assert ratio[:, 0].tolist() == [2, 0]
    assert weight.tolist() == [[0.25, 1.0, 0.0], [0.75, 0.0, 0.0]]
    none = make_leaves(1, mix=-1, mixes=())
    assert mix_slots(none)[1].tolist() == [[0.0]]
