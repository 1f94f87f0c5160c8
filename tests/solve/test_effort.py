"""Effort: a proof repairs what a light search misses; without one the search is thorough."""

from nullpose.solve.effort import Effort
from nullpose.solve.limits import Limits


def test_a_proof_lightens_the_search() -> None:
    """With limits, and so a proof, the multistart does less of everything."""
    thorough, light = Effort().search, Effort(limits=Limits(gap=1e-3)).search
    assert light.coarse < thorough.coarse
    assert light.polished < thorough.polished
    assert light.rounds <= thorough.rounds
    assert light.patience <= thorough.patience


def test_nothing_is_proved_unless_asked() -> None:
    """Left out, there is no proof, no progress and the first seed."""
    effort = Effort()
    assert (effort.seed, effort.limits, effort.on_progress) == (0, None, None)
