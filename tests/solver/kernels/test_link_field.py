"""The amplitude of a channel over a box, and the rules that bound a link's form."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from nullpose.channel import LinkChannel
from nullpose.channel.power_law import distance_excess, power_law
from nullpose.objectives import Ratios
from nullpose.solver.kernels.bounds import link_field
from nullpose.solver.kernels.compiler.interpreted import python_of

amplitude, anchor_fall, fall_of, rise_of, scaled_inverse, turned = (
    python_of(getattr(kernel, "py_func", kernel))
    for kernel in (
        link_field.amplitude,
        link_field.anchor_fall,
        link_field.fall_of,
        link_field.rise_of,
        link_field.scaled_inverse,
        link_field.turned,
    )
)

POINT = np.array([[17.0, 15.0, 4.0]])
SAMPLES = 4_000


def roots(channel: LinkChannel | None, positions_m: np.ndarray, law_alone: bool = False) -> np.ndarray:
    """Return the amplitude at positions, (..., 3), from the model; or its factor by distance alone."""
    x, y, z = np.moveaxis(positions_m - POINT[0], -1, 0)
    level = np.hypot(x, y)
    if channel is None:
        return np.ones(level.shape)
    excess = distance_excess if law_alone else channel.excess
    return np.sqrt(excess(channel.row, np.hypot(level, z), np.arctan2(z, level), 0.0))


@pytest.mark.parametrize("boxes", [40, pytest.param(250, marks=pytest.mark.slow)])
@pytest.mark.parametrize("is_above", [True, False])
def test_an_amplitude_encloses_samples(
    is_above: bool, boxes: int, channel: LinkChannel | None, ratios_over: Callable[..., Ratios]
) -> None:
    """Its value is that at the centre, or with a valid end of the factor by elevation all over the box.

    Slopes and second differences are within bounds.
    """
    rng, ratios = np.random.default_rng(11), ratios_over(POINT, 0.0, channel=channel)
    ends = 0
    for _ in range(boxes):
        centre = POINT[0] + rng.normal(size=3) * 10.0 ** rng.uniform(0.5, 2.0)
        reach = np.linalg.norm(centre - POINT[0])
        half = reach * 10.0 ** rng.uniform(-4.0, -1.0, size=3)
        field = amplitude(ratios, 0, is_above, centre, half)
        samples = centre + rng.uniform(-1.0, 1.0, (SAMPLES, 3)) * half
        off = abs(field.value - roots(channel, centre)) > 1e-14 * field.value
        is_end = channel is not None and (off or field.slope == 0.0)
        ends, sign = ends + is_end, 1.0 if is_above else -1.0
        share = field.value / float(roots(channel, centre, is_end))
        h = share * roots(channel, samples, is_end)
        assert np.all(sign * roots(channel, samples) <= sign * h * (1.0 + sign * 1e-12))
        assert np.max(h) <= field.most * (1.0 + 1e-12)
        assert math.hypot(*field.gradient) <= field.slope * (1.0 + 1e-9)
        # by the mean value theorem between neighbours, and by Taylor's from the centre
        step = samples - centre
        size = np.linalg.norm(step, axis=1)
        slack = 1e-12 * field.most
        assert np.all(np.abs(h - field.value) <= field.slope * size + slack)
        taylor = h - field.value - step @ np.array(field.gradient)
        assert np.all(np.abs(taylor) <= 0.5 * field.bend * size**2 + slack)
        others = rng.permutation(samples)
        at_others, between = (share * roots(channel, p, is_end) for p in (others, 0.5 * (samples + others)))
        slopes = np.abs(h - at_others) - field.slope * np.linalg.norm(samples - others, axis=1)
        assert np.all(slopes <= slack)
        bends = h + at_others - 2.0 * between
        assert np.all(np.abs(bends) <= 0.25 * field.bend * np.sum((samples - others) ** 2, axis=1) + slack)
    assert ends < boxes


def test_the_rules_give_the_lemmas_of_free_space(ratios_over: Callable) -> None:
    """At rest 6 and 4 over a^4; in a turning frame what lemma 2 adds; of the anchor 6 and 2."""
    a, rho = 20.0, 30.0
    field = amplitude(ratios_over(POINT, 0.0), 0, True, POINT[0] + [a, 0.0, 0.0], np.zeros(3))
    reach = scaled_inverse(field, a)
    assert rise_of(reach, reach) == pytest.approx(6.0 / a**4)
    assert fall_of(reach) == pytest.approx(4.0 / a**4)
    assert anchor_fall(field, a) == pytest.approx(2.0 / a**4)
    seen = turned(reach, 1.0 / rho)
    swing = 2.0 / math.sqrt(3.0)
    assert rise_of(reach, seen) == pytest.approx(
        6.0 / a**4 + 4.0 / (a**3 * rho) + (1.0 + swing) / (a * rho) ** 2, rel=1e-4
    )
    assert seen.bend == pytest.approx(2.0 / a**3 + 2.0 / (a**2 * rho) + swing / (a * rho**2), rel=1e-4)


def test_a_power_law_has_the_exact_rise(ratios_over: Callable[..., Ratios]) -> None:
    """The second derivative of ``|r|^-alpha`` is at most ``alpha (alpha + 1) / a^(alpha + 2)``."""
    a = 20.0
    for alpha in (2.0, 2.5, 4.0, 6.0):
        ratios = ratios_over(POINT, 0.0, channel=power_law(alpha, 1.0))
        field = amplitude(ratios, 0, True, POINT[0] + [a, 0.0, 0.0], np.zeros(3))
        reach = scaled_inverse(field, a)
        assert rise_of(reach, reach) == pytest.approx(alpha * (alpha + 1.0) / a ** (alpha + 2.0))
