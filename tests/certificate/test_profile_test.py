"""Certificates of antennas that are the same all round: accepted where they hold, and no others."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from nullpose import solve
from nullpose.antenna.pattern import profile_harmonics
from nullpose.certificate import Certificate, claimed_axes, parse_certificate, verify
from nullpose.certificate.certificate import WORLD
from nullpose.certificate.file import certificate_text
from nullpose.certificate.profile_links import sine_cosine
from nullpose.scenario import Scenario, apply_overrides, load
from nullpose.solver.certificate_from_proof import certificate_of

EXAMPLES = Path(__file__).parents[2] / "examples"
TILTED = ["airframe.tilt_max_deg=30", "airframe.mount_deg=90"]
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
    return certificate("paper", {"kind": "half-wave"}, gap=5e-2)


@pytest.mark.parametrize("power_w", [0.01, 100.0])
def test_half_wave_dipoles_are_proved(power_w: float) -> None:
    """The paper's scene at any jamming; a file holds the whole proof."""
    made = certificate("paper", {"kind": "half-wave"}, f"jammers.M.power_w={power_w}", gap=5e-2)
    verdict = verify(parse_certificate(certificate_text(made)))
    assert verdict.proved, verdict.message


@pytest.mark.parametrize(
    ("name", "antenna", "changes"),
    [
        ("paper", UNEVEN, []),
        ("paper", {"kind": "half-wave"}, TILTED),
        ("requirements", {"kind": "half-wave"}, []),
        ("no-fly", {"kind": "half-wave"}, []),
        ("eavesdropper", {"kind": "half-wave"}, []),
    ],
    ids=["uneven", "tilted", "requirements", "zones", "secrecy"],
)
def test_other_scenes_are_proved(name: str, antenna: dict[str, object], changes: list[str]) -> None:
    """Gains that differ up and down, airframes, requirements and zones."""
    verdict = verify(certificate(name, antenna, *changes, gap=0.1))
    assert verdict.proved, verdict.message


@pytest.mark.parametrize(
    ("antenna", "changes"),
    [({"kind": "half-wave"}, TILTED), (UNEVEN, ["airframe.tilt_max_deg=0"])],
    ids=["tilted", "level"],
)
def test_wide_gaps_are_proved(antenna: dict[str, object], changes: list[str]) -> None:
    """Leaves are few and large, many with axes out of reach."""
    verdict = verify(certificate("paper", antenna, *changes, gap=0.5))
    assert verdict.proved, verdict.message


def lower(made: Certificate) -> Certificate:
    """Claim next to no gap."""
    bound = made.value * (1.0 + 1e-9)
    return leaves(made, "level", lambda level: np.minimum(level, bound), upper_bound=bound)


def leaves(made: Certificate, name: str, change: Callable, **claim: object) -> Certificate:
    """Change a column of the leaves."""
    (tree,) = made.trees
    changed = replace(tree.leaves, **{name: change(getattr(tree.leaves, name).copy())})
    return replace(made, trees=(replace(tree, leaves=changed),), **claim)


def first(value: object) -> Callable:
    """Return a function that changes the first entry."""

    def change(column: np.ndarray) -> np.ndarray:
        column[0] = value
        return column

    return change


def shrunk(made: Certificate) -> Certificate:
    """Leave out a tenth of the root box at each side."""
    (tree,) = made.trees
    inwards = 0.1 * (tree.root_m[1] - tree.root_m[0]) * [[1.0], [-1.0]]
    return replace(made, trees=(replace(tree, root_m=tree.root_m + inwards),))


def without_one(made: Certificate) -> Certificate:
    """Leave out a leaf."""
    (tree,) = made.trees
    return replace(made, trees=(replace(tree, leaves=tree.leaves.chosen(np.arange(1, len(tree.leaves)))),))


FORGED: dict[str, tuple[Callable[[Certificate], Certificate], str]] = {
    "bound": (lower, "is not excluded"),
    "leaf left out": (without_one, "do not cover the root"),
    "root": (shrunk, "beyond which poses could exceed"),
    "chart": (lambda c: leaves(c, "cell", first([3, 0, 0, 0, 0])), "its cell does not exist"),
    "face": (lambda c: leaves(c, "cell", first([-1, 0, 0, 0, 0])), "its cell is that of a dipole"),
    "test of a dipole": (lambda c: leaves(c, "test", lambda x: 0 * x + WORLD), "for another antenna"),
    "anchor": (lambda c: leaves(c, "point", first(3)), "its point does not exist"),
    "other anchor": (lambda c: leaves(c, "point", lambda x: 0 * x), "is not excluded"),
    "multipliers": (lambda c: leaves(c, "mix", lambda x: np.roll(x, 1)), "is not excluded"),
    "value": (lambda c: replace(c, value=c.value * (1.0 + 1e-6)), "its smallest SINR is"),
    "attitude": (lambda c: replace(c, roll_rad=c.roll_rad + 1e-3), "its smallest SINR is"),
}


@pytest.mark.parametrize("name", FORGED)
def test_forgeries_are_rejected(half_wave: Certificate, name: str) -> None:
    """What is not proved is not accepted, and the message says which part fails."""
    forge, words = FORGED[name]
    verdict = verify(forge(half_wave))
    assert not verdict.proved
    assert any(word in verdict.message for word in words.split("|")), verdict.message


def test_another_antenna_is_another_claim(half_wave: Certificate) -> None:
    """The proof for one antenna does not hold for another."""
    scenario = Scenario.from_dict(half_wave.scenario.to_dict() | {"antenna": UNEVEN})
    assert not verify(replace(half_wave, scenario=scenario)).proved


def test_there_is_none_for_other_cases() -> None:
    """Neither for the paper's other cases nor for a gain that changes round the axis."""
    data = load(EXAMPLES / "paper.toml").to_dict() | {"antenna": {"kind": "half-wave"}}
    assert claimed_axes(Scenario.from_dict(data), "vertical", None) is None
    assert claimed_axes(load(EXAMPLES / "frame.toml"), "optimum", None) is None


def test_sines_and_cosines() -> None:
    """They contain those of NumPy, all round."""
    x = np.linspace(-1.0, 1.0, 2049)
    for bounds, wanted in zip(sine_cosine(x), (np.sin(np.pi * x), np.cos(np.pi * x)), strict=True):
        assert np.all(np.abs(bounds.middle() - wanted) <= 1e-15)
        assert np.all(bounds.high - bounds.low <= 1e-14)
