"""Two sizes of a test: what `make test` takes, and what `make test-random` takes besides."""

from collections.abc import Iterable
from typing import Any

import pytest
from hypothesis import settings

_USUAL = 40  # the examples of the profile of make test


def and_slow(values: Iterable[Any], large: Iterable[Any]) -> list[Any]:
    """Return values for ``parametrize``, the large ones marked slow; a tuple is several arguments."""
    slow = (each if isinstance(each, tuple) else (each,) for each in large)
    return [*values, *(pytest.param(*each, marks=pytest.mark.slow) for each in slow)]


def few_examples(count: int) -> settings:
    """Return settings with few examples in the profile of ``make test``, and four times as many in others."""
    return settings(max_examples=count * (1 if settings.default.max_examples == _USUAL else 4))
