"""The schemes: names, order, and where they have no meaning."""

from collections.abc import Callable

import pytest

from nullpose.errors import UsageError
from nullpose.problem.schemes import RECORDS, Scheme, as_scheme


def test_names_are_a_contract() -> None:
    """The schemes' names are what files and command lines say."""
    assert [scheme.value for scheme in Scheme] == ["optimum", "zero-interference", "maximum-gain", "vertical"]
    assert len({scheme.label for scheme in Scheme}) == len(Scheme)
    assert [scheme.record.name for scheme in Scheme] == list(RECORDS)


@pytest.mark.parametrize("name", ["best", "Optimum", "", "zero_interference", "maximum-gain-printed"])
def test_an_unknown_name_is_refused(name: str) -> None:
    """Another name is refused with what was given and every name that is allowed."""
    with pytest.raises(UsageError) as raised:
        as_scheme(name)
    assert repr(name) in str(raised.value)
    for scheme in Scheme:
        assert scheme.value in str(raised.value)


def test_zero_interference_needs_a_jammer(scene: Callable) -> None:
    """Without a jammer there is nothing to point the null at; with any number there is."""
    nodes = [(0, 0, 0), (0, 50, 0)]
    assert "needs a jammer" in Scheme.ZERO_INTERFERENCE.not_applicable(scene(nodes))
    for jammers in ([(9, 9, 1)], [(9, 9, 1), (20, 9, 1)]):
        assert Scheme.ZERO_INTERFERENCE.not_applicable(scene(nodes, jammers)) is None
