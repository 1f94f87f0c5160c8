"""Scenes that the studio's tests begin with."""

from importlib.util import find_spec

import pytest

from nullpose.scenario import Eavesdropper, Node, Scenario, Transmitter, load

collect_ignore = (
    [] if find_spec("playwright") else ["browser"]
)  # the page's tests have an environment of their own


@pytest.fixture
def paper() -> Scenario:
    """The paper's section 4: two nodes and one jammer of equal power."""
    return load("examples/paper.toml").model_copy(update={"name": ""})


@pytest.fixture
def secret(paper: Scenario) -> Scenario:
    """A downlink with one eavesdropper."""
    return Scenario(
        objective="secrecy-rate",
        airspace=paper.airspace,
        receiver=paper.receiver,
        transmitter=Transmitter(power_w=1.0),
        nodes=(Node(name="S1", position_m=(0.0, 0.0, 0.0)),),
        eavesdroppers=(Eavesdropper(name="E", position_m=(17.0, 15.0, 4.0)),),
    )


@pytest.fixture
def unsure(paper: Scenario) -> Scenario:
    """The paper's scene with a jammer that is known up to two metres."""
    jammer = paper.jammers[0].model_copy(update={"uncertainty_m": 2.0})
    return paper.model_copy(update={"jammers": (jammer,)})
