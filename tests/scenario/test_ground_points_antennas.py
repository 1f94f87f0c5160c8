"""Antennas on the ground in scenario files."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.scenario import Scenario, doubts
from scenes import require_fault


def stated(paper: Callable, **keys: object) -> Scenario:
    """Return the paper's scene with these keys at its first node."""
    data = paper().to_dict()
    data["nodes"][0].update(keys)
    return Scenario.from_dict(data)


def test_axes_are_upright_or_as_stated(paper: Callable) -> None:
    """A dipole is upright; an axis of any length is brought to unit length; others have none."""
    upright = stated(paper, antenna="dipole")
    leaning = stated(paper, antenna="dipole", antenna_axis=[3, 0, 4])
    np.testing.assert_allclose(upright.node_antennas.axes, [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])
    np.testing.assert_allclose(leaning.node_antennas.axes[0], [0.6, 0.0, 0.8], atol=1e-15)
    circular = stated(paper, antenna="circular").node_antennas
    assert circular.shares.tolist() == [0.5, 1.0]
    assert not np.any(circular.axes)
    assert Scenario.from_dict(leaning.to_dict()) == leaning


@pytest.mark.parametrize(
    ("antenna", "keys", "key", "words"),
    [
        ("whip", {}, "antenna", '"isotropic" or "circular" or "dipole"'),
        ("isotropic", {"antenna_axis": [0, 0, 1]}, "antenna_axis", 'antenna = "isotropic" has no axis'),
        ("circular", {"antenna_axis": [0, 0, 1]}, "antenna_axis", 'write antenna = "dipole"'),
        ("isotropic", {"null_depth_db": 20.0}, "null_depth_db", 'antenna = "isotropic" has no null'),
        ("dipole", {"null_depth_db": -1.0}, "null_depth_db", "a depth in dB"),
        ("dipole", {"antenna_axis": [0, 0, 0]}, "antenna_axis", "length 0"),
        ("dipole", {"antenna_axis": [0, 1]}, "antenna_axis", "three numbers"),
        ("dipole", {"antenna_axis": [0, 0, float("nan")]}, "antenna_axis[2]", "direction"),
        ("dipole", {"gain_dbi": 101.0}, "gain_dbi", "from -100 to 100"),
    ],
)
def test_faults_have_their_place(antenna: str, keys: dict, key: str, words: str, paper: Callable) -> None:
    """One message each, with what was given and what is allowed."""
    require_fault(lambda: stated(paper, antenna=antenna, **keys), f"nodes[0].{key}", words)


def test_the_depth_of_a_null_is_told(paper: Callable) -> None:
    """As a leak along the dipole's axis; at 0 dB there is no direction left."""
    whip, level = (stated(paper, antenna="dipole", null_depth_db=depth) for depth in (20.0, 0.0))
    assert whip.node_antennas.leaks.tolist() == [0.01, 1.0]
    assert level.node_antennas.leaks.tolist() == [1.0, 1.0]
    assert not np.any(level.node_antennas.axes)
    assert Scenario.from_dict(whip.to_dict()) == whip
    assert "null_depth_db = 20" in whip.to_toml()
    assert whip.nodes[0].isotropic == paper().nodes[0]


def test_a_gain_is_told_of_every_antenna(paper: Callable) -> None:
    """In dBi over an isotropic antenna, half of it for a circular one; 0 is not told."""
    gained = stated(paper, gain_dbi=3.0, antenna="circular")
    assert gained.node_antennas.shares.tolist() == [0.5 * 10.0**0.3, 1.0]
    assert Scenario.from_dict(gained.to_dict()) == gained
    assert stated(paper, gain_dbi=0.0) == paper()
    assert stated(paper, gain_dbi=3.0).nodes[0].isotropic.gain_dbi == 3.0


@pytest.mark.parametrize(
    ("keys", "most_dbi"),
    [({"antenna": "dipole"}, 5.27), ({"antenna": "dipole", "null_depth_db": 10.0}, 5.06)],
)
def test_gains_that_no_dipole_has_are_refused(keys: dict, most_dbi: float, paper: Callable) -> None:
    """Over the upper half of the sphere it would radiate half a decibel more than it is fed."""
    stated(paper, gain_dbi=most_dbi - 0.01, **keys)
    require_fault(
        lambda: stated(paper, gain_dbi=8.5, **keys), "nodes[0].gain_dbi", f"must be at most {most_dbi:.2f}"
    )


@pytest.mark.parametrize(
    ("kind", "keys", "gain_dbi", "is_doubted"),
    [
        ("nodes", {"antenna": "dipole"}, 1.76, False),
        ("nodes", {"antenna": "dipole", "null_depth_db": 15.0}, 2.15, False),
        ("nodes", {"antenna": "dipole"}, 5.0, True),
        ("nodes", {"antenna": "circular"}, 3.0, False),
        ("nodes", {"antenna": "circular"}, 8.0, True),
        ("nodes", {}, 8.5, True),
        ("nodes", {"antenna": "dipole"}, -3.0, False),
        ("jammers", {"antenna": "dipole"}, 5.0, True),
        ("jammers", {}, 12.0, False),
    ],
)
def test_gains_of_some_directions_only_are_doubted(
    kind: str, keys: dict, gain_dbi: float, is_doubted: bool, paper: Callable
) -> None:
    """The gain counts in every direction: the worst case of a jammer, and too kind to a node."""
    data = paper().to_dict()
    data[kind][0] |= keys | {"gain_dbi": gain_dbi}
    assert [each.path for each in doubts(Scenario.from_dict(data))] == [f"{kind}[0].gain_dbi"] * is_doubted


@pytest.mark.parametrize(
    ("antenna", "most_dbi"),
    [
        ({}, 2.26),
        ({"null_depth_db": 10.0}, 2.05),
        ({"kind": "half-wave"}, 2.65),
        ({"kind": "profile", "normalise": "peak", "harmonics": [[0.25], [0.25, 0, 0]]}, 4.86),
    ],
)
def test_gains_that_no_antenna_on_the_drone_has_are_refused(
    antenna: dict, most_dbi: float, paper: Callable
) -> None:
    """Over the sphere it would radiate half a decibel more than it is fed."""
    data = paper().to_dict()
    Scenario.from_dict(data | {"antenna": antenna | {"gain_dbi": most_dbi - 0.01}})
    require_fault(
        lambda: Scenario.from_dict(data | {"antenna": antenna | {"gain_dbi": most_dbi + 0.01}}),
        "antenna.gain_dbi",
        f"must be at most {most_dbi:.2f}",
    )
