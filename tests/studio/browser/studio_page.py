"""The page in a real browser: it is drawn, it solves what is dragged, it takes and gives files."""

from __future__ import annotations

import re
import struct
from base64 import b64decode
from pathlib import Path

import numpy as np
import pytest
from benchmarks.chromium import pixels
from numpy.typing import ArrayLike, NDArray
from playwright.sync_api import Browser
from tests.studio.browser.hand import CERTIFIED, EXAMPLES, PAPER, Hand, drawn_share, opened
from zstandard import ZstdDecompressor

from nullpose import apply_overrides, load, solve, solve_trajectory
from nullpose.physics import evaluate, objective_of_links, to_db
from nullpose.solver import Scheme
from nullpose.studio.camera import CARD_PX
from nullpose.studio.state import State

ZSTD = b"\x28\xb5\x2f\xfd"  # how what zstd has compressed begins
PATTERN = """() => {
  const [scene, pattern] = ['', '/drone-a/body/antenna/pattern'].map(
    name => window.__viserMutable.nodeRefFromName[name]);
  return scene.matrixWorld.clone().invert().multiply(pattern.matrixWorld).toArray();
}"""


def test_the_scene_is_drawn(hand: Hand) -> None:
    """The canvas has the colours of the map, of the pattern and of the null in it, not only elements."""
    hand.page.wait_for_selector("[data-np=plot][data-state=current]")
    hand.until(lambda: drawn_share(hand.picture()) > 0.1)  # the map may have to be compiled first
    red, green, blue = np.moveaxis(hand.picture(), -1, 0)
    assert ((red - green > 0.15) & (green - blue > 0.1)).sum() > 100  # orange
    assert len(np.unique((hand.picture() * 15).astype(int).reshape(-1, 3), axis=0)) > 80


def test_the_slider_changes_the_value_to_the_solvers(hand: Hand) -> None:
    """After the jamming power is slid the value shown is the solver's for the same scene."""
    version, mouse = hand.session.state.version, hand.page.mouse
    track = hand.page.locator(".multi-slider-track-container").first.bounding_box()
    assert track is not None
    x, y = track["x"] + 0.43 * track["width"], track["y"] + 0.5 * track["height"]
    mouse.move(x, y)
    mouse.down()
    for step in range(1, 6):
        mouse.move(x + 0.06 * step * track["width"], y)
        hand.page.wait_for_timeout(60)
    mouse.up()
    hand.solved(version)
    hand.page.wait_for_timeout(500)
    assert hand.scenario.jammers[0].transmit_power_w > 5.0
    assert hand.certified() == pytest.approx(solve(hand.scenario).objective.value, rel=1e-9)


def test_a_dragged_body_moves_the_jammer(hand: Hand) -> None:
    """Along the ground, and with Shift up; it is selected; the value is the solver's there; undone in one."""
    size_m, mouse, keyboard = hand.ours.stage.size_m, hand.page.mouse, hand.page.keyboard
    start = np.array(PAPER.jammers[0].position_m)

    def drag(step_m: ArrayLike) -> NDArray[np.float64]:
        version, body_m = hand.session.state.version, (*hand.scenario.jammers[0].position_m,)
        held_m = np.add(body_m, (0.0, 0.0, 0.018 * size_m))
        (x, y), to = hand.screen(held_m), hand.screen(held_m + step_m)
        mouse.move(x, y)
        hand.page.wait_for_timeout(500)
        mouse.down()
        for share in np.linspace(0.1, 1.0, 12):
            mouse.move(x + share * (to[0] - x), y + share * (to[1] - y))
            hand.page.wait_for_timeout(60)
        mouse.up()
        hand.solved(version)
        hand.until(lambda: hand.session.state.dragged is None)
        assert hand.certified() == pytest.approx(solve(hand.scenario).objective.value, rel=1e-9)
        return np.subtract(hand.scenario.jammers[0].position_m, body_m)

    assert drag([8.0, 0.0, 0.0]) == pytest.approx([8.0, 0.0, 0.0], abs=1.0)
    hand.page.get_by_text("Selected: M").wait_for()
    hand.press("Undo")
    hand.until(lambda: hand.scenario == PAPER)  # the whole drag is one step
    keyboard.down("Shift")
    moved = drag([0.0, 0.0, 3.0])
    keyboard.up("Shift")
    assert moved == pytest.approx([0.0, 0.0, 3.0], abs=0.5)
    assert start[2] + moved[2] == hand.scenario.jammers[0].position_m[2]


def test_two_browsers_keep_their_own_state(browser: Browser, hand: Hand) -> None:
    """What one changes the other does not see."""
    with opened(browser, hand.running) as second:
        value = second.certified()
        hand.page.bring_to_front()
        version = hand.session.state.version
        hand.type("typed (dB)", "30")
        assert hand.solved(version) != pytest.approx(value, rel=1e-3)
        assert second.scenario == PAPER
        assert second.shown("overlay-value-0") == value


def test_cases_are_chosen_and_compared(hand: Hand) -> None:
    """A case from the list is solved as the solver does, and two are set beside each other."""
    version = hand.session.state.version
    hand.choose(0, "Vertical")
    vertical = hand.solved(version)
    assert vertical == pytest.approx(solve(PAPER, Scheme.VERTICAL).objective.value, rel=1e-9)
    hand.choose(1, "Optimum pose")
    hand.page.wait_for_selector("[data-np=difference]")
    assert hand.shown("overlay-value-1") > vertical


def test_files_go_out_and_come_back(hand: Hand, tmp_path: Path) -> None:
    """A saved scene loads with its comments; a broken file shows its faults and changes nothing."""
    version = hand.session.state.version
    hand.type("typed (dB)", "10")
    hand.solved(version)
    scenario, saved = hand.scenario, hand.download("Save scenario", tmp_path / "saved.toml")
    assert load(saved) == scenario
    saved.write_text(f"# Mine.\n{saved.read_text()}")

    version = hand.session.state.version
    broken = tmp_path / "broken.toml"
    broken.write_text("[airspace]\naltitude_m = [30.0, 8.0]\n[[nodes]]\npower_w = -1\n")
    hand.upload(broken)
    hand.noticed("broken.toml was not taken")
    for words in ("broken.toml", "airspace.altitude_m", "nodes[0].power_w"):
        hand.refused(words)
    assert hand.session.state.version == version

    hand.tab("Scene")
    hand.press("Undo")
    hand.until(lambda: hand.scenario != scenario)
    hand.upload(saved)
    hand.until(lambda: hand.scenario == scenario)
    hand.certified()
    assert hand.page.locator("[data-np=faults]").inner_text() == ""
    hand.tab("Scene")
    hand.type("typed (dB)", "20")
    hand.until(lambda: hand.scenario != scenario)
    hand.download("Save scenario", saved)
    assert saved.read_text().startswith("# Mine.\n")
    assert load(saved) == hand.scenario


def test_the_exported_scene_needs_no_server(hand: Hand, tmp_path: Path) -> None:
    """The exported HTML draws what the page shows from a file, with its value, and asks for nothing else."""
    hand.page.wait_for_selector("[data-np=plot][data-state=current]")
    hand.camera.position = (50.0, 60.0, 25.0)
    hand.page.wait_for_timeout(1000)
    path = hand.download("Export scene", tmp_path / "scene.html")
    asked: list[str] = []
    alone = Hand(hand.page.context.new_page(), hand.running)
    alone.page.on("request", lambda request: asked.append(request.url))
    alone.page.goto(path.as_uri())
    alone.page.wait_for_selector("canvas")
    for part in ("value-0", "status-0", "ends"):
        name = f"[data-np=overlay-{part}]"
        assert alone.page.locator(name).inner_text() == hand.page.locator(name).first.inner_text()
    packed = b64decode(path.read_text(encoding="utf-8").split('__VISER_EMBED_DATA__="')[1].split('"')[0])
    messages = ZstdDecompressor().decompressobj().decompress(packed[packed.index(ZSTD) :])
    assert all(struct.pack(">d", number) in messages for number in hand.camera.position)
    alone.until(lambda: drawn_share(alone.picture()) > 0.05)
    alone.page.close()
    assert [url for url in asked if url.startswith(("http", "ws"))] == []


def test_the_pattern_opens_towards_the_camera(hand: Hand) -> None:
    """Also after the camera has gone around: in the plane across the antenna the opening points at it."""
    middle_m = hand.camera.look_at

    def off_rad(eye_m: list[float]) -> float:
        x, y, _, place_m = np.reshape(hand.page.evaluate(PATTERN), (4, 4))[:, :3]
        towards = np.subtract(eye_m, place_m)
        return abs(float(np.arctan2(towards @ y, towards @ x)))

    for eye_m in ([60.0, 40.0, 30.0], [-50.0, -40.0, 60.0]):
        hand.camera.position, hand.camera.look_at = eye_m, middle_m
        hand.until(lambda eye_m=eye_m: off_rad(eye_m) < 0.1)


def test_shadows_of_buildings_are_a_layer(hand: Hand) -> None:
    """Drawn, and named on the card; the switch takes both away."""
    town = load(EXAMPLES / "town.toml")
    solve(town)  # compiles, which may take longer than the page is waited for
    hand.session.change(lambda state: state.with_scenario(town, ""))
    hand.certified()
    legend = hand.page.locator("[data-np=overlay-shadows]")
    legend.wait_for()
    hand.page.wait_for_timeout(1000)
    shown = hand.picture()
    hand.tab("Map and view")
    hand.page.get_by_role("checkbox", name="Shadows of buildings").click()
    legend.wait_for(state="detached")
    hand.until(lambda: np.mean(np.abs(hand.picture() - shown).max(axis=-1) > 0.05) > 0.05)


def test_presenting_turns_the_scene_in_the_frame(hand: Hand) -> None:
    """P folds the panel; drone and points stay in sight, clear of the card, all around; Escape ends it."""
    page, readout = hand.page, hand.page.locator("[data-np=readout]")
    before = hand.shown("overlay-value-0")
    page.mouse.click(400, 20)
    page.keyboard.press("p")
    readout.wait_for(state="hidden")
    hand.session.change(lambda view: view.with_power_db(20.0))
    hand.until(lambda: hand.shown("overlay-value-0") != before)
    page.wait_for_function(CERTIFIED)
    pose = hand.session.state.current(hand.session.state.case).result.pose
    points = [pose.position_m, *(point.position_m for _, point in hand.session.state.points())]
    azimuths: set[float] = set()
    hand.until(lambda: hand.camera.image_width > 1200)

    def is_seen() -> bool:
        camera = hand.camera
        seen = pixels(camera, points)[:, :2]
        assert np.all((seen > 0.0) & (seen < [camera.image_width, camera.image_height]))
        assert not np.any(np.all(seen < CARD_PX, axis=1)), "the card covers a point"
        x, y, _ = np.subtract(camera.position, camera.look_at)
        azimuths.add(round(float(np.arctan2(y, x)), 1))
        return len(azimuths) > 12  # a fifth of the way around

    hand.until(is_seen, 120.0)
    card = page.locator("#np-overlay").bounding_box()
    assert card is not None
    assert card["width"] <= 340
    assert page.evaluate("document.elementFromPoint(40, 40).closest('#np-overlay') === null")
    page.keyboard.press("Escape")
    readout.wait_for()


def test_what_is_pointed_at_is_read(hand: Hand) -> None:
    """A node's numbers are those of evaluate, it has a halo; on the map the value has its place."""
    tip, mouse = hand.page.locator("#np-tip"), hand.page.mouse
    state = hand.session.state
    pose = state.current(state.case).result.pose
    (link, _), node = evaluate(PAPER, pose), PAPER.nodes[0]
    mouse.move(*hand.screen(node.position_m))
    tip.get_by_text("SINR").wait_for()
    words = tip.inner_text().replace("\u2212", "-").split("\n")
    away_m = np.subtract(node.position_m, pose.position_m)
    sine = np.linalg.norm(np.cross(away_m, pose.antenna_axis)) / np.linalg.norm(away_m)
    assert words == [
        node.name,
        f"SINR {link.sinr_db:.2f} dB",
        f"{np.linalg.norm(away_m):.1f} m from the drone",
        f"{np.degrees(np.arcsin(sine)):.1f}\u00b0 off the null",
        f"gain {20.0 * np.log10(sine):.2f} dB",
    ]
    assert hand.session.state.pointed == ("nodes", 0)
    hand.until(lambda: hand.session.state.field_map)
    field, (east_m, north_m) = hand.session.state.scale.field, (10.0, 40.0)
    mouse.move(*hand.screen((east_m, north_m, 0.0)))
    tip.get_by_text("m east").wait_for()
    value, east, north = map(float, re.findall(r"-?\d+\.\d+", tip.inner_text().replace("\u2212", "-")))
    assert (east, north) == pytest.approx((east_m, north_m), abs=0.3)
    (nearest,) = [field.values[np.abs(field.north_m - north).argmin(), np.abs(field.east_m - east).argmin()]]
    assert value == pytest.approx(nearest, abs=1.0)
    assert hand.session.state.pointed is None
    hand.take_tool("ruler")
    for place in ((10.0, 40.0, 0.0), (10.0, 30.0, 0.0)):
        hand.click(*place)
    hand.until(lambda: "/sketch/side-0" in hand.ours._client.scene._handle_from_node_name)
    side = hand.ours._client.scene._handle_from_node_name["/sketch/side-0"]
    assert float(side.text.removesuffix(" m")) == pytest.approx(10.0, abs=0.4)


def test_a_flight_is_planned_and_an_edit_takes_it_away(hand: Hand) -> None:
    """Its value is that of its poses and exceeds no bound; with the time a drone moves along its line."""
    motion = apply_overrides(load(EXAMPLES / "moving_jammer.toml"), ["time.step_s=10"])
    hand.session.change(lambda view: State(scenario=motion.still()).with_scenario(motion, ""))
    hand.press("Plan flight")
    hand.page.locator("[data-np=overlay-flight][data-value]").wait_for()
    found, drawn = hand.session.state.flight.found, hand.ours._client.scene._handle_from_node_name
    scenes = [motion.at(t_s) for t_s in motion.instants_s.tolist()]
    pairs = zip(scenes, found.poses, strict=True)
    values = [objective_of_links(scene, evaluate(scene, pose)) for scene, pose in pairs]
    value_db, other = float(to_db(min(values))), solve_trajectory(motion)
    words = hand.page.locator("[data-np=overlay-flight]").inner_text().replace("\u2212", "-")
    shown_db, bound_db = map(float, re.findall(r"(?:instant|bound) (-?\d+\.\d{4}) dB", words))
    assert hand.shown("overlay-flight") == pytest.approx(value_db, abs=1e-6)
    assert shown_db == pytest.approx(value_db, abs=1e-4)
    assert max(value_db, other.value) <= min(bound_db, other.upper_bound) + 1e-9
    assert np.allclose(drawn["/flight/line"].points[:, 0], found.positions_m[:-1], atol=1e-4)
    hand.page.wait_for_function("window.__viserMutable.nodeRefFromName['/flight/line']")
    hand.session.change(lambda state: state.at_time(30.0))
    hand.until(lambda: np.allclose(drawn["/flight/drone"].position, found.positions_m[3]))
    hand.type("typed (dB)", "20")
    hand.page.locator("[data-np=overlay-flight]").wait_for(state="detached")
    hand.until(lambda: not [name for name in drawn if name.startswith("/flight/")])
    hand.page.wait_for_function("!window.__viserMutable.nodeRefFromName['/flight/line']")
