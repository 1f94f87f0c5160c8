"""A scene in an address."""

import re
import zlib
from base64 import urlsafe_b64encode
from pathlib import Path

import pytest

from nullpose import load
from nullpose.errors import ScenarioError, UsageError
from nullpose.scenario import Scenario
from nullpose.studio.scene_link import scenario_from_scene, scene_to_text

EXAMPLES = sorted({*(Path(__file__).parents[2] / "examples").glob("[!s]*.toml")})


def _packed(content: bytes) -> str:
    return urlsafe_b64encode(zlib.compress(content)).decode().rstrip("=")


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_every_example_comes_back_from_its_address(path: Path) -> None:
    """As the same scene, from letters that an address holds as they are."""
    scenario = load(path)
    text = scene_to_text(scenario)
    assert re.fullmatch("[A-Za-z0-9_-]+", text)
    assert scenario_from_scene(text) == Scenario.from_dict(scenario.to_dict())


@pytest.mark.parametrize(
    "text",
    ["", "A", "%%%", "\u00e9", "AAAA", _packed(b"x" * 500)[:-8], _packed(b"#" * 2_000_000)],
    ids=["nothing", "one letter", "no letters", "no ASCII", "not packed", "cut off", "over 1 MB"],
)
def test_what_is_no_packed_text_is_refused(text: str) -> None:
    """In words, and what would be large is not unpacked."""
    with pytest.raises(ScenarioError, match="damaged, cut off, or over 1 MB"):
        scenario_from_scene(text)


def test_a_packed_text_that_is_no_scenario_shows_its_faults() -> None:
    """Each with its path, as for a file."""
    with pytest.raises(ScenarioError) as raised:
        scenario_from_scene(_packed(b"[airspace]\naltitude_m = [30.0, 8.0]\n[[nodes]]\npower_w = -1\n"))
    assert {"airspace.altitude_m", "nodes[0].power_w"} <= {fault.path for fault in raised.value.faults}


def test_a_scene_too_large_for_an_address_is_told(paper: Scenario) -> None:
    """With how large it is, and what to do instead."""
    node = paper.nodes[0]
    places = ((1.0 + 0.137 * i, 2.0 + (i * i * 0.7919) % 40.0, 0.0) for i in range(900))
    nodes = tuple(
        node.model_copy(update={"name": f"N{i}", "position_m": place}) for i, place in enumerate(places)
    )
    with pytest.raises(UsageError, match=r"too large for an address: \d+ characters, at most 7800; save"):
        scene_to_text(paper.model_copy(update={"nodes": nodes}))
