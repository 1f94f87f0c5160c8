"""Scenes that the studio's tests begin with."""

from importlib.util import find_spec

import pytest

from nullpose.scenario import Airspace, Eavesdropper, Jammer, Node, Receiver, Scenario, Transmitter

collect_ignore = (
    [] if find_spec("playwright") else ["browser"]
)  # the page's tests have an environment of their own


@pytest.fixture
def paper() -> Scenario:
    """The paper's section 4: two nodes and one jammer of equal power."""
    return Scenario(
        airspace=Airspace(altitude_m=(8.0, 30.0)),
        receiver=Receiver(noise_w=1e-3, reference_gain_db=0.0),
        nodes=(
            Node(name="S1", position_m=(0.0, 0.0, 0.0), power_w=1.0),
            Node(name="S2", position_m=(0.0, 50.0, 0.0), power_w=1.0),
        ),
        jammers=(Jammer(name="M", position_m=(17.0, 15.0, 4.0), power_w=1.0),),
    )


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
