"""A scene's channel is drawn key by key, each from a stream of its own."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy import stats

from nullpose import ScenarioError
from nullpose.scenario import Channel
from nullpose.study.monte_carlo import StudySpec, draw_scene, scene_at
from nullpose.study.monte_carlo.distribution import Distribution

Spec = Callable[..., StudySpec]

LAW = {"model": "power-law", "exponent": {"uniform": [2.0, 3.5]}}
LOSSES = {"a": 9.61, "b": 0.16, "los_loss_db": {"uniform": [0, 6]}, "nlos_loss_db": {"uniform": [1, 9]}}
TOWNS = {"model": "elevation", "environment": {"choice": ["suburban", "urban"]}, "average": "power"}


def _channels(spec: Spec, count: int, **keys: Any) -> list[Any]:
    study = spec(scenes=10**6, scene__channel=keys)
    return [draw_scene(study, index).channel for index in range(count)]


@pytest.mark.parametrize(
    ("stated", "mean", "deviation"),
    [
        ({"normal": [3.0, 0.5]}, 3.0, 0.5),
        ({"uniform": [1.0, 4.0]}, 2.5, 3.0 / 12.0**0.5),
        ({"log_uniform": [1.0, 100.0]}, 21.498, 24.970),
        ({"choice": [1.0, 5.0]}, 3.0, 2.0),
    ],
)
def test_draws_have_the_moments_of_what_is_stated(stated: dict, mean: float, deviation: float) -> None:
    """Mean and standard deviation of many draws."""
    drawn = Distribution(**stated).draw(np.random.default_rng(1), 40_000)
    assert [drawn.mean(), drawn.std()] == pytest.approx([mean, deviation], rel=2e-2)


@given(index=st.integers(0, 10**6))
def test_one_key_leaves_the_others(spec: Spec, index: int) -> None:
    """A loss that is drawn beside it leaves the exponent, and the channel leaves the points."""
    plain = draw_scene(spec(scenes=10**7), index)
    alone = draw_scene(spec(scenes=10**7, scene__channel=LAW), index)
    losses = LAW | {"blocked_loss_db": {"uniform": [10.0, 30.0]}}
    both = draw_scene(spec(scenes=10**7, scene__channel=losses), index)
    assert both.channel.exponent == alone.channel.exponent
    assert 10.0 <= both.channel.blocked_loss_db <= 30.0
    assert (both.nodes, both.jammers) == (alone.nodes, alone.jammers) == (plain.nodes, plain.jammers)


def test_numbers_and_names_are_drawn_as_stated(spec: Spec) -> None:
    """An exponent evenly between its ends, each environment as often as another."""
    exponents = [channel.exponent for channel in _channels(spec, 400, **LAW)]
    assert stats.kstest((np.array(exponents) - 2.0) / 1.5, "uniform").pvalue > 0.01
    in_towns = _channels(spec, 400, **TOWNS, exponent=LAW["exponent"])
    assert [channel.exponent for channel in in_towns] == exponents
    names, counts = np.unique([channel.environment for channel in in_towns], return_counts=True)
    assert list(names) == ["suburban", "urban"]
    assert stats.chisquare(counts).pvalue > 0.01


def test_a_known_channel_stays_what_it_is(spec: Spec) -> None:
    """The numbers behind a seed are those of the first release."""
    assert draw_scene(spec(scene__channel=LAW), 5).channel.exponent == pytest.approx(
        2.5981740079149995, abs=1e-12
    )


def test_losses_that_are_no_channel_are_drawn_again(spec: Spec) -> None:
    """No scene has line of sight as the weaker, though some draws have."""
    channels = _channels(spec, 100, model="elevation", average="power", **LOSSES)
    assert all(0.0 <= channel.los_loss_db <= channel.nlos_loss_db for channel in channels)


def test_a_swept_key_takes_the_place_of_its_draw(spec: Spec) -> None:
    """Whether it is drawn or fixed; the other keys keep their draws."""
    law = LAW | {"blocked_loss_db": {"uniform": [10.0, 30.0]}}
    for exponent in (LAW["exponent"], 2.2):
        keys, sweep = law | {"exponent": exponent}, {"channel.exponent": [2.5, 3.0]}
        study = spec(scene__channel=keys, sweep=sweep)
        channels = [scene_at(study, 3, point).channel for point in range(2)]
        assert [channel.exponent for channel in channels] == [2.5, 3.0]
        assert {channel.blocked_loss_db for channel in channels} == {
            draw_scene(study, 3).channel.blocked_loss_db
        }


def test_a_spec_and_back(spec: Spec) -> None:
    """A fixed channel is kept as a scenario has it, a drawn one as what draws it."""
    assert isinstance(spec(scene__channel=LAW | {"exponent": 2.0}).scene.channel, Channel)
    for keys in (LAW, TOWNS):
        study = spec(scene__channel=keys)
        again = StudySpec.from_dict(study.to_dict())
        assert (again, again.digest) == (study, study.digest)
        assert draw_scene(again, 2) == draw_scene(study, 2)


def test_a_drawn_channel_takes_the_place_of_that_of_a_file(spec: Spec) -> None:
    """As drawn points do; one that is not drawn is stated in the file."""
    file = draw_scene(spec(scene__channel={"model": "power-law", "exponent": 5.0}), 0).to_dict()
    study = spec(scene={"scenarios": [file], "channel": LAW})
    assert draw_scene(study, 5).channel == draw_scene(spec(scene__channel=LAW), 5).channel
    with pytest.raises(ScenarioError, match=r"scene\.channel: given together with a file"):
        spec(scene={"scenarios": [file], "channel": {"model": "free-space"}})


@pytest.mark.parametrize(
    ("channel", "path", "words"),
    [
        (LAW | {"exponent": {"uniform": [1.0, 3.0]}}, "exponent.uniform", "got 1.0, must be a path-loss"),
        (LAW | {"exponent": {"unifrom": [2.0, 3.0]}}, "exponent.unifrom", "did you mean"),
        (LAW | {"model": "free-space"}, "exponent", "no meaning"),
        ({"model": "power-law", "blocked_loss_db": {"fixed": 9}}, "exponent", "missing"),
        (TOWNS | {"environment": {"choice": ["urbn"]}}, "environment.choice[0]", 'did you mean "urban"'),
        (TOWNS | {"environment": {"choice": []}}, "environment.choice", "at least one environment"),
        (TOWNS | {"average": "best"}, "average", "must be an average"),
        (TOWNS | {"a": 4.0}, "", "both environment and a are given"),
        (TOWNS | {"model": "elevtion"}, "model", 'did you mean "elevation"'),
        (LAW | {"exponnt": 2.0}, "exponnt", "unknown key"),
    ],
)
def test_a_faulty_draw_is_refused(spec: Spec, channel: dict[str, Any], path: str, words: str) -> None:
    """With one message, by the path of what is wrong."""
    with pytest.raises(ScenarioError) as caught:
        spec(scene__channel=channel)
    (fault,) = caught.value.faults
    assert fault.path == f"scene.channel.{path}".rstrip(".")
    assert words in fault.message
