"""A scene below a notebook's cell, or in the browser."""

import sys

import pytest

import nullpose
from nullpose.scenario import Scenario


def test_without_viser_it_says_how_to_get_it(paper: Scenario, monkeypatch: pytest.MonkeyPatch) -> None:
    """As an error of nullpose, before anything is solved."""
    monkeypatch.setitem(sys.modules, "viser", None)
    with pytest.raises(nullpose.UsageError, match=r"nullpose\[studio\]"):
        nullpose.show(paper)
