"""What was once wrong in the studio, each fault looked for as a user would meet it."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from benchmarks.chromium import pixels
from matplotlib.image import imread
from numpy.typing import NDArray
from playwright.sync_api import Page

from nullpose import load, solve
from nullpose.report.numbers import MINUS
from nullpose.scenario import Scenario
from nullpose.studio.case import case_named
from nullpose.studio.field_map import MAPS
from nullpose.studio.server import Studio
from nullpose.studio.session import Session
from nullpose.studio.state import State

EXAMPLES = Path(__file__).parents[3] / "examples"
CERTIFIED = "document.querySelector('[data-np=status-0]')?.innerText.includes('certified to')"
KNOWN_DB = {20.0: -4.41, 30.0: -14.15, 40.0: -24.12}  # of field.toml's best pose, by the jamming power
AFTER_A_SECOND = 1000.0

Shown = Callable[[State], None]


@pytest.fixture
def shown(page: Page, session: Session) -> Shown:
    """Shows a view on the shared page, waits for its numbers and its map, and looks at all of it."""

    def show(view: State) -> None:
        session.change(lambda state: state.with_scene_of(view))
        page.wait_for_function(
            f"+document.querySelector('[data-np=readout]').dataset.version == {session.state.version}"
            " && !document.querySelector('[data-np=status-0]').innerText.includes('solving')"
        )
        _until(page, lambda: session.state.field_map is not None)
        page.get_by_role("tab", name="Map and view").click()
        page.get_by_role("button", name="Reset the camera").click()
        page.get_by_role("tab", name="Scene").click()
        page.wait_for_timeout(AFTER_A_SECOND)

    return show


@pytest.fixture
def best_map(page: Page) -> Iterator[None]:
    """The map of the best values is chosen, and the other one again in the end."""
    _choose_map(page, MAPS[0])
    yield
    _choose_map(page, MAPS[1])


@pytest.fixture
def ours(session: Session, running: Studio) -> Any:
    """The server's side of the shared page."""
    return next(one for one in running.pages.values() if one.session is session)


def _until(page: Page, met: Callable[[], object], seconds: int = 90) -> None:
    for _ in range(10 * seconds):
        if met():
            return
        page.wait_for_timeout(100)
    raise AssertionError("it did not happen in time")


def _choose_map(page: Page, name: str) -> None:
    page.get_by_role("tab", name="Map and view").click()
    page.locator("input.mantine-Select-input:visible").first.click()
    page.get_by_role("option", name=name, exact=True).click()
    page.get_by_role("tab", name="Scene").click()


def _pixels(page: Page) -> NDArray[np.float64]:
    """Returns the canvas without what the page lays over it, a pixel for each of the page's."""
    hidden = page.add_style_tag(content="#np-overlay { visibility: hidden }")
    picture = imread(io.BytesIO(page.locator("canvas").first.screenshot(scale="css")))[..., :3]
    hidden.evaluate("element => element.remove()")
    return np.asarray(picture, dtype=float)


def _around(picture: NDArray[np.float64], camera: Any, point_m: Any, reach_px: int) -> NDArray[np.float64]:
    """Returns the pixels, (n, 3), around a point of the scene."""
    x, y, _ = pixels(camera, [point_m])[0].round().astype(int)
    window = picture[max(0, y - reach_px) : y + reach_px + 1, max(0, x - reach_px) : x + reach_px + 1]
    return window.reshape(-1, 3)


def _is_blue(pixels: NDArray[np.float64]) -> NDArray[np.bool_]:
    red, green, blue = np.moveaxis(pixels, -1, 0)
    return (blue - red > 0.3) & (blue - green > 0.1)


def _is_orange(pixels: NDArray[np.float64]) -> NDArray[np.bool_]:
    red, green, blue = np.moveaxis(pixels, -1, 0)
    return (red - green > 0.2) & (green - blue > 0.1)


def _card_ends(page: Page) -> tuple[float, float]:
    """Returns the ends of the colours on the card."""
    text = page.locator("[data-np=overlay-ends]").last.inner_text().replace(MINUS, "-")
    low, high = (float(number) for number in re.findall(r"-?\d+(?:\.\d+)?", text))
    return low, high


def _of_a_kilometre(paper: Scenario) -> Scenario:
    """Returns the paper's scene, 20 times as large."""
    points = [
        one.model_copy(update={"position_m": tuple(20.0 * np.array(one.position_m))})
        for one in (*paper.nodes, *paper.jammers)
    ]
    nodes, jammers = points[:-1], points[-1:]
    airspace = paper.airspace.model_copy(update={"altitude_m": (160.0, 600.0)})
    update = {"nodes": tuple(nodes), "jammers": tuple(jammers), "airspace": airspace}
    return paper.model_copy(update=update)


def test_a_scene_of_a_kilometre_is_drawn(
    page: Page, ours: Any, shown: Shown, paper: Scenario, tmp_path: Path
) -> None:
    """Its points and its map, on the page and in the exported file: the camera sees far enough."""
    scenario = _of_a_kilometre(paper)
    shown(State(scenario=scenario))
    page.wait_for_timeout(2.0 * AFTER_A_SECOND)
    picture, camera = _pixels(page), ours._client.camera
    for node in scenario.nodes:
        assert _is_blue(_around(picture, camera, node.position_m, 10)).sum() > 10
    assert _is_orange(_around(picture, camera, scenario.jammers[0].position_m, 10)).sum() > 10
    field = ours.session.state.field_map.footprint
    inside = slice(len(field.east_m) // 4, -len(field.east_m) // 4, 3)
    ground = [(east, north, 0.0) for east in field.east_m[inside] for north in field.north_m[inside]]
    tints = [np.ptp(np.median(_around(picture, camera, one, 1), axis=0)) for one in ground]
    assert np.mean(np.array(tints) > 0.03) > 0.8

    page.get_by_role("tab", name="Files").click()
    with page.expect_download() as download:
        page.get_by_role("button", name="Export scene").click()
    path = tmp_path / "scene.html"
    download.value.save_as(path)
    alone = page.context.new_page()
    alone.goto(path.as_uri())
    alone.wait_for_selector("canvas")
    alone.wait_for_timeout(6.0 * AFTER_A_SECOND)
    exported = _pixels(alone)
    alone.close()
    assert _is_blue(exported).sum() > 40
    assert _is_orange(exported).sum() > 40
    assert np.mean(np.ptp(exported, axis=-1) > 0.03) > 0.05


def test_the_plots_curves_leave_it_where_they_are_below_it(page: Page, shown: Shown) -> None:
    """Read by its axes the best pose's curve is what solve says, also where it is cut off."""
    view = State(scenario=load(EXAMPLES / "field.toml"))
    shown(view)
    page.wait_for_selector("[data-np=plot][data-state=current]")
    plot = page.locator("[data-np=plot] > svg")
    texts = plot.locator("text").evaluate_all(
        "all => all.map(one => [one.getAttribute('text-anchor'), one.getAttribute('x'),"
        "one.getAttribute('y'), one.textContent])"
    )
    numbers = [
        (anchor, float(x), float(y), float(text.replace(MINUS, "-")))
        for anchor, x, y, text in texts
        if re.fullmatch(rf"[{MINUS}-]?\d+(\.\d+)?", text)
    ]
    across = np.polyfit(
        *zip(*((x, power) for anchor, x, _, power in numbers if anchor == "middle"), strict=True), 1
    )
    up = np.polyfit(
        *zip(*((y - 3.5, value) for anchor, _, y, value in numbers if anchor == "end"), strict=True), 1
    )
    line = plot.locator("polyline").first
    points = np.array([pair.split(",") for pair in (line.get_attribute("points") or "").split()], float)
    powers_db, values_db = np.polyval(across, points[:, 0]), np.polyval(up, points[:, 1])
    for power_db, known_db in KNOWN_DB.items():
        solved = solve(view.with_power_db(power_db).scenario, certify=False).objective.value
        assert 10.0 * np.log10(solved) == pytest.approx(known_db, abs=0.006)
        assert values_db[np.argmin(np.abs(powers_db - power_db))] == pytest.approx(known_db, abs=0.2)
    inner = plot.locator("svg")
    left, top, width, height = map(float, (inner.get_attribute("viewBox") or "").split())
    assert points[:, 1].max() > top + height + 20.0
    box = inner.bounding_box()
    assert box is not None
    picture = imread(io.BytesIO(page.screenshot(clip=dict(box), scale="css")))[..., :3]
    columns = (points[:, 0] - left) / width * picture.shape[1]
    leaves = int(columns[np.argmax(points[:, 1] > top + height + 5.0)])
    assert _is_blue(picture[:, :leaves]).sum() > 40
    assert _is_blue(picture[:, leaves + 3 :]).sum() == 0


@pytest.mark.usefixtures("best_map")
@pytest.mark.parametrize("case", ["Optimum pose", "Vertical"])
def test_a_link_has_the_legends_colour(
    page: Page, session: Session, ours: Any, shown: Shown, paper: Scenario, case: str
) -> None:
    """That of its SINR in the card's scale, along the part of it that nothing hides."""
    shown(State(scenario=paper, case=case_named(case)))
    page.wait_for_timeout(AFTER_A_SECOND)
    low, high = _card_ends(page)
    assert page.locator("[data-np=overlay-links]").last.inner_text() == "lines to nodes: the same colours"
    gradient = page.locator(".np-scale").last.evaluate("bar => getComputedStyle(bar).backgroundImage")
    stops = [[float(part) for part in rgb.split(",")] for rgb in re.findall(r"rgb\((.*?)\)", gradient)]
    _choose_map(page, "no map")  # the links are seen through the plane of this one
    page.wait_for_timeout(AFTER_A_SECOND)
    answer = session.state.current(session.state.case)
    assert answer is not None
    picture, camera = _pixels(page), ours._client.camera
    for link, node in zip(answer.result.links, session.state.scenario.nodes, strict=True):
        share = np.clip((link.sinr_db - low) / (high - low), 0.0, 1.0)
        legend = [
            np.interp(share, np.linspace(0.0, 1.0, len(stops)), one) / 255 for one in np.transpose(stops)
        ]
        way = np.linspace(node.position_m, answer.result.pose.position_m, 60)[12:30]
        far = [np.abs(_around(picture, camera, point, 2) - legend).max(axis=1).min() for point in way]
        # of the sampled part a label may hide more than half; a link of another colour has none of it
        assert np.quantile(far, 0.25) < 0.05, f"{link.node}: {far}"


def test_grid_and_airspace_grow_with_a_drag(ours: Any, shown: Shown, paper: Scenario) -> None:
    """A node that is moved off the ground that is drawn has ground below it again, and air above it."""
    place = np.array([0.0, 70.0, 0.0])
    shown(State(scenario=paper).moved(("nodes", 1), place))
    drawn = ours._client.scene._handle_from_node_name
    for name in ("/ground/grid", "/airspace/edges"):
        points = drawn[name].points.reshape(-1, 3)
        assert np.all(points[:, :2].min(axis=0) < place[:2] - 5.0)
        assert np.all(points[:, :2].max(axis=0) > place[:2] + 5.0), name


def test_a_file_that_names_others_is_refused_in_words(page: Page, session: Session) -> None:
    """It says what cannot be, and names no folder of this machine."""
    version = session.state.version
    page.get_by_role("tab", name="Files").click()
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Load scenario").click()
    chooser.value.set_files(EXAMPLES / "geodetic.toml")
    faults = page.locator("[data-np=faults]")
    _until(page, lambda: "geodetic.toml" in faults.inner_text())
    told = faults.inner_text()
    assert "nodes_from" in told
    assert "/" not in told.replace("and/or", "")
    assert session.state.version == version
    page.locator(".mantine-Notification-root", has_text="geodetic.toml was not taken").wait_for()


_FIRST_RUN = """
import threading
from nullpose import load
from nullpose.solver.kernels.branch import branch
from nullpose.studio.answer import Answer
from nullpose.studio.session import Session
from nullpose.studio.state import State
found = threading.Event()
def told(event):
    if isinstance(event, Answer) and not found.is_set():
        print(event.result.pose is not None, len(branch.entries), flush=True)
        found.set()
Session(State(scenario=load({path!r})), on_event=told).start()
found.wait(300)
import os; os._exit(0)
"""


@pytest.mark.parametrize("name", ["paper", "field"])
def test_the_first_run_shows_a_pose_before_the_proof_is_compiled(name: str, tmp_path: Path) -> None:
    """With nothing compiled before, the search's best pose is there while the proof's kernels are not."""
    program = _FIRST_RUN.format(path=str(EXAMPLES / f"{name}.toml"))
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    ran = subprocess.run(
        [sys.executable, "-c", program], env=environment, capture_output=True, text=True, timeout=300.0
    )
    assert (ran.stdout, ran.stderr) == ("True 0\n", "")
