"""Profiles of ground antennas: what is certified is accepted, and proves nothing with another table."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from sizes import diagonal
from tests.certificate.plain import accepted, certified, rejected
from tests.reference.whip import whip_rows

from nullpose.certificate import certificate_text, differences, parse_certificate
from nullpose.scenario import Scenario

SUBURBS = {"model": "elevation", "environment": "suburban", "average": "power"}
EVERYTHING: dict[str, dict[str, Any]] = {
    "free space": {},
    "suburbs": {"channel": SUBURBS},
    "suburbs of exponent 2.6": {"channel": SUBURBS | {"exponent": 2.6}},
    "power law": {"channel": {"model": "power-law", "exponent": 1.8}},
    "belt": {"airframe": {"tilt_max_deg": 20.0, "mount_deg": 45.0}},
    "leak": {"antenna": {"null_depth_db": 25.0}},
}


def with_whips(scenario: Scenario, rows: list[list[float]], kinds: tuple[str, ...] = ("nodes",)) -> Scenario:
    """Return a scenario in which some points have the antenna of a table."""
    data = scenario.to_dict()
    for kind in kinds:
        for point in data[kind]:
            point |= {"antenna": "profile", "antenna_profile": rows}
    return Scenario.from_dict(data)


@pytest.mark.parametrize("gap", [1.0, pytest.param(1e-3, marks=pytest.mark.slow)])
@pytest.mark.parametrize(
    ("name", "kinds"), diagonal([*EVERYTHING], [("nodes",), ("jammers",), ("nodes", "jammers")])
)
def test_whips_are_proved(name: str, kinds: tuple[str, ...], gap: float, paper: Callable) -> None:
    """On nodes and on the jammer, with coarse steps and fine ones, and read again from its text."""
    scenario = Scenario.from_dict(paper().to_dict() | EVERYTHING[name])
    scenario = with_whips(scenario, whip_rows(1.0 if kinds == ("nodes",) else 10.0), kinds)
    certificate = certified(scenario, gap=gap)
    assert certificate.upper_bound <= certificate.value * (1.0 + 1.1 * gap)
    accepted(certificate)
    again = parse_certificate(certificate_text(certificate))
    assert again.scenario == certificate.scenario
    assert not differences(again, certificate.scenario)


def test_the_table_of_a_certificate_is_part_of_it(paper: Callable) -> None:
    """A row that is a little higher, or a whip in place of another antenna, is another problem."""
    rows = whip_rows(5.0)
    scenario = with_whips(paper(), rows)
    certificate = certified(scenario, gap=0.05)
    place = certificate.position_m
    level_m = np.hypot(*(place[:2] - np.array(scenario.nodes[0].position_m)[:2]))
    angle_deg = float(np.degrees(np.arctan2(place[2], level_m)))
    raised = [[deg, dbi + 0.5 * (abs(deg - angle_deg) < 10.0)] for deg, dbi in rows]
    for other in (with_whips(paper(), raised), paper()):
        rejected(replace(certificate, scenario=other))
        assert any("antenna_profile" in words for words in differences(certificate, other))


def test_a_bound_below_what_a_pose_reaches_is_rejected(paper: Callable) -> None:
    """Whatever is written as value and bound."""
    certificate = certified(with_whips(paper(), whip_rows(5.0), ("nodes", "jammers")), gap=1e-2)
    rejected(replace(certificate, value=certificate.value * 0.99, upper_bound=certificate.value * 0.995))
