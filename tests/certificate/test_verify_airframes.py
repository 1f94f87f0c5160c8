"""Limited airframes: their certificates are accepted, but not with poses that the vehicle cannot take."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from benchmarks.soundness.features import make_feature_scene
from sizes import and_slow, chosen
from tests.certificate.plain import accepted, cut_into_cells, put_together, rejected, with_leaves

from nullpose.certificate import Certificate, verify
from nullpose.certificate.certificate import OFF_BAND
from nullpose.scenario import Airframe, Scenario
from nullpose.solver import solve
from nullpose.solver.certificate_from_proof import certificate_of

AIRFRAMES = {
    "upright": {"preset": "level"},
    "flat": {"preset": "level", "mount_deg": 90.0},
    "cone": {"preset": "level", "mount_deg": 45.0},
    "hexarotor": {"preset": "hexarotor-tilted-30"},
    "low": {"tilt_max_deg": 10.0, "mount_deg": 90.0},
    "belt": {"tilt_max_deg": 20.0, "mount_deg": 45.0},
    "any": {"tilt_max_deg": 45.0, "mount_deg": 45.0},
}


def with_airframe(scenario: Scenario, **values: object) -> Scenario:
    """Return a scenario with an airframe."""
    return scenario.model_copy(update={"airframe": Airframe(**values)})


@pytest.fixture(scope="module")
def flown(paper: Callable) -> Callable[[str], Certificate]:
    """Returns a function: the certificate of the paper's scene with an airframe, strongly jammed."""
    return cache(lambda name: put_together(with_airframe(paper(10.0), **AIRFRAMES[name])))


@pytest.mark.parametrize("name", AIRFRAMES)
def test_airframes_are_proved(name: str, flown: Callable) -> None:
    """Every kind of band: upright, level, a cone, and open on one side, both or none."""
    certificate = flown(name)
    tree = certificate.trees[0]
    assert tree.axis == {"upright": "vertical", "any": "free"}.get(name, "band")
    assert certificate.upper_bound <= certificate.value * 1.0011
    words = accepted(certificate)
    has_multipliers = bool(np.any(tree.leaves.band != 0.0))
    assert has_multipliers == (name not in ("upright", "flat", "any"))
    reach = "gives" if name == "any" else "within the airframe's reach (tilt at"
    assert f"no antenna axis {reach}" in words


def test_proofs_of_wider_bands_are_proofs_of_narrower_ones(flown: Callable) -> None:
    """Any axis is more than a band's: the free proof holds, and so does the band's pose, with its gap."""
    flat, free = flown("flat"), flown("any")
    trees = (replace(free.trees[0], axis="band"),)
    accepted(replace(flat, upper_bound=free.upper_bound, trees=trees))
    assert "pose: " in rejected(replace(free, scenario=flat.scenario, trees=trees))


@pytest.mark.parametrize(
    ("name", "factor"),
    chosen([("hexarotor", 0.0), ("low", -1.0), ("belt", 100.0), ("cone", 0.0), ("cone", -1.0)], [0, 1, 2]),
)
def test_multipliers_of_the_band_are_needed(name: str, factor: float, flown: Callable) -> None:
    """Without them, or with the other sign, the same leaves fail."""
    assert "is not excluded" in rejected(with_leaves(flown(name), band=lambda band: factor * band))


def test_level_axes_are_proved_in_cells(random_scene: Callable) -> None:
    """Level axes may be cut into cells, and those on top of the cube are out of reach."""
    scenario = with_airframe(random_scene(51, 3, 1), preset="level", mount_deg=90.0)
    certificate = cut_into_cells(put_together(scenario, gap=1.0))
    leaves = certificate.trees[0].leaves
    top = leaves.face == 2
    columns = {"test": OFF_BAND, "point": -1, "mix": -1}
    columns = {name: np.where(top, value, getattr(leaves, name)) for name, value in columns.items()}
    certificate = with_leaves(certificate, **columns)
    assert np.any(top)
    assert np.any((leaves.face >= 0) & ~top)
    accepted(certificate)
    for face in (-1, 0, 1):
        cell = leaves.cell.copy()
        cell[int(np.flatnonzero(top)[0])] = [face, 0, 0, 0, 0]
        rejected(with_leaves(certificate, cell=cell))


def test_cells_are_proved_within_bands(random_scene: Callable) -> None:
    """Cells of a band are proved with the band's multipliers, which they need."""
    scenario = with_airframe(random_scene(57, 5, 2), tilt_max_deg=10.0, mount_deg=90.0)
    certificate = cut_into_cells(put_together(scenario, gap=0.3))
    leaves = certificate.trees[0].leaves
    celled = (leaves.face >= 0) & (leaves.band != 0.0)
    assert np.any(celled)
    accepted(certificate)
    assert "is not excluded" in rejected(with_leaves(certificate, band=np.where(celled, 0.0, leaves.band)))


def test_poses_that_the_vehicle_cannot_take_are_rejected(flown: Callable) -> None:
    """Tilted too far, or with an axis beyond its reach; and another attitude has another value."""
    for name in ("flat", "low", "hexarotor", "cone"):
        certificate = flown(name)
        tilt_rad = certificate.scenario.airframe.tilt_max_rad
        words = rejected(replace(certificate, pitch_rad=tilt_rad + 1e-6))
        assert "tilts by more than" in words or "not one that the airframe reaches" in words
        # the dipole has no front or back: upside down it is the same axis, and no airframe here flies so
        upside_down = replace(certificate, pitch_rad=certificate.pitch_rad + np.pi)
        assert "tilts by more than" in rejected(upside_down)


def test_attitudes_at_the_limit_are_accepted(flown: Callable) -> None:
    """A pose whose tilt is the largest allowed, or more by rounding, is one."""
    certificate = flown("hexarotor")
    assert certificate.pitch_rad == pytest.approx(np.radians(30.0), abs=1e-11)
    assert verify(replace(certificate, pitch_rad=certificate.pitch_rad + 1e-13)).proved


def test_another_airframe_is_another_claim(flown: Callable) -> None:
    """A proof for one airframe is none for another, with the pose's value made to fit."""
    low = flown("low")
    for name in ("cone", "upright", "any", "hexarotor", "flat"):
        scenario = flown(name).scenario
        assert rejected(replace(low, scenario=scenario))
    wider = with_airframe(low.scenario, tilt_max_deg=20.0, mount_deg=90.0)
    assert "is not excluded" in rejected(replace(low, scenario=wider))


@pytest.mark.parametrize("number", and_slow([1194], [1098]))
def test_a_promised_certificate_of_a_level_vehicle_verifies(number: int) -> None:
    """Scene 1098 has leaves out of the airframe's reach, 1194 cells of axes that no certificate can state."""
    scene = make_feature_scene("level", number)
    result = solve(scene.scenario, gap=scene.gap, node_limit=60_000)
    assert result.status == "certified"
    assert not result.proofs or verify(certificate_of(result)).proved
