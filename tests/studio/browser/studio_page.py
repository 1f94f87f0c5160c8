"""The page in a real browser: it is drawn, it solves what is dragged, it takes and gives files."""

from __future__ import annotations

import io
import struct
from base64 import b64decode
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from benchmarks.chromium import pixels
from matplotlib.image import imread
from playwright.sync_api import Page
from zstandard import ZstdDecompressor

from nullpose import load, solve
from nullpose.solver import Scheme
from nullpose.studio.server import Studio
from nullpose.studio.session import Session

POWER = "xpath=//label[.='typed (dB)']/ancestor::*[.//input][1]//input"
CERTIFIED = "document.querySelector('[data-np=status-0]')?.innerText.includes('certified to')"
Open = Callable[[], Page]
ZSTD = b"\x28\xb5\x2f\xfd"  # how what zstd has compressed begins


def _value(page: Page) -> float:
    return float(page.locator("[data-np=value-0]").get_attribute("data-value") or "nan")


def _version(page: Page) -> int:
    return int(page.locator("[data-np=readout]").get_attribute("data-version") or "0")


def _settled(page: Page, before: int) -> None:
    page.wait_for_function(
        f"+document.querySelector('[data-np=readout]').dataset.version > {before} && {CERTIFIED}"
    )


def _type_power(page: Page, decibel: str) -> None:
    page.locator(POWER).fill(decibel)
    page.locator(POWER).press("Enter")


def _on_screen(page: Page, camera: Any, point_m: Any) -> tuple[float, float]:
    """Return where a point of the scene is on the canvas, from the camera as the server knows it."""
    canvas = page.locator("canvas").first.bounding_box()
    assert canvas is not None
    x, y, _ = pixels(camera, [point_m])[0]
    return canvas["x"] + float(x), canvas["y"] + float(y)


def _pixels(page: Page) -> np.ndarray:
    return imread(io.BytesIO(page.locator("canvas").first.screenshot()))[..., :3]


def _drawn_share(pixels: np.ndarray) -> float:
    """Returns the share of the canvas that is not of the background's colour."""
    return float(np.mean(np.abs(pixels - pixels[0, -1]).max(axis=-1) > 0.08))


def test_the_scene_is_drawn(page: Page) -> None:
    """The canvas has the colours of the map, of the pattern and of the null in it, not only elements."""
    page.wait_for_selector("[data-np=plot][data-state=current]")
    for _ in range(45):  # the map may have to be compiled first
        page.wait_for_timeout(2000)
        pixels = _pixels(page)
        if _drawn_share(pixels) > 0.1:
            break
    assert _drawn_share(pixels) > 0.1
    red, green, blue = np.moveaxis(pixels, -1, 0)
    orange = (red - green > 0.15) & (green - blue > 0.1)
    assert orange.sum() > 100
    assert len(np.unique((pixels * 15).astype(int).reshape(-1, 3), axis=0)) > 80


def test_the_slider_changes_the_value_to_the_solvers(page: Page, session: Session) -> None:
    """After the jamming power is slid and then typed, the value shown is the solver's for the same scene."""
    before, version = _value(page), _version(page)
    track = page.locator(".multi-slider-track-container").first.bounding_box()
    assert track is not None
    x, y = track["x"] + 0.43 * track["width"], track["y"] + 0.5 * track["height"]
    page.mouse.move(x, y)
    page.mouse.down()
    for step in range(1, 6):
        page.mouse.move(x + 0.06 * step * track["width"], y)
        page.wait_for_timeout(60)
    page.mouse.up()
    _settled(page, version)
    page.wait_for_timeout(1500)
    page.wait_for_function(CERTIFIED)
    assert session.state.scenario.jammers[0].transmit_power_w > 5.0
    assert _value(page) == pytest.approx(solve(session.state.scenario).objective.value, rel=1e-9)
    version = _version(page)
    _type_power(page, "20")
    _settled(page, version)
    scenario = session.state.scenario
    assert scenario.jammers[0].transmit_power_w == pytest.approx(100.0)
    assert _value(page) == pytest.approx(solve(scenario).objective.value, rel=1e-9)
    assert _value(page) != pytest.approx(before, rel=1e-3)


def test_a_typed_power_is_taken_with_enter(page: Page, session: Session) -> None:
    """No keystroke changes the scene; Enter takes a number as it is, and refuses one out of range."""
    field = page.locator(POWER)
    version = _version(page)
    field.click()
    field.press("Control+A")
    field.press_sequentially("12.3456", delay=120)
    page.wait_for_timeout(500)
    assert _version(page) == version
    field.press("Enter")
    _settled(page, version)
    assert session.state.power_db == pytest.approx(12.3456, abs=1e-9)
    assert field.input_value() == "12.3456"
    version = _version(page)
    _type_power(page, "1e1")
    _settled(page, version)
    assert session.state.power_db == pytest.approx(10.0, abs=1e-9)
    version = _version(page)
    _type_power(page, "12.3456")
    _settled(page, version)
    version = _version(page)
    for refused in ("-99", "1e3"):
        _type_power(page, refused)
        page.wait_for_function(
            f"document.querySelector('[data-np=faults]').innerText.includes('given {refused}')"
        )
        page.wait_for_function("field => field.value == '12.3456'", arg=field.element_handle())
    assert _version(page) == version


def _click(page: Page, ours: Any, point_m: Any) -> None:
    page.mouse.click(*_on_screen(page, ours._client.camera, point_m))


def test_a_dragged_handle_moves_the_jammer(page: Page, session: Session, running: Studio) -> None:
    """A click selects the jammer; its arrows drag it along the ground; the value is the solver's there."""
    ours = next(iter(running.pages.values()))
    camera = ours._client.camera
    version = _version(page)
    start = np.asarray(session.state.scenario.jammers[0].position_m)
    page.wait_for_timeout(3000)
    size_m = ours.stage.size_m
    _click(page, ours, start + np.array([0.0, 0.0, 0.01 * size_m]))
    page.get_by_text("Selected: M").wait_for()
    page.wait_for_timeout(1000)
    x, y = _on_screen(page, camera, start + np.array([0.06 * size_m, 0.0, 0.0]))
    to = _on_screen(page, camera, start + np.array([0.06 * size_m + 12.0, 0.0, 0.0]))
    page.mouse.move(x, y)
    page.wait_for_timeout(500)
    page.mouse.down()
    for share in np.linspace(0.1, 1.0, 12):
        page.mouse.move(x + share * (to[0] - x), y + share * (to[1] - y))
        page.wait_for_timeout(60)
    page.mouse.up()
    _settled(page, version)
    page.wait_for_timeout(1500)
    page.wait_for_function(CERTIFIED)
    moved = np.array(session.state.scenario.jammers[0].position_m)
    assert np.linalg.norm(moved - start) > 4.0
    assert moved[2] == start[2]
    assert _value(page) == pytest.approx(solve(session.state.scenario).objective.value, rel=1e-9)
    page.keyboard.press("Escape")


def test_two_browsers_keep_their_own_state(page: Page, open_page: Open) -> None:
    """What one changes the other does not see."""
    first, second = page, open_page()
    value, version = _value(second), _version(second)
    first.bring_to_front()
    before = _version(first)
    _type_power(first, "30")
    _settled(first, before)
    assert _value(first) != pytest.approx(value, rel=1e-3)
    assert (_value(second), _version(second)) == (value, version)
    second.context.close()


def test_cases_are_chosen_and_compared(page: Page, session: Session) -> None:
    """A case from the list is solved as the solver does, and two are set beside each other."""
    paper = session.state.scenario
    version = _version(page)
    page.locator("input.mantine-Select-input:visible").nth(0).click()
    page.get_by_role("option", name="Vertical", exact=True).click()
    _settled(page, version)
    assert _value(page) == pytest.approx(solve(paper, Scheme.VERTICAL).objective.value, rel=1e-9)
    version = _version(page)
    page.locator("input.mantine-Select-input:visible").nth(1).click()
    page.get_by_role("option", name="Optimum pose", exact=True).click()
    page.wait_for_selector("[data-np=difference]")
    assert float(page.locator("[data-np=value-1]").get_attribute("data-value") or "nan") > _value(page)


def test_files_go_out_and_come_back(page: Page, session: Session, tmp_path: Path) -> None:
    """A saved scene loads as it was; a broken file shows its faults by path and changes nothing."""
    version = _version(page)
    _type_power(page, "10")
    _settled(page, version)
    scenario = session.state.scenario
    page.get_by_role("tab", name="Files").click()
    with page.expect_download() as download:
        page.get_by_role("button", name="Save scenario").click()
    saved = tmp_path / "saved.toml"
    download.value.save_as(saved)
    assert load(saved) == scenario
    saved.write_text(f"# Mine.\n{saved.read_text()}")

    version = _version(page)
    broken = tmp_path / "broken.toml"
    broken.write_text("[airspace]\naltitude_m = [30.0, 8.0]\n[[nodes]]\npower_w = -1\n")
    _upload(page, broken)
    page.wait_for_function("document.querySelector('[data-np=faults]').innerText.includes('broken.toml')")
    page.locator(".mantine-Notification-root", has_text="broken.toml was not taken").wait_for()
    told = page.locator("[data-np=faults]").inner_text()
    assert "airspace.altitude_m" in told
    assert "nodes[0].power_w" in told
    assert _version(page) == version

    page.get_by_role("tab", name="Scene").click()
    page.get_by_role("button", name="Undo").click()
    _settled(page, version)
    assert session.state.scenario != scenario
    version = _version(page)
    page.get_by_role("tab", name="Files").click()
    _upload(page, saved)
    _settled(page, version)
    assert session.state.scenario == scenario
    assert page.locator("[data-np=faults]").inner_text() == ""
    version = _version(page)
    page.get_by_role("tab", name="Scene").click()
    _type_power(page, "20")
    _settled(page, version)
    page.get_by_role("tab", name="Files").click()
    with page.expect_download() as download:
        page.get_by_role("button", name="Save scenario").click()
    download.value.save_as(saved)
    assert saved.read_text().startswith("# Mine.\n")
    assert load(saved) == session.state.scenario != scenario


def test_the_exported_scene_needs_no_server(page: Page, running: Studio, tmp_path: Path) -> None:
    """The exported HTML draws what the page shows from a file, with its value, and asks for nothing else."""
    page.wait_for_selector("[data-np=plot][data-state=current]")
    camera = next(iter(running.pages.values()))._client.camera
    camera.position = (50.0, 60.0, 25.0)
    page.wait_for_timeout(2000)
    page.get_by_role("tab", name="Files").click()
    with page.expect_download() as download:
        page.get_by_role("button", name="Export scene").click()
    path = tmp_path / "scene.html"
    download.value.save_as(path)
    asked: list[str] = []
    alone = page.context.new_page()
    alone.on("request", lambda request: asked.append(request.url))
    alone.goto(path.as_uri())
    alone.wait_for_selector("canvas")
    alone.wait_for_timeout(6000)
    for part in ("value-0", "status-0", "ends"):
        shown = page.locator(f"[data-np=overlay-{part}]").first.inner_text()
        assert alone.locator(f"[data-np=overlay-{part}]").inner_text() == shown
    packed = b64decode(path.read_text(encoding="utf-8").split('__VISER_EMBED_DATA__="')[1].split('"')[0])
    messages = ZstdDecompressor().decompressobj().decompress(packed[packed.index(ZSTD) :])
    assert all(struct.pack(">d", number) in messages for number in camera.position)
    pixels = imread(io.BytesIO(alone.screenshot()))[..., :3]
    assert (np.abs(pixels - pixels[0, -1]).max(axis=-1) > 0.08).mean() > 0.05
    alone.close()
    assert [url for url in asked if url.startswith(("http", "ws"))] == []


_PATTERN = """() => {
  const [scene, pattern] = ['', '/drone-a/body/antenna/pattern'].map(
    name => window.__viserMutable.nodeRefFromName[name]);
  return scene.matrixWorld.clone().invert().multiply(pattern.matrixWorld).toArray();
}"""


def test_the_pattern_opens_towards_the_camera(page: Page, session: Session, running: Studio) -> None:
    """Also after the camera has gone around: in the plane across the antenna the opening points at it."""
    camera = next(one for one in running.pages.values() if one.session is session)._client.camera
    middle_m = camera.look_at
    for eye_m in ([60.0, 40.0, 30.0], [-50.0, -40.0, 60.0]):
        camera.position = eye_m
        camera.look_at = middle_m
        page.wait_for_timeout(4000)
        x, y, _, place_m = np.reshape(page.evaluate(_PATTERN), (4, 4))[:, :3]
        towards = np.subtract(eye_m, place_m)
        assert abs(np.arctan2(towards @ y, towards @ x)) < 0.1


def test_presenting_folds_the_panel(page: Page, session: Session) -> None:
    """P begins it and Escape ends it; the card stays."""
    page.mouse.click(400, 20)
    page.keyboard.press("p")
    page.get_by_role("tab", name="Files").wait_for(state="hidden")
    assert page.locator("#np-overlay").is_visible()
    page.keyboard.press("Escape")
    page.get_by_role("tab", name="Files").wait_for()


def test_a_picture_of_the_scene_is_exported(
    page: Page, session: Session, running: Studio, tmp_path: Path
) -> None:
    """As the canvas shows it, at twice its size, with the answer below; a camera too far away is told."""
    page.wait_for_selector("[data-np=plot][data-state=current]")
    camera = next(iter(running.pages.values()))._client.camera
    page.get_by_role("tab", name="Files").click()
    with page.expect_download() as download:
        page.get_by_role("button", name="Export picture").click()
    path = tmp_path / "scene.png"
    download.value.save_as(path)
    pixels = imread(path)
    assert pixels.shape[1] == 2 * camera.image_width
    drawn, below = np.split(pixels, [2 * camera.image_height])
    assert _drawn_share(drawn[..., :3]) > 0.03  # wherever the camera is
    assert below[..., :3].min() < 0.2  # text
    assert np.array_equal(pixels[..., 3], np.ones(pixels.shape[:2]))
    near_m = np.array(camera.position)
    camera.position = near_m * 2000.0 / np.linalg.norm(near_m)  # the tests before left it anywhere
    page.get_by_role("button", name="Export picture").click()
    page.locator(".mantine-Notification-root", has_text="a picture holds 1000 m").wait_for()
    camera.position = near_m


def _upload(page: Page, path: Path) -> None:
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Load scenario").click()
    chooser.value.set_files(path)
