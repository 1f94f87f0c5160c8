"""From a scenario to its family: where names and units end."""

from __future__ import annotations

import numpy as np

from nullpose.channel.model import largest_excess_gain
from nullpose.errors import require_usage
from nullpose.objectives import USUAL, FloatArray, IntArray
from nullpose.problem.airspace import airspace_zones
from nullpose.problem.family import Family
from nullpose.scenario import Scenario
from nullpose.scenario.faults import refusal

LOUDEST = 1e16
"""The largest ratio of an interferer's power to the noise, without a null, that is solved."""


def build_family(
    scenario: Scenario,
    *,
    any_antenna: bool = False,
    any_channel: bool = False,
    any_function: bool = False,
    any_objective: bool = False,
) -> Family:
    """Build the family whose smallest ratio or pair, or mean of ratios, is what the scenario maximises.

    The objective's record says which ratios these are (:mod:`nullpose.objectives`).

    Args:
        scenario: its units and names end here.
        any_antenna: whether the caller brings the gain of an antenna that is no dipole.
        any_channel: whether the caller knows every channel model.
        any_function: whether the caller brings the gain of channels that are functions in Python.
        any_objective: whether the caller knows means of ratios, and pairs.

    Raises:
        UsageError: the antenna is no dipole, or a channel or the objective is not known to the caller.
        ScenarioError: a jammer or an eavesdropper's signal is too strong for floating-point numbers.
    """
    require_usage(
        any_antenna or scenario.antenna_record.is_quadratic,
        f"antenna: given a {scenario.antenna_record.label}; allowed here: a dipole. For other antennas "
        "there are solve, evaluate and antenna compare",
    )
    require_usage(
        any_channel or not scenario.has_channels,
        "channel: given a power law or line of sight by elevation; allowed here: free space, or average "
        '= "guaranteed"; solve and evaluate know every channel',
    )
    require_usage(
        any_function or not scenario.has_custom_channels,
        "channel: given a function in Python; allowed here: the channels that a file can state. There "
        "are solve, compare and evaluate for functions",
    )
    record = scenario.objective_record
    require_usage(
        record.of_nodes is None,
        f"objective: given {record.name}, a function in Python; allowed here: the objectives that a file can "
        "state. solve, compare and evaluate know functions, for a dipole",
    )
    ratios = record.ratios(scenario)
    require_usage(
        any_objective or (record.mean_offset is None and not len(ratios.pairs)),
        f'objective: given "{record.name}"; allowed here: those of the smallest ratio, such as "{USUAL}". '
        "solve, compare, sweep, map, vehicle and evaluate know it for a dipole, in channels a file can state",
    )
    ratios = ratios._replace(leak=scenario.antenna_record.leak)
    if record.mean_offset is not None:
        required = scenario.node_requirements
        require_usage(
            len(ratios.denominator_isotropic) == 1,
            f'objective: the ratios of "{record.name}" have several denominators; '
            "a mean is proved with one alone; put what differs, such as a node's noise, into the numerators",
        )
        ratios = ratios._replace(
            shares=scenario.node_shares,
            offset=record.mean_offset,
            requirements=required[: len(required) * bool(np.any(required))],
        )
    family = Family(**ratios._asdict(), **domain_of(scenario, ratios.points_m))
    _refuse_the_loudest(scenario, family)
    return family


def _refuse_the_loudest(scenario: Scenario, family: Family) -> None:
    """Raise a ScenarioError if doubles cannot tell an interferer's null from the noise."""
    channels = scenario.of_interferers("channels")
    if (
        channels is None
        and not (family.ratios.denominator_weight > LOUDEST * family.domain.keep_out_m**2).any()
    ):
        return  # wherever they are
    hidden = family.ratios.denominator_point >= len(scenario.nodes)  # of pairs the nodes are among them, too
    points = family.ratios.denominator_point[hidden]
    distance_m = distances_m(family.ratios.points_m, family.domain.low_m, family.domain.high_m)[points]
    distance_m = np.maximum(distance_m, family.domain.keep_out_m)
    over_noise = family.ratios.denominator_weight[hidden] / distance_m**2
    if channels is not None:
        over_noise *= largest_excess_gain(channels, distance_m) / channels.strengths
    if not (over_noise > LOUDEST).any():
        return
    index = int(points[np.argmax(over_noise)]) - len(scenario.nodes)
    record = scenario.objective_record
    path = f"{record.interferers}[{index}]"
    if not record.transmits:
        key = "power_w" if scenario.jammers[index].power_w is not None else "power_dbm"
        path = f"{path}.{key}"
    raise refusal(
        path,
        f"got a signal {10.0 * np.log10(over_noise[index]):.0f} dB over the noise at the closest allowed "
        f"position, must be at most {10.0 * np.log10(LOUDEST):.0f} dB: beyond that rounding fills the null; "
        "make the transmit power smaller, the noise greater or the distance longer",
    )


def domain_of(scenario: Scenario, points_m: FloatArray) -> dict[str, FloatArray | IntArray | float]:
    """Build the fields of a family that say where its positions may be.

    Args:
        scenario: with its airspace.
        points_m: the points that are to be kept clear of, (m, 3), metres.
    """
    airspace = scenario.open_airspace.inner
    low_m, high_m = airspace.box_m
    return {
        "low_m": low_m,
        "high_m": high_m,
        # of the points those whose ball reaches into the airspace
        "keep_out_points_m": points_m[distances_m(points_m, low_m, high_m) < airspace.keep_out_m],
        "keep_out_m": float(airspace.keep_out_m),
        **airspace_zones(airspace),
    }


def distances_m(points_m: FloatArray, low_m: FloatArray, high_m: FloatArray) -> FloatArray:
    """Measure how far each point is from a box, (m,), metres.

    Args:
        points_m: (m, 3).
        low_m: (3,) lowest corner of the box.
        high_m: (3,) highest corner.
    """
    outside = points_m - np.minimum(np.maximum(points_m, low_m), high_m)
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", outside, outside)))
