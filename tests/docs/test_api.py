"""The pages on Python name every public function, describe every public name, and their snippets run."""

import inspect
import re
from pathlib import Path

import pytest
from matplotlib import pyplot

import nullpose

ROOT = Path(__file__).parents[2]
OVERVIEW = (ROOT / "docs" / "api.md").read_text(encoding="utf-8")
PAGES = {path.stem: path.read_text(encoding="utf-8") for path in sorted((ROOT / "docs" / "api").glob("*.md"))}
FUNCTIONS = [name for name in nullpose.__all__ if inspect.isfunction(getattr(nullpose, name))]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_public_function_is_in_the_overview(name: str) -> None:
    """Its call stands in the table."""
    assert f"`nullpose.{name}(" in OVERVIEW


def test_every_page_is_in_the_overview() -> None:
    """The overview leads to each page, and to no other."""
    assert set(re.findall(r"^api/(\w+)$", OVERVIEW, flags=re.MULTILINE)) == set(PAGES)


@pytest.mark.parametrize("page", [page for page, text in PAGES.items() if "```python" in text])
def test_snippets_run(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the paper's scene, and one in motion, each snippet of a page runs, from top to bottom."""
    scenario = nullpose.load(ROOT / "examples" / "paper.toml")
    vehicle = ["airframe.preset=omnidirectional", "airframe.speed_max_m_s=5", "time.step_s=10"]
    moving = nullpose.load(ROOT / "examples" / "moving_jammer.toml", overrides=vehicle)
    names = {
        "nullpose": nullpose,
        "Path": Path,
        "scenario": scenario,
        "scenarios": [scenario],
        "moving": moving,
    }
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text("nodes = 1\n", encoding="utf-8")
    for snippet in re.findall(r"```python\n(.*?)```", PAGES[page], flags=re.DOTALL):
        exec(compile(snippet, f"docs/api/{page}.md", "exec"), names)
    pyplot.close("all")
