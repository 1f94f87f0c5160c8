"""A scenario small enough to be solved many times."""

from pathlib import Path

import pytest

from nullpose import Scenario, load


@pytest.fixture(scope="session")
def paper() -> Scenario:
    """The paper's scenario."""
    return load(Path(__file__).parents[2] / "examples" / "paper.toml")
