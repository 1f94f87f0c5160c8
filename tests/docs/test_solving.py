"""The page on solving: its program prints what stands below it."""

import io
import re
from contextlib import redirect_stdout
from pathlib import Path

import nullpose

PAGE = (Path(__file__).parents[2] / "docs" / "solving.md").read_text(encoding="utf-8")


def test_the_objective_in_python() -> None:
    """The pose and its value, to the last digit."""
    ((code, text),) = re.findall(r"```python\n(.*?)```\n+```text\n(.*?)```", PAGE, flags=re.DOTALL)
    with redirect_stdout(io.StringIO()) as printed:
        exec(compile(code, "solving.md", "exec"), {"nullpose": nullpose})
    assert printed.getvalue() == text
