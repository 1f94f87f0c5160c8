"""Small sound certificates of each kind, to be changed."""

from __future__ import annotations

import json
from typing import Any

from benchmarks.mutations.truth import Data
from nullpose.certificate import certificate_text
from nullpose.scenario import Scenario
from nullpose.solver import solve
from nullpose.solver.certificate_from_proof import certificate_of

_TIME_S = 600.0  # the kernels may have to be compiled first
_SQUARE = {"x_m": [-20.0, 30.0], "y_m": [5.0, 60.0]}


def _scene(jamming_w: float = 1.0, **tables: Any) -> dict[str, Any]:
    return {
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "nodes": [
            {"position_m": [0.0, 0.0, 0.0], "power_w": 1.0},
            {"position_m": [0.0, 50.0, 0.0], "power_w": 1.0},
        ],
        "jammers": [{"name": "M", "position_m": [17.0, 15.0, 4.0], "power_w": jamming_w}],
    } | tables


def _within(**airspace: Any) -> dict[str, Any]:
    return {"airspace": {"altitude_m": [8.0, 30.0]} | airspace}


_THREE = {
    "nodes": [
        {"position_m": place, "power_w": power}
        for place, power in (([0.0, 0.0, 0.0], 1.0), ([40.0, 5.0, 2.0], 2.0), ([10.0, 40.0, 1.0], 0.5))
    ]
}
_TWO_JAMMERS = {
    "jammers": [
        {"name": "M", "position_m": [17.0, 15.0, 4.0], "power_w": 1.0},
        {"name": "M1", "position_m": [30.0, 30.0, 0.0], "power_w": 0.3},
    ]
}
_HEARD = {
    "objective": "secrecy-rate",
    "transmitter": {"power_w": 1.0},
    "nodes": [{"position_m": [0.0, 0.0, 0.0]}, {"position_m": [0.0, 50.0, 0.0]}],
    "jammers": [],
    "eavesdroppers": [{"position_m": [17.0, 15.0, 4.0]}, {"position_m": [-30.0, 20.0, 0.0]}],
}
_JAMMED = {
    "objective": "friendly-jamming",
    "transmitter": {"power_w": 3.0},
    "sources": [
        {"position_m": [0.0, 0.0, 0.0], "power_w": 1.0},
        {"position_m": [9.0, 0.0, 0.0], "power_w": 2.0},
    ],
    "nodes": [{"position_m": [20.0, 5.0, 0.0], "from": "A1"}, {"position_m": [5.0, 25.0, 0.0], "from": "A2"}],
    "jammers": [],
    "eavesdroppers": [{"position_m": [35.0, 28.0, 0.0]}, {"position_m": [-30.0, 20.0, 0.0]}],
}
_RELAY = {
    "transmitter": {"power_w": 0.5},
    "destination": {"position_m": [35.0, 40.0, 0.0], "noise_w": 1e-3},
}
_FENCE = [[-20.0, -5.0], [40.0, -5.0], [10.0, 25.0], [40.0, 60.0], [-20.0, 60.0]]
_ZONES = [
    {"centre_m": [-2.0, 24.0], "radius_m": 5.0, "altitude_m": [0.0, 12.0]},
    {"polygon_m": [[-20.0, 10.0], [-6.0, 12.0], [-9.0, 20.0], [-6.0, 35.0], [-20.0, 40.0]]},
]
_WEIGHTED = [
    {"position_m": [0.0, 0.0, 0.0], "power_w": 1.0, "weight": 0.5},
    {"position_m": [0.0, 50.0, 0.0], "power_w": 1.0, "min_sinr_db": 3.0},
]
_WHIPS = [
    {"position_m": [0.0, 0.0, 0.0], "power_w": 1.0, "antenna": "dipole"},
    {"position_m": [0.0, 50.0, 0.0], "power_w": 1.0, "antenna": "circular"},
]
_TILTED = [
    {"name": "M", "position_m": [17.0, 15.0, 4.0], "power_w": 1.0, "antenna": "dipole"}
    | {"antenna_axis": [0.3, -0.4, 0.5]}
]

_LAW = {"model": "power-law", "exponent": 3.0}
_SUBURB = {"model": "elevation", "environment": "suburban", "average": "power"}
_CITY = {
    "model": "elevation",
    "average": "db",
    "a": 9.61,
    "b": 0.16,
    "los_loss_db": 1.0,
    "nlos_loss_db": 20.0,
}
_QUIET = {"receiver": {"noise_w": 4e-5, "reference_gain_db": 0.0}}
_OWN = [
    {"position_m": [0.0, 0.0, 0.0], "power_w": 1.0, "channel": _SUBURB},
    {"position_m": [0.0, 50.0, 0.0], "power_w": 1.0, "antenna": "dipole"},
]

_ROUND = [[0.0, 20.0, 25.0, 4.0], [1.0, 0.0, 40.0, 4.0], [2.0, -20.0, 25.0, 4.0], [3.0, 0.0, 10.0, 4.0]]
_MOVING = {
    "time": {"duration_s": 3.0, "step_s": 1.0},
    "jammers": [{"name": "M", "track": _ROUND, "power_w": 1.0}],
}
_OVERHEARD = {"eavesdroppers": [{"track": [[0.0, 40.0, -9.0, 4.0], [3.0, 25.0, 45.0, 4.0]]}]}
_LEANING, _LEVEL = {"tilt_max_deg": 20.0, "mount_deg": 30.0}, {"preset": "level", "mount_deg": 0.0}
_UNEVEN = {"kind": "pattern", "harmonics": [[1.0], [0.3, 0.0, 0.0], [-0.3, 0.0, 0.0, 0.0, 0.0]]}

KINDS: dict[str, list[tuple[str, float, dict[str, Any]]]] = {
    "free axis": [
        ("optimum", 0.2, _scene(10.0)),
        ("optimum", 0.3, _scene() | _THREE),
        ("optimum", 0.02, _scene() | _within(keep_out_m=26.5)),
    ],
    "airframe": [
        ("optimum", 0.2, _scene(10.0, airframe=_LEANING)),
        ("optimum", 0.2, _scene(0.1, airframe={"preset": "level", "mount_deg": 90.0})),
    ],
    "secrecy rate": [
        ("optimum", 0.1, _scene() | _HEARD),
        ("optimum", 0.3, _scene() | _HEARD | _within(**_SQUARE)),
    ],
    "zones and fence": [
        ("optimum", 0.05, _scene() | _within(geofence_m=_FENCE, no_fly=_ZONES)),
        ("vertical", 0.4, _scene() | _within(geofence_m=_FENCE, no_fly=_ZONES)),
    ],
    "given axis": [
        ("zero-interference", 0.8, _scene() | _THREE | _TWO_JAMMERS),
        ("vertical", 0.4, _scene()),
        ("maximum-gain", 0.4, _scene() | _within(**_SQUARE)),
    ],
    "margins": [("optimum", 0.2, _scene(nodes=_WEIGHTED) | _within(**_SQUARE))],
    "profiles": [
        ("optimum", 0.3, _scene(antenna={"kind": "half-wave"}) | _within(**_SQUARE)),
        ("optimum", 0.5, _scene(0.1, antenna=_UNEVEN, airframe=_LEANING) | _within(**_SQUARE)),
        ("optimum", 0.5, _scene(0.1, antenna=_UNEVEN, airframe=_LEVEL) | _within(**_SQUARE)),
        ("optimum", 0.3, _scene(antenna={"kind": "half-wave"}) | _HEARD | _within(**_SQUARE)),
    ],
    "dipoles": [
        ("optimum", 0.3, _scene(0.1, nodes=_WHIPS, antenna={"null_depth_db": 25.0})),
        ("optimum", 0.5, _scene(jammers=_TILTED)),
        ("vertical", 0.4, _scene(nodes=_WHIPS, jammers=_TILTED)),
    ],
    "channels": [
        ("optimum", 0.2, _scene(channel=_LAW) | _QUIET),
        ("optimum", 0.1, _scene(channel=_LAW | {"exponent": 1.6}) | _within(keep_out_m=26.5)),
        ("optimum", 0.5, _scene(channel=_SUBURB, antenna={"null_depth_db": 25.0}) | _within(**_SQUARE)),
        ("optimum", 0.2, _scene(channel=_SUBURB) | _HEARD | _within(**_SQUARE)),
        ("optimum", 0.8, _scene(0.1, channel=_LAW, nodes=_OWN) | _QUIET | _within(**_SQUARE)),
        ("vertical", 1.5, _scene(channel=_CITY) | _within(**_SQUARE)),
        ("optimum", 0.5, _scene(channel=_SUBURB | {"exponent": 2.7}) | _QUIET | _within(**_SQUARE)),
        ("zero-interference", 0.1, _scene(channel=_LAW | {"exponent": 2.5}) | _within(**_SQUARE)),
    ],
    "sums and means": [
        ("optimum", 0.1, _scene(10.0, objective="sum-rate")),
        ("optimum", 0.2, _scene(objective="sum-rate", nodes=_WEIGHTED) | _within(**_SQUARE)),
        ("optimum", 0.2, _scene(objective="proportional-fair") | _THREE),
        ("vertical", 0.4, _scene(objective="proportional-fair", nodes=_WEIGHTED)),
        ("optimum", 0.3, _scene(0.1, objective="sum-rate", nodes=_WHIPS, airframe=_LEANING)),
    ],
    "the drone sends": [
        ("optimum", 0.1, _scene(objective="downlink", transmitter={"power_w": 1.0})),
        ("optimum", 0.2, _scene(objective="relay") | _RELAY),
        ("vertical", 0.3, _scene(objective="relay", channel=_LAW) | _RELAY | _within(**_SQUARE)),
    ],
    "friendly jamming": [
        ("optimum", 0.05, _scene() | _JAMMED | _within(x_m=[-40.0, 60.0], y_m=[-40.0, 60.0])),
        ("vertical", 0.3, _scene() | _JAMMED | _within(**_SQUARE)),
    ],
    "held poses": [
        ("optimum", 0.5, _scene() | _MOVING | _within(**_SQUARE)),
        ("optimum", 0.5, _scene(airframe=_LEVEL) | _MOVING | _within(keep_out_m=9.0)),
        ("optimum", 0.8, _scene(airframe=_LEANING, channel=_LAW) | _QUIET | _MOVING | _within(**_SQUARE)),
        ("optimum", 0.5, _scene(airframe=_LEVEL) | _MOVING | _HEARD | _OVERHEARD | _within(**_SQUARE)),
    ],
}
"""Scheme, gap and scenario of the certificates of each kind."""


def bases_of(kind: str) -> list[Data]:
    """Return the certificates of a kind as data."""
    return [_data(scheme, gap, tables) for scheme, gap, tables in KINDS[kind]]


def optima_of(kind: str) -> list[Data]:
    """Return certificates of the same claims whose poses are best to 1e-6, or not quite."""
    gap = {
        "profiles": 0.1,
        "friendly jamming": 1e-4,
        "zones and fence": 1e-5,
        "channels": 1e-3,
        "held poses": 1e-3,
    }.get(kind, 1e-6)
    return [_data(scheme, gap, tables) for scheme, _, tables in KINDS[kind]]


def _data(scheme: str, gap: float, tables: dict[str, Any]) -> Data:
    scenario = Scenario.from_dict(tables)
    is_held = scenario.time is not None
    solution = solve(scenario, scheme, hover=is_held, gap=gap, time_limit_s=_TIME_S)
    data: Data = json.loads(certificate_text(certificate_of(solution)))
    return data
