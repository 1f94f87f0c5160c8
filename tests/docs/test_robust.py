"""The page on robust poses: its numbers, and its example."""

import re
from pathlib import Path

import pytest

import nullpose
from nullpose.solver.robust import guarantee

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "robust.md").read_text(encoding="utf-8")


def test_numbers_of_the_page() -> None:
    """Poses, nominal and guaranteed values and the bound in the page's table are those computed now."""
    scenario = nullpose.load(ROOT / "examples" / "robust.toml")
    solved = nullpose.solve(nullpose.apply_overrides(scenario, ["receiver.position_error_m=0"]), robust=True)
    rows = re.findall(r"\| best (as stated|guaranteed) \| \((.+?)\) \| (.+?) \| (.+?) \| (.+?) \|", PAGE)
    assert [row[0] for row in rows] == ["as stated", "guaranteed"]
    for (_, place, *told), held in zip(rows, (solved.details.nominal, solved.details.robust), strict=True):
        assert [float(x) for x in place.split(",")] == pytest.approx(list(held.pose.position_m), abs=0.05)
        values = (held.nominal, held.guaranteed, held.worst)
        assert [float(x) for x in told] == pytest.approx(values, rel=1e-3)
    bound = re.search(r"No pose guarantees more than ([0-9.]+?)\. ", PAGE)
    assert bound is not None
    assert float(bound[1]) == pytest.approx(solved.objective.upper_bound, rel=1e-3)
    assert solved.details.gain == pytest.approx(1.8, abs=0.05)


def test_example_of_the_page(monkeypatch: pytest.MonkeyPatch) -> None:
    """The Python example runs as printed, and its last pose has a guarantee below its worst case."""
    monkeypatch.chdir(ROOT)
    code = re.search(r"```python\n(.+?)```", PAGE, re.DOTALL)
    assert code is not None
    names: dict[str, object] = {}
    exec(compile(code[1], "docs/robust.md", "exec"), names)
    held = names["held"]
    assert isinstance(held, type(guarantee(nullpose.load("examples/paper.toml"), [0, 0, 9], [0, 0, 1])))
    assert 0.0 < held.lower <= held.worst
