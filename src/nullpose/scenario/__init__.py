"""What the user states: nodes, jammers, receiver and airspace, in files or in Python."""

from nullpose.scenario.airspace import Airspace
from nullpose.scenario.ground_points import GroundPoint, Jammer, Node
from nullpose.scenario.json_schema import json_schema
from nullpose.scenario.loading import load
from nullpose.scenario.overrides import Override, apply_overrides, parse_override
from nullpose.scenario.receiver import Receiver
from nullpose.scenario.scenario import Scenario

__all__ = [
    "Airspace",
    "GroundPoint",
    "Jammer",
    "Node",
    "Override",
    "Receiver",
    "Scenario",
    "apply_overrides",
    "json_schema",
    "load",
    "parse_override",
]
