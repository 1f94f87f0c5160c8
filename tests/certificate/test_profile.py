"""The gain of an antenna that is the same all round, and its bounds."""

from fractions import Fraction

import numpy as np
import pytest
from numpy.polynomial import legendre

from nullpose.antenna.dipoles import half_wave_harmonics
from nullpose.certificate.interval import Interval
from nullpose.certificate.profile import Profile, ProfileField
from nullpose.scenario import Scenario, apply_overrides, load

HALF_WAVE = half_wave_harmonics().cosine[:, 0] * np.sqrt(2.0 * np.arange(15) + 1.0)
DRAWN = np.random.default_rng(3).normal(size=31) / (1.0 + np.arange(31.0)) ** 2


@pytest.fixture(params=[HALF_WAVE, DRAWN], ids=["half-wave", "drawn"])
def weights(request: pytest.FixtureRequest) -> np.ndarray:
    """Return weights of Legendre polynomials."""
    return np.asarray(request.param)


@pytest.mark.parametrize("order", [0, 1, 2])
def test_bounds_contain_samples(weights: np.ndarray, order: int) -> None:
    """Values and derivatives within a range, and at single cosines."""
    profile, rng = Profile(weights), np.random.default_rng(order)
    wanted = legendre.legder(weights, order) if order else weights
    low = rng.uniform(-1.1, 1.0, 400)
    high = low + 10.0 ** rng.uniform(-6.0, 0.3, 400)
    bounds = profile.within(order, Interval(low, high))
    samples = np.clip(low + (high - low) * np.linspace(0.0, 1.0, 40)[:, None], -1.0, 1.0)
    values = legendre.legval(samples, wanted)
    slack = 1e-9 * np.max(np.abs(values))
    assert np.all(values >= bounds.low - slack)
    assert np.all(values <= bounds.high + slack)
    exact = profile.near(order, Interval(samples[0]))
    assert np.all(np.abs(values[0] - exact.middle()) <= slack)
    assert np.all(exact.high - exact.low <= slack)


def test_the_half_wave_dipole() -> None:
    """The polynomial is that of the textbook, in exact arithmetic, and the peak is a bound."""
    profile = Profile(HALF_WAVE)
    for cosine in (0.0, 0.3, -0.3, 0.9):
        wanted = np.cos(0.5 * np.pi * cosine) ** 2 / (1.0 - cosine**2)
        assert float(profile.exact(Fraction(cosine))) == pytest.approx(wanted, abs=1e-10)
    assert 1.0 <= profile.peak <= 1.0 + 1e-6


def test_what_an_airframe_reaches() -> None:
    """The ends are the mount's angle less and more the tilt; without an airframe every angle is reached."""
    data = load("examples/paper.toml").to_dict() | {"antenna": {"kind": "half-wave"}}
    scenario = Scenario.from_dict(data)
    tilted = apply_overrides(scenario, ["airframe.tilt_max_deg=20", "airframe.mount_deg=30"])
    wanted = [(np.sin(angle), np.cos(angle)) for angle in np.radians([10.0, 50.0])]
    np.testing.assert_allclose(ProfileField.of(tilted.antenna_record, tilted).ends, wanted, atol=1e-15)
    every = ProfileField.of(scenario.antenna_record, scenario).ends
    np.testing.assert_allclose(every, [(0.0, 1.0), (0.0, -1.0)], atol=1e-15)
