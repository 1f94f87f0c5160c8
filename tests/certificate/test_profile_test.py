"""Certificates of antennas that are the same all round: accepted where they hold, and no others."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from sizes import chosen
from tests.certificate.plain import accepted, rejected, with_leaves, with_tree

from nullpose import solve
from nullpose.antenna.pattern import profile_harmonics
from nullpose.certificate import Certificate, claimed_axes, parse_certificate, profile_test
from nullpose.certificate.certificate import WORLD
from nullpose.certificate.file import certificate_text
from nullpose.certificate.profile_links import sine_cosine
from nullpose.scenario import Scenario, apply_overrides, load
from nullpose.solver.certificate_from_proof import certificate_of
from scenes import EXAMPLES

HALF_WAVE = {"kind": "half-wave"}
TILTED = ["airframe.tilt_max_deg=30", "airframe.mount_deg=90"]
LEANING = ["airframe.tilt_max_deg=10", "airframe.mount_deg=60"]
UNEVEN = {
    "kind": "profile",
    "harmonics": profile_harmonics(np.arange(181.0), 1.0 + 0.5 * np.cos(np.radians(np.arange(181.0)))).rows(),
}


def certificate(name: str, antenna: dict[str, object], *changes: str, gap: float = 1e-2) -> Certificate:
    """Return the certificate of an example with another antenna."""
    data = load(EXAMPLES / f"{name}.toml").to_dict() | {"antenna": antenna}
    scenario = apply_overrides(Scenario.from_dict(data), list(changes))
    return certificate_of(solve(scenario, gap=gap, time_limit_s=600.0))


@pytest.fixture(scope="module")
def half_wave() -> Certificate:
    """Return the certificate of the paper's scene with a half-wave dipole."""
    return certificate("paper", HALF_WAVE, gap=0.3)


@pytest.mark.parametrize("power_w", [0.01, 100.0])
@pytest.mark.parametrize("gap", [0.5, pytest.param(5e-2, marks=pytest.mark.slow)])
def test_half_wave_dipoles_are_proved(power_w: float, gap: float) -> None:
    """The paper's scene at any jamming; a file holds the whole proof."""
    made = certificate("paper", HALF_WAVE, f"jammers.M.power_w={power_w}", gap=gap)
    accepted(parse_certificate(certificate_text(made)))


@pytest.mark.parametrize(
    ("name", "antenna", "changes", "gap"),
    chosen(
        [
            ("paper", UNEVEN, [], 0.3),
            ("paper", HALF_WAVE, TILTED, 0.1),
            ("requirements", HALF_WAVE, [], 0.3),
            ("no-fly", HALF_WAVE, [], 0.3),
            ("eavesdropper", HALF_WAVE, [], 0.3),
            ("paper", HALF_WAVE, TILTED, 0.5),  # leaves are few and large, many with axes out of reach
            ("paper", UNEVEN, ["airframe.tilt_max_deg=0"], 0.1),
            ("paper", HALF_WAVE, ["airframe.tilt_max_deg=0"], 1e-2),
            ("paper", HALF_WAVE, ["airframe.tilt_max_deg=0", "airframe.mount_deg=60"], 0.1),
            ("paper", UNEVEN, ["airframe.tilt_max_deg=10", "airframe.mount_deg=80"], 0.3),
            ("paper", HALF_WAVE, ["airframe.tilt_max_deg=30", "jammers.M.power_w=3"], 0.5),
            ("paper", HALF_WAVE, [*LEANING, "jammers.M.power_w=100"], 1.0),
        ],
        [1, 4, 6, 7],
    ),
    ids=[
        *("uneven", "tilted", "requirements", "zones", "secrecy", "wide", "uneven-level", "level", "leaning"),
        *("uneven-leaning", "largest-angle", "least-angle"),
    ],
)
def test_other_scenes_are_proved(
    name: str, antenna: dict[str, object], changes: list[str], gap: float
) -> None:
    """Gains that differ up and down, airframes, requirements and zones, narrow gaps and wide ones."""
    accepted(certificate(name, antenna, *changes, gap=gap))


def lower(made: Certificate) -> Certificate:
    """Claim next to no gap."""
    bound = made.value * (1.0 + 1e-9)
    return replace(with_leaves(made, level=lambda level: np.minimum(level, bound)), upper_bound=bound)


def shrunk(made: Certificate) -> Certificate:
    """Leave out a tenth of the root box at each side."""
    root_m = made.trees[0].root_m
    return with_tree(made, root_m=root_m + 0.1 * (root_m[1] - root_m[0]) * [[1.0], [-1.0]])


def less(made: Certificate) -> Certificate:
    """Leave out a leaf."""
    leaves = made.trees[0].leaves
    return with_tree(made, leaves=leaves.chosen(np.arange(1, len(leaves))))


def of_objective(made: Certificate, objective: str) -> Certificate:
    """Claim the same of another objective."""
    return replace(made, scenario=apply_overrides(made.scenario, [f"objective={objective}"]))


def two_anchors(made: Certificate) -> Certificate:
    """Take the angles of a box's leaf from another point than those of its other leaves."""
    leaves = made.trees[0].leaves
    point = leaves.point.copy()
    point[np.argmax(np.min(leaves.cell[:, 1::2], axis=1))] = (point[0] + 1) % 3
    return with_leaves(made, point=lambda _: point)


def first(value: object) -> Callable[[np.ndarray], np.ndarray]:
    """Return a change of the first entry of a column."""
    return lambda column: np.concatenate([np.array([value]), column[1:]])


FORGED: dict[str, tuple[Callable[[Certificate], Certificate], str]] = {
    "bound": (lower, "is not excluded"),
    "leaf left out": (less, "do not cover the root"),
    "root": (shrunk, "beyond which poses could exceed"),
    "chart": (lambda c: with_leaves(c, cell=first([3, 0, 0, 0, 0])), "its cell does not exist"),
    "face": (lambda c: with_leaves(c, cell=first([-1, 0, 0, 0, 0])), "it has no chart"),
    "test of a dipole": (lambda c: with_leaves(c, test=lambda x: 0 * x + WORLD), "for another antenna"),
    "anchor": (lambda c: with_leaves(c, point=first(3)), "its point does not exist"),
    "chart of the zenith": (lambda c: with_leaves(c, point=lambda p: 0 * p - 1), "which has chart 0 alone"),
    "level": (lambda c: with_leaves(c, level=lambda x: np.append(0.5 * c.value, x[1:])), "leaf 0 "),
    "mean": (lambda c: of_objective(c, "sum-rate"), "for a dipole only"),
    "anchors of one box": (two_anchors, "do not cover the root"),
    "multipliers": (lambda c: with_leaves(c, mix=lambda x: np.roll(x, 1)), "is not excluded"),
    "value": (lambda c: replace(c, value=c.value * (1.0 + 1e-6)), "its smallest SINR is"),
    "attitude": (lambda c: replace(c, roll_rad=c.roll_rad + 1e-3), "its smallest SINR is"),
}


@pytest.mark.parametrize("name", chosen(FORGED, {*range(14)} - {0, 11}))  # these take eight seconds and more
def test_forgeries_are_rejected(half_wave: Certificate, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is not proved is not accepted, and the message says which part fails."""
    forge, words = FORGED[name]
    if name == "level":  # of which no number of pieces is excluded
        monkeypatch.setattr(profile_test, "_ROUNDS", 8)
    assert words in rejected(forge(half_wave))


def test_another_antenna_is_another_claim(half_wave: Certificate) -> None:
    """The proof for one antenna does not hold for another."""
    scenario = Scenario.from_dict(half_wave.scenario.to_dict() | {"antenna": UNEVEN})
    rejected(replace(half_wave, scenario=scenario))


def test_there_is_none_for_other_cases() -> None:
    """Neither for the paper's other cases nor for a gain that changes round the axis."""
    data = load(EXAMPLES / "paper.toml").to_dict() | {"antenna": HALF_WAVE}
    assert claimed_axes(Scenario.from_dict(data), "vertical", None) is None
    assert claimed_axes(load(EXAMPLES / "frame.toml"), "optimum", None) is None


def test_sines_and_cosines() -> None:
    """They contain those of NumPy, all round."""
    x = np.linspace(-1.0, 1.0, 2049)
    for bounds, wanted in zip(sine_cosine(x), (np.sin(np.pi * x), np.cos(np.pi * x)), strict=True):
        assert np.all(np.abs(bounds.middle() - wanted) <= 1e-15)
        assert np.all(bounds.high - bounds.low <= 1e-14)
