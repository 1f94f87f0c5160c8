"""The paper's scenario for all the tests of its replication."""

from pathlib import Path

import pytest

from nullpose import Scenario, load


@pytest.fixture(scope="session")
def paper() -> Scenario:
    """The paper's scenario."""
    return load(Path(__file__).parents[2] / "examples" / "paper.toml")
