"""The scenarios that tests of the report share."""

from pathlib import Path

import pytest

from nullpose import Scenario, load

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="session")
def paper() -> Scenario:
    """The paper's scenario."""
    return load(EXAMPLES / "paper.toml")


@pytest.fixture(scope="session")
def field() -> Scenario:
    """The example with ten nodes and two jammers."""
    return load(EXAMPLES / "field.toml")
