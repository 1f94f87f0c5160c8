"""The random scenes with errors that robust poses are checked on."""

from benchmarks.soundness.robust import make_robust_scene


def test_every_scene_is_allowed_and_uncertain() -> None:
    """No number makes a scene that the scenario's own checks refuse."""
    assert all(make_robust_scene(number).is_uncertain for number in range(40))
