"""The paper's scenario inside the package is the one in the examples."""

import pytest

from nullpose import Scenario
from nullpose.paper.scene import (
    JAMMER_POWER,
    JAMMING_LEVELS,
    POSE_LEVELS,
    PRINTED_LEVELS,
    paper_scenario,
)
from nullpose.scenario import Override, apply_overrides


def test_it_is_the_example(paper: Scenario) -> None:
    """Both state the same."""
    assert paper_scenario() == paper


def test_jamming_level_is_the_power_ratio(paper: Scenario) -> None:
    """With nodes of 1 W, P_M/P is the jammer's power in watts."""
    assert apply_overrides(paper, [Override(JAMMER_POWER, 0.3)]).jammer_powers_w == pytest.approx([0.3])


def test_levels_cover_the_figure() -> None:
    """Both curves go from 1e-3 to 1e6, and the poses are drawn at levels that the sweep has."""
    for levels in (JAMMING_LEVELS, PRINTED_LEVELS):
        assert (levels[0], levels[-1]) == (1e-3, 1e6)
        assert list(levels) == sorted(set(levels))
    assert set(POSE_LEVELS) <= set(JAMMING_LEVELS)
    assert set(PRINTED_LEVELS) <= set(JAMMING_LEVELS)
