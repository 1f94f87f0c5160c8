"""Frames: the expansions enclose the forms they stand for, in a frame at rest or one that turns."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from sizes import few_examples
from tests.certificate.plain import (
    carried,
    excess_over,
    full,
    link_matrix,
    make_leaves,
    one_box,
    random_family,
    seeds,
)

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.certificate import TOWARDS, WORLD
from nullpose.certificate.forms import COLUMN, ROW
from nullpose.certificate.frames import Frames, constant, expansion, frames_of
from nullpose.certificate.interval import Interval
from nullpose.channel import LinkChannel
from nullpose.problem.family import Family


def framed(family: Family, boxes: Boxes, turning: bool, rng: np.random.Generator) -> Frames:
    """Return the frames of one box, standing still or turning towards some point."""
    point = int(rng.integers(len(family.ratios.points_m)))
    leaves = make_leaves(1, test=TOWARDS if turning else WORLD, point=point if turning else -1)
    return frames_of(family.ratios, leaves, boxes)


@few_examples(10)
@given(turning=st.booleans(), is_above=st.booleans(), seed=seeds)
def test_expansions_enclose_the_forms(
    turning: bool, is_above: bool, channel: LinkChannel | None, seed: int
) -> None:
    """Value, slopes and remainder bound the turned form of every point all over the box."""
    rng = np.random.default_rng(seed)
    family, boxes = random_family(rng, 3, 2, channel=channel), one_box(rng)
    frames = framed(family, boxes, turning, rng)
    basis, gram = frames.basis.middle()[:, :, 0], full(frames.gram)
    steps = rng.uniform(-1.0, 1.0, (3, 3)) * boxes.half[0]
    for j in range(len(family.ratios.points_m)):
        form, bend, _ = expansion(family.ratios, frames, boxes, np.array([j]), is_above)
        anchored = turning and j == frames.anchor[0] and not is_above
        around = full(frames.shape) if anchored else gram
        for x in steps:
            p = boxes.centre[0] + x
            way = (
                carried(frames.turning[0], family.ratios.points_m[frames.anchor[0]], boxes.centre[0], p)
                @ basis
            )
            link = link_matrix(family.ratios.points_m[j] - p, family.ratios.leak) * excess_over(family, p)[j]
            turned = way.T @ link @ way
            error = turned - full(form[:, 0]) - sum(h * full(form[:, 1 + i]) for i, h in enumerate(x))
            error = error if is_above else -error
            slack = 1e-12 * np.abs(turned).max()
            assert np.linalg.eigvalsh(error - bend.high[0] * 0.5 * float(x @ x) * around)[-1] <= slack


@given(seed=seeds)
def test_the_form_at_the_centre_is_exact(seed: int) -> None:
    """Intervals of the value are narrow and hold the form in the basis; an anchor has its null there."""
    rng = np.random.default_rng(seed)
    family, boxes = random_family(rng, 2, 2), one_box(rng)
    frames = framed(family, boxes, True, rng)
    basis = frames.basis.middle()[:, :, 0]
    assert basis.T @ basis == pytest.approx(np.eye(3), abs=1e-14)
    for j in range(4):
        form = expansion(family.ratios, frames, boxes, np.array([j]), True)[0][:, 0]
        exact = basis.T @ link_matrix(family.ratios.points_m[j] - boxes.centre[0], family.ratios.leak) @ basis
        slack = 1e-14 * np.abs(exact).max()
        assert np.all(form.low[:, 0] - slack <= exact[ROW, COLUMN])
        assert np.all(exact[ROW, COLUMN] <= form.high[:, 0] + slack)
        assert np.all(form.high - form.low <= 1e-12 * np.abs(exact).max())


@given(seed=seeds)
def test_turning_rates_are_derivatives(seed: int) -> None:
    """The rate of a turned constant form agrees with differences of the frame that is carried along."""
    rng = np.random.default_rng(seed)
    family, boxes = random_family(rng, 2, 2), one_box(rng)
    frames = framed(family, boxes, True, rng)
    q = rng.normal(size=(3, 3))
    q = q + q.T
    centre, step, basis = boxes.centre[0], 1e-4, frames.basis.middle()[:, :, 0]
    _, slopes = constant(frames, Interval(q[ROW, COLUMN][:, None]))
    for e in range(3):
        anchor_m, way = family.ratios.points_m[frames.anchor[0]], step * np.eye(3)[e]
        ends = [carried(frames.turning[0], anchor_m, centre, centre + s * way) for s in (-1.0, 1.0)]
        change = (ends[1].T @ q @ ends[1] - ends[0].T @ q @ ends[0]) / (2.0 * step)
        assert full(slopes[:, e]) == pytest.approx(basis.T @ change @ basis, abs=1e-7)
