"""One coarse reproduction for all the tests of the paper's replication."""

from pathlib import Path

import pytest

from nullpose import Scenario, load
from nullpose.paper.pages import Reproduction
from nullpose.paper.reproduce import reproduce


@pytest.fixture(scope="session")
def paper() -> Scenario:
    """The paper's scenario."""
    return load(Path(__file__).parents[2] / "examples" / "paper.toml")


@pytest.fixture(scope="session")
def reproduction(tmp_path_factory: pytest.TempPathFactory) -> Reproduction:
    """The paper's figures and claims from two jamming levels a decade."""
    levels = [10.0 ** (exponent / 2) for exponent in range(-6, 13)]
    folder = tmp_path_factory.mktemp("reproduction")
    return reproduce(folder, levels=levels, printed_levels=[1e-3, 1.0, 1e5, 1e6])
