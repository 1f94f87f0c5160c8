"""Tables of a result's links: with the nodes, and with jammers or eavesdroppers."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from nullpose.channel.profile import profile_gain
from nullpose.physics import Pose, antenna_gain, eavesdropper_snr, link_gain, to_db
from nullpose.physics.sinr import received_from_sources_w
from nullpose.report.document import View, cell, rows, table
from nullpose.report.geometry import axis_angle_rad, distance_m
from nullpose.scenario import Scenario
from nullpose.solver import Result

BINDING_RTOL = 1e-6
"""Nodes whose number is within this of the smallest all bind, as they do on a kink of the max-min."""

_NULLED_DB = -150.0  # what is below it is rounding of the angle


def binding_nodes(result: Result) -> frozenset[str]:
    """List the nodes that have the smallest SINR, margin or rate, within ``BINDING_RTOL``; none of a sum."""
    if (quantity := result.objective.quantity).whole:
        return frozenset()
    most = min(map(quantity.at, result.links)) * (1.0 + BINDING_RTOL)
    return frozenset(link.node for link in result.links if quantity.at(link) <= most)


def hop_words(result: Result) -> str:
    """Say which hop of a relay binds; nothing under another objective."""
    binding = sorted(binding_nodes(result))
    if (end := result.scenario.destination) is None:
        return ""
    heard = [name for name in binding if name != end.name]
    hops = [f"from {', '.join(heard)} to the drone"] * bool(heard)
    hops += [f"from the drone to {end.name}"] * (end.name in binding)
    return f"{'the hop that binds' if len(hops) == 1 else 'both hops bind'}: {', and '.join(hops)}"


def gain_columns(scenario: Scenario, pose: Pose) -> dict[str, Sequence[str | None]]:
    """Write the gain of the drone's antenna towards each node, and with the node's antenna if it has one."""
    at = (pose.position_m, pose.orientation(scenario.antenna_record), scenario.terminal_positions_m)
    gains = {"antenna gain (dB)": antenna_gain(*at, scenario.antenna_record)}
    if scenario.terminal_antennas is not None:
        both = link_gain(*at, scenario.antenna_record, scenario.terminal_antennas)
        if (channels := scenario.terminal_channels) is not None:
            both = both * profile_gain(channels.rows, scenario.terminal_positions_m - pose.position_m)
        gains["with the ground's (dB)"] = both
    return {
        name: [f"{x:z.2f}" for x in scenario.antenna_gain_dbi + to_db(gain)] for name, gain in gains.items()
    }


def links_table(result: Result, more: Mapping[str, Sequence[str | None]]) -> View | None:
    """Set a row for each node: what is maximised, ratio, distance, further columns, and if it is worst."""
    scenario, quantity, links = result.scenario, result.objective.quantity, result.links
    binding = binding_nodes(result)
    counted: dict[str, Sequence[str | None]] = {}
    if quantity.noun != quantity.ratio:
        heading = f"{quantity.noun} ({quantity.unit})"
        counted[heading] = [f"{quantity.in_unit(quantity.at(link)):.6g}" for link in links]
    if scenario.objective_record.transmits:
        counted["noise (dBm)"] = [f"{30.0 + noise_db:.2f}" for noise_db in to_db(scenario.node_noise_w)]
    columns: dict[str, Sequence[str | None]] = {
        "node": [link.node for link in links],
        **counted,
        f"required {quantity.ratio} (dB)": [cell(each.min_sinr_db, ".6g") for each in scenario.terminals],
        "weight": [cell(each.weight, ".6g") for each in scenario.terminals],
        f"{quantity.ratio} (dB)": [f"{link.sinr_db:.4f}" for link in links],
        quantity.ratio: [None if counted else f"{link.sinr:.5g}" for link in links],
        "distance (m)": [
            f"{distance_m(result.pose, point_m):.2f}" for point_m in scenario.terminal_positions_m
        ],
        **more,
        "": ["worst" if link.node in binding else "" for link in links],
    }
    return table("Links", rows(columns), bold=binding, left=[""])


def nulls_table(scenario: Scenario, pose: Pose) -> View | None:
    """Set how far the null is off each eavesdropper or jammer, and how strong the link with it is."""
    noun, transmits = scenario.interferer, scenario.objective_record.transmits
    heading = "SNR (dB)" if transmits and not scenario.sources else "jamming to noise (dB)"
    names, points = scenario.of_interferers("names"), scenario.of_interferers("positions_m")
    orientation = pose.orientation(scenario.antenna_record)
    if transmits:
        ratios = eavesdropper_snr(scenario, pose.position_m, orientation)
    else:
        received_w = received_from_sources_w(scenario, pose.position_m, orientation)
        ratios = received_w[len(scenario.nodes) :] / scenario.receiver.noise_power_w
    is_even = scenario.antenna_record.is_even
    columns = {
        noun: names,
        f"axis to {noun} (deg)": [
            f"{math.degrees(axis_angle_rad(pose, point_m, is_even)):.4f}" for point_m in points
        ],
        "distance (m)": [f"{distance_m(pose, point_m):.2f}" for point_m in points],
        heading: ["nulled" if db < _NULLED_DB else f"{db:.2f}" for db in to_db(ratios)],
    }
    return table(f"{noun.capitalize()}s", rows(columns))
