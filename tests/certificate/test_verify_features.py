"""Margins, secrecy rates, zones and fences: what the solver certifies is accepted and said right."""

import math
import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from sizes import chosen, diagonal
from tests.certificate.plain import accepted, certified, overheard, put_together, rejected, with_leaves

from nullpose.certificate import Certificate, certificate_text, differences, parse_certificate, verify
from nullpose.certificate.certificate import KEPT_OUT
from nullpose.problem.build import build_family
from nullpose.scenario import Airspace, Scenario
from nullpose.scenario.polygon import depth_m

ALTITUDE_M = (8.0, 30.0)
DISC = {"centre_m": (-2.2, 23.8), "radius_m": 6.0}
TRIANGLE = [(-10.0, 15.0), (10.0, 20.0), (-5.0, 35.0)]
NOTCH = [(-20.0, 10.0), (20.0, 10.0), (20.0, 40.0), (-2.0, 24.5), (-20.0, 40.0)]
WALL = [(-30.0, -10.0), (40.0, -10.0), (40.0, 60.0), (-30.0, 60.0)]
SOUTH = {"x_m": (-20.0, -6.0), "y_m": (10.0, 40.0)}
ZONES = {
    "block": {"no_fly": [{"x_m": (-20.0, 5.0), "y_m": (10.0, 40.0)}]},
    "cylinder": {"no_fly": [DISC]},
    "low cylinder": {"no_fly": [DISC | {"altitude_m": (0.0, 10.0)}]},
    "triangle": {"no_fly": [{"polygon_m": TRIANGLE, "altitude_m": (0.0, 12.0)}]},
    "notch": {"no_fly": [{"polygon_m": NOTCH}]},
    "fence": {"geofence_m": [(0.0, 0.0), (40.0, 0.0), (40.0, 60.0), (20.0, 30.0), (5.0, 60.0)]},
    "both": {"geofence_m": WALL, "no_fly": [{"centre_m": (2.0, 25.0), "radius_m": 6.0}, SOUTH]},
}


def within(scenario: Scenario, **airspace: object) -> Scenario:
    """Return a scenario in another airspace."""
    return scenario.model_copy(update={"airspace": Airspace(altitude_m=ALTITUDE_M, **airspace)})


@pytest.fixture(scope="module")
def zoned(paper: Callable) -> Callable[..., Certificate]:
    """Returns a function: the certificate of the paper's scene in an airspace, under a scheme."""
    return cache(lambda name, scheme="optimum": certified(within(paper(), **ZONES[name]), scheme))


@pytest.mark.parametrize(("name", "scheme"), diagonal([*ZONES], ["optimum", "vertical", "zero-interference"]))
def test_zones_are_proved(name: str, scheme: str, zoned: Callable) -> None:
    """Zones of each shape, a fence, and both, for free axes and for given ones."""
    certificate = zoned(name, scheme)
    assert certificate.upper_bound <= certificate.value * 1.0011
    words = accepted(certificate)
    place = {"fence": "inside the geofence", "both": "inside the geofence and outside the 2 no-fly zones"}
    assert (
        f"no position at an altitude from 8.0 to 30.0 m, {place.get(name, 'outside the no-fly zone')},"
        in words
    )


@pytest.mark.parametrize("name", ZONES)
def test_zones_are_needed(name: str, zoned: Callable) -> None:
    """Leaves that lean on a zone fail without it, or with another's number."""
    certificate = zoned(name)
    tree = certificate.trees[0]
    balls = len(build_family(certificate.scenario).domain.keep_out_points_m)
    leaning = tree.leaves.ball >= balls
    inside = (tree.leaves.test == KEPT_OUT) & (tree.leaves.point >= balls)
    assert balls == 0
    assert np.any(leaning)
    assert np.any(inside)
    columns = [{"ball": np.where(leaning, -1, tree.leaves.ball)}]
    if name == "both":  # the other zones' numbers
        columns.append({"point": np.where(inside, (tree.leaves.point - balls + 1) % 3, tree.leaves.point)})
        columns.append({"ball": np.where(leaning, (tree.leaves.ball - balls + 1) % 3, tree.leaves.ball)})
    for changed in columns:
        assert "is not excluded" in rejected(with_leaves(certificate, **changed))
    free = within(certificate.scenario)
    assert rejected(replace(certificate, scenario=free))


def test_a_smaller_zone_is_another_claim(zoned: Callable) -> None:
    """A proof for a zone does not hold once the zone leaves more room."""
    certificate = zoned("cylinder")
    smaller = within(certificate.scenario, no_fly=[DISC | {"radius_m": 5.9}])
    assert "is not excluded" in rejected(replace(certificate, scenario=smaller))
    # while a larger one forbids the pose
    larger = within(certificate.scenario, no_fly=[DISC | {"radius_m": 6.1}])
    assert "no-fly zone" in rejected(replace(certificate, scenario=larger))


@pytest.mark.parametrize("name", chosen(["block", "cylinder", "triangle", "fence"], [1, 3]))
def test_a_margin_is_proved(name: str, zoned: Callable, paper: Callable) -> None:
    """A pose on a border moves away from it by the margin, and the proof holds for no smaller margin."""
    margin_m = 1.5

    def beside_m(certificate: Certificate) -> float:
        """Return how far a pose is from the border as stated, sideways or in height."""
        airspace = certificate.scenario.airspace
        if airspace.geofence_m is not None:
            return float(depth_m(certificate.position_m[:2], airspace.geofence_outline_m))
        return -float(airspace.no_fly[0].depth_m(certificate.position_m, ALTITUDE_M))

    assert beside_m(zoned(name)) == pytest.approx(0.0, abs=1e-6)
    certificate = certified(within(paper(), margin_m=margin_m, **ZONES[name]))
    assert certificate.value < zoned(name).value
    assert beside_m(certificate) == pytest.approx(margin_m, abs=1e-4)
    assert beside_m(certificate) >= margin_m - 1e-9
    assert f"with a margin of {margin_m} m" in accepted(certificate)
    again = parse_certificate(certificate_text(certificate))
    assert not differences(again, certificate.scenario)
    accepted(again)
    for less_m in (0.0, 1.4):  # a forger's, whose proof is another and whose scenario too
        forged = replace(certificate, scenario=within(paper(), margin_m=less_m, **ZONES[name]))
        assert rejected(forged)
        assert differences(forged, certificate.scenario)
    larger = replace(certificate, scenario=within(paper(), margin_m=1.6, **ZONES[name]))
    assert "within their margin_m" in rejected(larger)


def test_forbidden_poses_are_rejected(zoned: Callable, paper: Callable) -> None:
    """A pose in a zone or beyond the fence is none; one on the border, to a nanometre, is."""
    free = certified(paper())
    for name in ("block", "cylinder", "fence"):
        assert "outside the geofence or in a no-fly zone" in rejected(
            replace(zoned(name), position_m=free.position_m)
        )
    certificate = zoned("cylinder")
    middle = np.array([-2.2, 23.8, certificate.position_m[2]])
    inwards = (middle - certificate.position_m) / np.linalg.norm(middle - certificate.position_m)
    for sunk_m, words in ((3e-9, "no-fly zone"), (5e-10, "")):
        moved = replace(certificate, position_m=certificate.position_m + sunk_m * inwards)
        verdict = verify(replace(moved, value=certificate.value))
        assert words in verdict.message
        assert verdict.proved or words or "smallest SINR" in verdict.message


def test_zones_and_airframes_go_together(paper: Callable) -> None:
    """Level axes, a band and an upright antenna in an airspace with zones."""
    for airframe in ({"preset": "level", "mount_deg": 90.0}, {"tilt_max_deg": 20.0}, {"preset": "level"}):
        data = within(paper(10.0), **ZONES["both"]).to_dict() | {"airframe": airframe}
        certificate = put_together(Scenario.from_dict(data))
        assert certificate.upper_bound <= certificate.value * 1.0011
        words = accepted(certificate)
        assert "inside the geofence and outside the 2 no-fly zones" in words
        assert "airframe's reach" in words


@pytest.mark.parametrize("scheme", ["optimum", "vertical"])
@pytest.mark.parametrize("listeners", [1, 3])
def test_secrecy_rates_are_proved(listeners: int, scheme: str, paper: Callable) -> None:
    """With eavesdroppers the numbers are two to the power of the rate; the words have the rate."""
    places = [(17.0, 15.0, 4.0), (-30.0, 20.0, 0.0), (20.0, 60.0, 2.0)][:listeners]
    certificate = certified(overheard(paper(), *places), scheme)
    words = accepted(certificate)
    assert "gives every node a secrecy rate above" in words
    bound, value = (float(x) for x in re.findall(r"(?:above|every node) ([0-9.]+) bits/s/Hz", words))
    assert 0.0 <= bound - math.log2(certificate.upper_bound) <= 2e-9
    assert 0.0 <= math.log2(certificate.value) - value <= 2e-9
    assert "smallest ratio is" in rejected(replace(certificate, value=certificate.value * (1.0 - 1e-6)))
    louder = certified(overheard(paper(), *places, power_w=1.1), scheme)
    assert rejected(replace(louder, trees=certificate.trees, upper_bound=certificate.upper_bound))
