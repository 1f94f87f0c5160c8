"""What was once wrong in the studio, each fault looked for as a user would meet it."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from benchmarks.chromium import pixels
from matplotlib.image import imread
from numpy.typing import NDArray
from playwright.sync_api import Page
from tests.studio.browser.hand import EXAMPLES, PAPER, Hand

from nullpose import load, solve
from nullpose.report.numbers import MINUS
from nullpose.scenario import Scenario
from nullpose.studio.case import case_named
from nullpose.studio.field_map import MAPS, FieldMap
from nullpose.studio.state import State

KNOWN_DB = {20.0: -4.41, 30.0: -14.15, 40.0: -24.12}  # of field.toml's best pose, by the jamming power


def _show(hand: Hand, state: State) -> None:
    """Show a scene with its numbers and its map, and look at all of it."""
    hand.session.change(lambda now: now.with_scene_of(state))
    hand.certified()
    hand.until(lambda: hand.session.state.present(FieldMap) is not None)
    hand.tab("Map and view")
    hand.press("Reset the camera")
    hand.tab("Scene")
    hand.page.wait_for_timeout(1000)


def _around(picture: NDArray[np.float64], camera: Any, point_m: Any, reach_px: int) -> NDArray[np.float64]:
    """Return the pixels, (n, 3), around a point of the scene."""
    x, y, _ = pixels(camera, [point_m])[0].round().astype(int)
    window = picture[max(0, y - reach_px) : y + reach_px + 1, max(0, x - reach_px) : x + reach_px + 1]
    return window.reshape(-1, 3)


def _blue(picture: NDArray[np.float64]) -> int:
    red, green, blue = np.moveaxis(picture, -1, 0)
    return int(np.sum((blue - red > 0.3) & (blue - green > 0.1)))


def _orange(picture: NDArray[np.float64]) -> int:
    red, green, blue = np.moveaxis(picture, -1, 0)
    return int(np.sum((red - green > 0.2) & (green - blue > 0.1)))


def _of_a_kilometre() -> Scenario:
    """Return the paper's scene, 20 times as large."""
    nodes, jammers = (
        tuple(
            point.model_copy(update={"position_m": tuple(20.0 * np.array(point.position_m))})
            for point in kind
        )
        for kind in (PAPER.nodes, PAPER.jammers)
    )
    airspace = PAPER.airspace.model_copy(update={"altitude_m": (160.0, 600.0)})
    return PAPER.model_copy(update={"nodes": nodes, "jammers": jammers, "airspace": airspace})


def test_a_scene_of_a_kilometre_is_drawn(hand: Hand, tmp_path: Path) -> None:
    """Its points and its map, on the page and in the exported file: the camera sees far enough."""
    scenario = _of_a_kilometre()
    _show(hand, State(scenario=scenario))
    hand.page.wait_for_timeout(1500)
    picture, camera = hand.picture(), hand.camera
    for node in scenario.nodes:
        assert _blue(_around(picture, camera, node.position_m, 10)) > 10
    assert _orange(_around(picture, camera, scenario.jammers[0].position_m, 10)) > 10
    field = hand.session.state.present(FieldMap).footprint
    inside = slice(len(field.east_m) // 4, -len(field.east_m) // 4, 3)
    ground = [(east, north, 0.0) for east in field.east_m[inside] for north in field.north_m[inside]]
    tints = [np.ptp(np.median(_around(picture, camera, place, 1), axis=0)) for place in ground]
    assert np.mean(np.array(tints) > 0.03) > 0.8

    path = hand.download("Export scene", tmp_path / "scene.html")
    alone = Hand(hand.page.context.new_page(), hand.running)
    alone.page.goto(path.as_uri())
    alone.page.wait_for_selector("canvas")
    alone.until(lambda: _blue(alone.picture()) > 40)
    exported = alone.picture()
    alone.page.close()
    assert _orange(exported) > 40
    assert np.mean(np.ptp(exported, axis=-1) > 0.03) > 0.05


def test_the_plots_curves_leave_it_where_they_are_below_it(hand: Hand) -> None:
    """Read by its axes the best pose's curve is what solve says, also where it is cut off."""
    state = State(scenario=load(EXAMPLES / "field.toml"))
    _show(hand, state)
    hand.page.wait_for_selector("[data-np=plot][data-state=current]")
    plot = hand.page.locator("[data-np=plot] > svg")
    texts = plot.locator("text").evaluate_all(
        "all => all.map(text => [...['text-anchor', 'x', 'y'].map(name => text.getAttribute(name)),"
        "text.textContent])"
    )
    numbers = [
        (anchor, float(x), float(y), float(text.replace(MINUS, "-")))
        for anchor, x, y, text in texts
        if re.fullmatch(rf"{MINUS}?\d+(\.\d+)?", text)
    ]
    powers = [(x, power) for anchor, x, _, power in numbers if anchor == "middle"]
    values = [(y - 3.5, value) for anchor, _, y, value in numbers if anchor == "end"]
    across, up = (np.polyfit(*zip(*ticks, strict=True), 1) for ticks in (powers, values))
    line = plot.locator("polyline").first.get_attribute("points") or ""
    points = np.array([pair.split(",") for pair in line.split()], float)
    powers_db, values_db = np.polyval(across, points[:, 0]), np.polyval(up, points[:, 1])
    for power_db, known_db in KNOWN_DB.items():
        solved = solve(state.with_power_db(power_db).scenario, certify=False).objective.value
        assert 10.0 * np.log10(solved) == pytest.approx(known_db, abs=0.006)
        assert values_db[np.argmin(np.abs(powers_db - power_db))] == pytest.approx(known_db, abs=0.2)
    inner = plot.locator("svg")
    left, top, width, height = map(float, (inner.get_attribute("viewBox") or "").split())
    assert points[:, 1].max() > top + height + 20.0
    box = inner.bounding_box()
    assert box is not None
    picture = imread(io.BytesIO(hand.page.screenshot(clip=dict(box), scale="css")))[..., :3]
    columns = (points[:, 0] - left) / width * picture.shape[1]
    leaves = int(columns[np.argmax(points[:, 1] > top + height + 5.0)])
    assert _blue(picture[:, :leaves]) > 40
    assert _blue(picture[:, leaves + 3 :]) == 0


def _stops(page: Page) -> list[list[float]]:
    """Return the colours of the card's scale from its low end to its high one."""
    gradient = page.locator(".np-scale").last.evaluate("bar => getComputedStyle(bar).backgroundImage")
    return [[float(part) for part in rgb.split(",")] for rgb in re.findall(r"rgb\((.*?)\)", gradient)]


def test_a_link_has_the_legends_colour(hand: Hand) -> None:
    """That of its SINR in the card's scale, along the part of it that nothing hides."""
    page = hand.page
    _show(hand, State(scenario=PAPER, case=case_named("Vertical")))
    hand.tab("Map and view")
    hand.choose(0, MAPS[0])
    links = page.locator("[data-np=overlay-links]").last
    hand.until(lambda: links.inner_text().startswith("lines to nodes: "))
    low, high = map(float, re.findall(r"-?\d+(?:\.\d+)?", links.inner_text().replace(MINUS, "-")))
    assert low < min(link.sinr_db for link in hand.session.state.current(case_named("Vertical")).result.links)
    stops: list[list[float]] = []
    hand.until(lambda: stops.extend(_stops(page)) or stops)  # a card that is being replaced has no style
    hand.choose(0, "no map")  # the links are seen through the plane of the map
    page.wait_for_timeout(1500)
    answer = hand.session.state.current(hand.session.state.case)
    picture, camera = hand.picture(), hand.camera
    for link, node in zip(answer.result.links, PAPER.nodes, strict=True):
        share = np.clip((link.sinr_db - low) / (high - low), 0.0, 1.0)
        places = np.linspace(0.0, 1.0, len(stops))
        legend = [np.interp(share, places, part) / 255 for part in np.transpose(stops)]
        way = np.linspace(node.position_m, answer.result.pose.position_m, 60)[12:30]
        far = [np.abs(_around(picture, camera, point, 2) - legend).max(axis=1).min() for point in way]
        # of the sampled part a label may hide more than half; a link of another colour has none of it
        assert np.quantile(far, 0.25) < 0.05, f"{link.node}: {far}"


def test_grid_and_airspace_grow_with_a_drag(hand: Hand) -> None:
    """A node that is moved off the ground that is drawn has ground below it again, and air above it."""
    place = np.array([0.0, 70.0, 0.0])
    _show(hand, State(scenario=PAPER).moved(("nodes", 1), place))
    drawn = hand.ours._client.scene._handle_from_node_name
    for name in ("/ground/grid", "/airspace/edges"):
        points = drawn[name].points.reshape(-1, 3)
        assert np.all(points[:, :2].min(axis=0) < place[:2] - 5.0)
        assert np.all(points[:, :2].max(axis=0) > place[:2] + 5.0), name


def test_a_file_that_names_others_is_refused_in_words(hand: Hand) -> None:
    """It says what cannot be, and names no folder of this machine."""
    version = hand.session.state.version
    hand.upload(EXAMPLES / "geodetic.toml")
    hand.noticed("geodetic.toml was not taken")
    hand.refused("nodes_from")
    assert "/" not in hand.page.locator("[data-np=faults]").inner_text().replace("and/or", "")
    assert hand.session.state.version == version


FIRST_RUN = f"""
import os, threading
from nullpose import load
from nullpose.solver.kernels.bounds.branch import branch
from nullpose.studio.answer import Answer
from nullpose.studio.session import Session
from nullpose.studio.state import State
found = threading.Event()
def note(event):
    if isinstance(event, Answer) and not found.is_set():
        print(event.result.pose is not None, len(branch.overloads), flush=True)
        found.set()
Session(State(scenario=load({str(EXAMPLES / "paper.toml")!r})), on_event=note).start()
found.wait(300)
os._exit(0)
"""


def test_the_first_run_shows_a_pose_before_the_proof_is_compiled(tmp_path: Path) -> None:
    """With nothing compiled before, the search's best pose is there while the proof's kernels are not."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    ran = subprocess.run(
        [sys.executable, "-c", FIRST_RUN], env=environment, capture_output=True, text=True, timeout=300.0
    )
    assert (ran.stdout, ran.stderr) == ("True 0\n", "")
