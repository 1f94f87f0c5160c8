"""Channels of several points."""

import numpy as np
import pytest

from nullpose.channel import CHANNELS, ENVIRONMENTS, PointChannels, excess_gain

CASES = [
    CHANNELS["free-space"].make(is_interferer=False),
    CHANNELS["power-law"].make(exponent=3.0, reference_distance_m=2.0, is_interferer=False),
    *(
        CHANNELS["elevation"].make(**ENVIRONMENTS["urban"]._asdict(), average=average, is_interferer=False)
        for average in ("power", "db", "guaranteed")
    ),
    CHANNELS["elevation"].make(
        **ENVIRONMENTS["suburban"]._asdict(),
        average="power",
        exponent=2.7,
        reference_distance_m=3.0,
        is_interferer=False,
    ),
]


@pytest.mark.parametrize("shape", [(), (4,), (2, 3)])
def test_points_of_any_channel_together(shape: tuple[int, ...]) -> None:
    """Each point has the gain of its own channel, whatever stands beside it."""
    rng = np.random.default_rng(5)
    links = [CASES[place] for place in (3, 0, 1, 2, 5, 4, 1, 3)]
    away_m = rng.uniform([-90.0, -90.0, -80.0], [90.0, 90.0, -10.0], (*shape, len(links), 3))
    together = excess_gain(PointChannels.of(links), away_m)
    assert together.shape == (*shape, len(links))
    for place, link in enumerate(links):
        alone = excess_gain(PointChannels.of([link]), away_m[..., place, None, :])
        np.testing.assert_allclose(together[..., place, None], alone, rtol=1e-14)


@pytest.mark.parametrize("channel", CASES[2:5])
def test_strength_is_the_largest_gain(channel: object) -> None:
    """The excess gain by elevation is never above 1, and grows with the elevation."""
    away_m = np.array([[[100.0, 0.0, -up_m]] for up_m in (0.0, 1.0, 30.0, 100.0, 1e3, 1e7)])
    gain = excess_gain(PointChannels.of([channel]), away_m)[:, 0]
    assert np.all(np.diff(gain) >= 0.0)
    assert gain[-1] <= channel.strength
