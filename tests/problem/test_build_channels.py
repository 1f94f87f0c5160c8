"""Where channels other than free space are solved, and where they are refused in words."""

import pytest

from nullpose import UsageError, certificate_of, solve, verify
from nullpose.problem.build import build_family
from nullpose.scenario import Scenario, apply_overrides, load
from scenes import require_fault

URBAN = 'channel={model="elevation", environment="urban", average="%s"}'
PAPER = load("examples/paper.toml")


def test_refused() -> None:
    """What does not know channels says so, and names what it takes."""
    with pytest.raises(UsageError, match="free space, or average"):
        build_family(apply_overrides(PAPER, ["channel={model='power-law', exponent=3.0}"]))


def test_guaranteed_is_free_space_of_other_strength() -> None:
    """It needs nothing of the solver: only the weights change."""
    free, scene = build_family(PAPER), build_family(apply_overrides(PAPER, [URBAN % "guaranteed"]))
    assert len(scene.ratios.channels) == 0
    assert scene.ratios.numerator_weight == pytest.approx(free.ratios.numerator_weight * 0.01)
    assert scene.ratios.denominator_weight == pytest.approx(free.ratios.denominator_weight * 10.0**-0.1)


def test_city_example_is_the_known_answer() -> None:
    """The scene of the paper in a city, 500 m wide: SLSQP from many starts, apart from nullpose."""
    result = solve(load("examples/urban.toml"))
    assert result.objective.value == pytest.approx(8.1689586, rel=2e-5)  # its gain has six digits
    assert result.pose.position_m == pytest.approx([14.097, 224.784, 159.515], abs=0.01)
    assert verify(certificate_of(result)).proved


def test_vertical_and_nulling_axes_follow_the_channel() -> None:
    """Every case is evaluated with the channel, and its bound holds for it."""
    scene = apply_overrides(load("examples/urban.toml"), ["channel.environment=suburban"])
    best = solve(scene, gap=1e-4).objective
    for scheme in ("zero-interference", "maximum-gain", "vertical"):
        found = solve(scene, scheme=scheme, gap=1e-4).objective
        assert found.value <= found.upper_bound
        assert found.value <= best.upper_bound


@pytest.mark.parametrize(("exponent", "is_refused"), [(1.6, True), (2.0, True), (4.0, False)])
def test_the_loudest_is_told_by_its_channel(exponent: float, is_refused: bool) -> None:
    """A jammer is too loud where it arrives so; a steep law lets less of it through."""
    loud = ["jammers.M.power_w=1e17", "airspace.altitude_m=[30.0, 40.0]"]
    channel = f"channel={{model='power-law', exponent={exponent}}}"
    scene: Scenario = apply_overrides(PAPER, [*loud, channel])
    if is_refused:
        require_fault(lambda: build_family(scene, any_channel=True), "jammers[0].power_w", "over the noise")
    else:
        assert len(build_family(scene, any_channel=True).ratios.channels) > 0
