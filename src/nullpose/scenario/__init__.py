"""What the user states: nodes, jammers, receiver and airspace, in files or in Python."""

from nullpose.scenario.airframe import Airframe
from nullpose.scenario.airspace import Airspace
from nullpose.scenario.antenna import Antenna, Array
from nullpose.scenario.buildings import Building
from nullpose.scenario.channel import Channel
from nullpose.scenario.ground_points import (
    Destination,
    Eavesdropper,
    GroundPoint,
    Jammer,
    Node,
    Source,
    Terminal,
)
from nullpose.scenario.json_schema import json_schema
from nullpose.scenario.loading import load
from nullpose.scenario.motion import Time
from nullpose.scenario.no_fly import NoFlyZone
from nullpose.scenario.origin import Origin
from nullpose.scenario.overrides import Override, apply_overrides, parse_override
from nullpose.scenario.plausibility import doubts
from nullpose.scenario.radio import Receiver, Transmitter
from nullpose.scenario.scenario import Scenario

__all__ = [
    "Airframe",
    "Airspace",
    "Antenna",
    "Array",
    "Building",
    "Channel",
    "Destination",
    "Eavesdropper",
    "GroundPoint",
    "Jammer",
    "NoFlyZone",
    "Node",
    "Origin",
    "Override",
    "Receiver",
    "Scenario",
    "Source",
    "Terminal",
    "Time",
    "Transmitter",
    "apply_overrides",
    "doubts",
    "json_schema",
    "load",
    "parse_override",
]
