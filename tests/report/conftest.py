"""One coarse reproduction for all the tests of the report, and the scenarios they share."""

from pathlib import Path

import pytest

from nullpose import Scenario, load
from nullpose.report.reproduce import Reproduction, reproduce

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="session")
def paper() -> Scenario:
    """The paper's scenario."""
    return load(EXAMPLES / "paper.toml")


@pytest.fixture(scope="session")
def field() -> Scenario:
    """The example with ten nodes and two jammers."""
    return load(EXAMPLES / "field.toml")


@pytest.fixture(scope="session")
def reproduction(tmp_path_factory: pytest.TempPathFactory) -> Reproduction:
    """The paper's figures and claims from two jamming levels a decade."""
    levels = [10.0 ** (exponent / 2) for exponent in range(-6, 13)]
    folder = tmp_path_factory.mktemp("reproduction")
    return reproduce(folder, levels=levels, printed_levels=[1e-3, 1.0, 1e5, 1e6])
