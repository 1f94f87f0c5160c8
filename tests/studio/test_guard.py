"""What a browser may ask for."""

import pytest

from nullpose.studio.guard import Asked, asked_of


def test_what_is_understood_is_taken() -> None:
    """The tab, its colours and its scene."""
    given = {"page": ["a-Z_9"], "dark": ["1"], "card": ["1"], "scene": ["eJw"]}
    assert asked_of(given, "http://here/") == Asked(
        page="a-Z_9", dark=True, card=True, scene="eJw", address="http://here/"
    )


@pytest.mark.parametrize("page", ["", "a b", "a/b", "\u00e9", "a\n", "x" * 65])
def test_what_is_no_name_of_a_tab_is_left_out(page: str) -> None:
    """So are unknown values and colours."""
    assert asked_of({"page": [page], "dark": ["yes"], "more": ["1"]}, "") == Asked()
