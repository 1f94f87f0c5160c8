"""Sizes of a test: what `make test` takes, the whole grid that CI takes, and the large sizes."""

from collections.abc import Collection, Iterable, Sequence
from itertools import product
from typing import Any

import pytest
from hypothesis import settings

_USUAL = 40  # the examples of the profile of make test


def and_slow(values: Iterable[Any], large: Iterable[Any]) -> list[Any]:
    """Return values for ``parametrize``, the large ones marked slow; a tuple is several arguments."""
    slow = (each if isinstance(each, tuple) else (each,) for each in large)
    return [*values, *(pytest.param(*each, marks=pytest.mark.slow) for each in slow)]


def diagonal(*axes: Sequence[Any]) -> list[Any]:
    """Return all combinations for ``parametrize``; those that `make test` leaves out are marked grid.

    It takes as many as the longest axis has values, so that each value of each axis occurs.
    """
    kept = {tuple(i % len(axis) for axis in axes) for i in range(max(map(len, axes)))}
    places = product(*(range(len(axis)) for axis in axes))
    return [_in_grid([axis[i] for axis, i in zip(axes, at, strict=True)], at in kept) for at in places]


def chosen(values: Iterable[Any], kept: Collection[int]) -> list[Any]:
    """Return values for ``parametrize``, all but those at some places marked grid; a tuple is arguments."""
    listed = (each if isinstance(each, tuple) else (each,) for each in values)
    return [_in_grid(each, place in kept) for place, each in enumerate(listed)]


def _in_grid(values: Iterable[Any], is_kept: bool) -> Any:
    return pytest.param(*values, marks=() if is_kept else pytest.mark.grid)


def few_examples(count: int) -> settings:
    """Return settings with few examples in the profile of ``make test``, and four times as many in others."""
    return settings(max_examples=count * (1 if settings.default.max_examples == _USUAL else 4))
