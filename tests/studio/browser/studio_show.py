"""A scene is shown in a notebook and in the browser, by itself."""

import io
import stat
import webbrowser
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import nbclient
import numpy as np
import pytest
from benchmarks.chromium import pixels
from matplotlib.image import imread
from nbformat import v4
from playwright.sync_api import Browser
from tests.studio.browser.hand import EXAMPLES, PAPER

import nullpose
from nullpose.studio.camera import PHONE_CARD_PX, aim


def _value(browser: Browser, path: Path) -> float:
    """Return the value that a page alone shows, once its scene is drawn."""
    page = browser.new_page(viewport={"width": 640, "height": 400})
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(path.as_uri())
    frame = page.frames[-1]
    frame.wait_for_selector("canvas")
    value = frame.locator("[data-np=overlay-value-0]").get_attribute("data-value")
    assert "Proved optimal (gap 0.0001 %)" in frame.locator("#np-overlay").inner_text()
    assert [url for url in asked if url.startswith(("http", "ws"))] == []
    page.close()
    return float(value or "nan")


def test_elsewhere_it_opens_in_the_browser(
    browser: Browser, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """From a file of the user's own, with the value of the result; a scenario is solved for it."""
    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    vertical = nullpose.solve(PAPER, "vertical")
    for found, value in (
        (PAPER, nullpose.solve(PAPER).objective.value),
        (vertical, vertical.objective.value),
    ):
        path = nullpose.show(found, dark=found is vertical)
        assert path is not None
        assert opened.pop() == path.as_uri()
        assert stat.S_IMODE(path.stat().st_mode) == 0o600
        assert _value(browser, path) == value
        path.unlink()
    assert capfd.readouterr() == ("", "")
    with pytest.raises(nullpose.UsageError, match="array"):
        nullpose.show(nullpose.solve(nullpose.load(EXAMPLES / "array.toml")))


def test_in_a_notebook_it_is_below_the_cell(browser: Browser, tmp_path: Path) -> None:
    """As one output that is saved with the notebook, and draws the scene by itself."""
    code = f"import nullpose\nnullpose.show(nullpose.load({str(EXAMPLES / 'paper.toml')!r}), height=300)"
    notebook: Any = v4.new_notebook(cells=[v4.new_code_cell(code)])
    nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
    (output,) = notebook.cells[0].outputs
    path = tmp_path / "notebook.html"
    path.write_text(f"<meta charset=utf-8>{output.data['text/html']}", encoding="utf-8")
    assert _value(browser, path) == nullpose.solve(PAPER).objective.value


def test_on_a_phone_the_drone_is_in_the_frame(browser: Browser, monkeypatch: pytest.MonkeyPatch) -> None:
    """Below the card, where the camera for a phone has it; and nothing of viser's can be opened."""
    monkeypatch.setattr(webbrowser, "open", lambda address: None)
    result = nullpose.solve(nullpose.load(EXAMPLES / "field.toml"), certify=False)
    path = nullpose.show(result)
    assert path is not None
    page = browser.new_page(viewport={"width": 390, "height": 844}, is_mobile=True, has_touch=True)
    page.goto(path.as_uri())
    page.wait_for_selector("canvas")
    page.wait_for_timeout(3000)
    for button in page.locator("button.mantine-Notification-closeButton").all():
        button.click()
    page.wait_for_timeout(1000)
    camera = SimpleNamespace(
        position=np.ones(3), look_at=np.zeros(3), fov=1.309, image_width=390, image_height=844
    )
    aim(camera, result.scenario, result.pose)
    x, y, _ = pixels(camera, [result.pose.position_m])[0]
    picture = imread(io.BytesIO(page.screenshot()))[..., :3]
    drone = picture[int(y) - 6 : int(y) + 7, int(x) - 6 : int(x) + 7]
    assert y > PHONE_CARD_PX[1]
    assert np.mean(drone.max(axis=-1) < 0.75) > 0.3, "there is no drone where it is to be"
    assert [one for one in page.get_by_label("scene tree").all() if one.is_visible()] == []
    page.close()
    path.unlink()
