"""The certificate of a pose held in a scene in motion: what it claims of all instants, and forgeries."""

import json
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.certificate.plain import rejected, with_leaves

from nullpose.certificate import Certificate, certificate_text, differences, parse_certificate, verify
from nullpose.certificate.channels import excess_at
from nullpose.certificate.file import scenario_digest
from nullpose.certificate.pose_value import exact, ratios_at
from nullpose.errors import CertificateError
from nullpose.physics import Pose, evaluate, objective_of_links
from nullpose.problem.build import build_family
from nullpose.problem.family import join_instants, still_scenes
from nullpose.scenario import Scenario
from nullpose.solver import solve
from nullpose.solver.certificate_from_proof import certificate_of

LEVEL = {"airframe": {"tilt_max_deg": 0.0, "mount_deg": 0.0}}
WHIPS = {"antenna": {"null_depth_db": 20.0}, "channel": {"model": "power-law", "exponent": 2.2}}


def circling(steps: int = 6, start_m: float = 20.0, **keys: Any) -> Scenario:
    """Return two nodes, and a jammer that goes round between them."""
    turn = [(t, 2.0 * math.pi * t / steps) for t in range(steps + 1)]
    track = [[float(t), 3.0 + start_m * math.cos(a), 23.0 + 15.0 * math.sin(a), 4.0] for t, a in turn]
    data = {
        "time": {"duration_s": float(steps), "step_s": 1.0},
        "airspace": {"altitude_m": [8.0, 30.0], "x_m": [-40.0, 40.0], "y_m": [-20.0, 70.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
        "nodes": [{"position_m": place, "power_w": 1.0} for place in ([0.0, 0.0, 0.0], [0.0, 50.0, 0.0])],
        "jammers": [{"name": "M", "track": track, "power_w": 1.0}],
    }
    return Scenario.from_dict(data | keys)


def held(scene: Scenario, gap: float = 0.05) -> Certificate:
    """Return the certificate of the pose to hold, however long kernels take to be compiled."""
    return certificate_of(solve(scene, hover=True, gap=gap, time_limit_s=600.0))


@pytest.fixture(scope="module")
def sound() -> Certificate:
    """Returns a sound certificate of a level vehicle."""
    return held(circling(**LEVEL), gap=0.2)


def changed(certificate: Certificate, **keys: Any) -> Certificate:
    """Return a certificate of another scene, its digest made anew."""
    data = json.loads(certificate_text(certificate))
    data["scenario"] |= keys
    data["scenario_sha256"] = scenario_digest(data["scenario"])
    return parse_certificate(json.dumps(data))


def values_of(certificate: Certificate) -> list[float]:
    """Return what the pose gives at every instant, by the physics."""
    place, mount_rad = certificate.position_m, certificate.scenario.still().airframe
    pose = Pose(
        position_m=place,
        roll_rad=certificate.roll_rad,
        pitch_rad=certificate.pitch_rad,
        yaw_rad=certificate.yaw_rad,
        mount_rad=0.0 if mount_rad is None else mount_rad.mount_rad,
    )
    return [objective_of_links(s, evaluate(s, pose)) for s in still_scenes(certificate.scenario)]


@pytest.mark.parametrize(
    "keys",
    [
        {},
        LEVEL,
        {"airframe": {"tilt_max_deg": 20.0}} | WHIPS,
        {"airspace": {"altitude_m": [8.0, 30.0], "keep_out_m": 9.0}},
    ],
    ids=["free", "level", "band, leak and channel", "keep-out"],
)
def test_what_is_solved_is_verified(keys: dict[str, Any]) -> None:
    """The value is the least over all instants, the proof is about some, and the file brings both back."""
    certificate = held(circling(**keys))
    verdict = verify(parse_certificate(certificate_text(certificate)))
    assert verdict.proved, verdict.message
    assert "at all 7 instants" in verdict.message
    assert certificate.value == pytest.approx(min(values_of(certificate)), rel=1e-12)
    assert 1 < len(certificate.instants) < 8


def test_a_rate_is_verified() -> None:
    """Also where the best pose has no rate, whose ratio is below 1."""
    heard = {"objective": "secrecy-rate", "transmitter": {"power_w": 1.0}, "jammers": [], **LEVEL}
    nodes = [{"position_m": place} for place in ([0.0, 0.0, 0.0], [0.0, 50.0, 0.0])]
    for far_m, has_rate in ((45.0, True), (5.0, False)):
        track = [[0.0, far_m, -9.0, 4.0], [6.0, far_m - 5.0, 45.0, 4.0]]
        scene = circling(nodes=nodes, eavesdroppers=[{"track": track}], **heard)
        certificate = held(scene, gap=0.5)
        assert verify(certificate).proved
        assert (certificate.value > 1.0) == has_rate


def test_the_joined_ratios_are_those_of_the_instants() -> None:
    """At any pose, with ground antennas, channels and a leak: so the leaves are about the scene."""
    whips = [{"position_m": [0.0, 0.0, 0.0], "antenna": "dipole"}, {"position_m": [0.0, 50.0, 0.0]}]
    nodes = [node | {"power_w": 1.0} for node in whips]
    scenes = still_scenes(circling(nodes=nodes, **WHIPS))
    families = [build_family(scene, any_channel=True) for scene in scenes]
    rng = np.random.default_rng(4)
    for _ in range(5):
        place, axis = exact(rng.uniform([-20.0, 5.0, 10.0], [20.0, 45.0, 40.0])), exact(rng.normal(size=3))
        listed = rng.permutation(7)[:3]
        each, joined = (
            [ratios_at(f.ratios, place, axis, gains=excess_at(f.ratios, place)) for f in some]
            for some in ([families[i] for i in listed], [join_instants(families, listed)])
        )
        assert list(joined[0]) == list(np.concatenate(each))


def test_forged_instants_are_rejected(sound: Certificate) -> None:
    """None, too many, one twice, one before the first or after the last; or those of a still scene."""
    first, *others = sound.instants
    for forged in ((), (first, first, *others), (-1, *others), (7, *others), (2**40, *others)):
        assert "it must list instants" in rejected(replace(sound, instants=forged))
    still = certificate_of(solve(circling(**LEVEL).at(0.0), gap=0.05, time_limit_s=600.0))
    assert "it must list instants" in rejected(replace(still, instants=(0,)))


def test_other_instants_prove_nothing_else(sound: Certificate) -> None:
    """With instants left out or in another order the leaves' multipliers are about other ratios."""
    assert len(sound.instants) > 2
    rejected(replace(sound, instants=sound.instants[:-1]))
    rejected(replace(sound, instants=sound.instants[::-1]))


def test_the_value_is_that_of_all_instants(sound: Certificate) -> None:
    """The value at the instants of the proof alone, at the best one, or a bit more, is not the pose's."""
    values, listed = np.array(values_of(sound)), list(sound.instants)
    scene = solve(circling(**LEVEL).at(0.0), gap=0.05, time_limit_s=600.0)
    alone = replace(
        sound,
        position_m=scene.pose.position_m,
        value=scene.objective.value,
        upper_bound=max(sound.upper_bound, scene.objective.value),
    )
    assert "its smallest SINR is" in rejected(alone)
    for value in (float(np.median(values)), float(values[listed].min()) * (1.0 + 1e-8)):
        assert "its smallest SINR is" in rejected(
            replace(sound, value=value, upper_bound=max(sound.upper_bound, value))
        )


def test_a_bound_below_the_best_pose_is_rejected(sound: Certificate) -> None:
    """Bound and levels lowered together, to less than the best value that is known."""
    best = solve(circling(**LEVEL), hover=True, gap=1e-3, time_limit_s=600.0).objective.value
    bound = max(best * (1.0 - 1e-5), sound.value)
    level = np.minimum(sound.trees[0].leaves.level, bound)
    words = rejected(with_leaves(replace(sound, upper_bound=bound), level=level))
    assert "is not excluded" in words or "root" in words


@pytest.mark.grid  # a rejection that takes the verifier five seconds
def test_another_track_is_another_claim(sound: Certificate) -> None:
    """The digest tells; with a new one the value does, and with a new value the leaves, where poses gain."""
    worst = int(np.argmin(values_of(sound)))
    near, gone = ([list(row) for row in sound.scenario.jammers[0].track] for _ in range(2))
    near[worst][2] += 0.01
    for row in gone:
        row[1] += 200.0
    for track in (near, gone):
        data = json.loads(certificate_text(sound))
        data["scenario"]["jammers"][0] |= {"track": track, "position_m": track[0][1:]}
        with pytest.raises(CertificateError, match="scenario_sha256"):
            parse_certificate(json.dumps(data))
        forged = changed(sound, jammers=data["scenario"]["jammers"])
        assert "its smallest SINR is" in rejected(forged)
        assert differences(sound, forged.scenario)
    assert values_of(forged)[0] > sound.upper_bound
    kept = replace(forged, value=sound.value, position_m=np.array([-40.0, 25.0, 30.0]))
    value = min(values_of(kept))
    assert value < sound.upper_bound
    assert "is not excluded" in rejected(replace(kept, value=value))


def test_other_times_are_another_claim() -> None:
    """With half the step the numbers of the instants stand for others, and there are more of them."""
    sound = held(circling(**LEVEL))
    forged = changed(sound, time={"duration_s": 6.0, "step_s": 0.5})
    assert "its smallest SINR is" in rejected(forged)
    assert "is not excluded" in rejected(replace(forged, value=min(values_of(forged))))
    assert differences(sound, forged.scenario)
    assert not differences(sound, circling(name="another name", **LEVEL))
    assert differences(sound, circling(**LEVEL).at(0.0))


@pytest.mark.parametrize(
    ("keys", "scheme", "words"),
    [
        ({"objective": "sum-rate"}, "optimum", "smallest ratio of a dipole only"),
        ({"antenna": {"kind": "half-wave"}}, "optimum", "smallest ratio of a dipole only"),
        ({}, "zero-interference", "has no certificate in this scenario"),
        ({}, "vertical", "has no certificate in this scenario"),
    ],
)
def test_what_has_no_certificate_is_rejected(
    keys: dict[str, Any], scheme: str, words: str, sound: Certificate
) -> None:
    """Other objectives, antennas and schemes are not proved for a scene in motion, whatever a file says."""
    assert words in rejected(changed(replace(sound, scheme=scheme), **keys))


def test_a_position_is_kept_out_at_every_instant() -> None:
    """A pose that the jammer comes too near to, at an instant that the proof is not about, is none."""
    scene = circling(start_m=26.0, airspace={"altitude_m": [8.0, 30.0], "keep_out_m": 6.0}, **LEVEL)
    certificate = held(scene, gap=0.5)
    assert verify(certificate).proved
    unlisted = [t for t in range(7) if t not in certificate.instants]
    beside_m = scene.at(float(unlisted[0])).jammers[0].position_m
    forged = replace(certificate, position_m=np.array([*beside_m[:2], 9.0]))
    assert "closer than keep_out_m" in rejected(forged)
