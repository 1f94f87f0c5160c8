"""Scenes and certificates that the tests of the verifier share."""

from collections.abc import Callable

import numpy as np
import pytest
from tests.certificate.plain import certified, cut_into_cells

from nullpose.certificate import Certificate


@pytest.fixture(scope="session")
def random_scene(random_scene: Callable) -> Callable:
    """Returns a builder: so many nodes and jammers on a field of 100 m, jammed with 30 W."""
    return lambda seed, *counts, **airspace: random_scene(
        np.random.default_rng(seed), *counts, 30.0, **airspace
    )


@pytest.fixture(scope="session")
def celled(paper: Callable) -> Certificate:
    """Returns a certificate some of whose leaves have cells of axes."""
    return cut_into_cells(certified(paper()))


@pytest.fixture(scope="session")
def walled(paper: Callable) -> Certificate:
    """Returns a certificate some of whose leaves use a keep-out ball's multiplier."""
    return certified(paper(keep_out_m=26.5))
