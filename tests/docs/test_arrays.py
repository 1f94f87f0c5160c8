"""The page on arrays: its numbers are those of the program, and its examples load."""

import io
import re
import tomllib
from pathlib import Path

import pytest
from rich.console import Console

import nullpose
from nullpose.antenna.files import read_pattern
from nullpose.antenna.summary import summary_of
from nullpose.report.pattern import pattern_view
from nullpose.scenario import Array
from nullpose.solver import Status, solve

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "arrays.md").read_text(encoding="utf-8")
EXAMPLE = ROOT / "examples" / "array.toml"
ROWS = {
    float(cells[0]): [float(cell) for cell in cells[1:]]
    for cells in (
        [cell.strip() for cell in line.strip("| \n").split("|")]
        for line in PAGE.splitlines()
        if re.match(r"\| \d", line)
    )
}


def _paper(ratio: float, array: Array) -> nullpose.Scenario:
    scenario = nullpose.load(ROOT / "examples" / "paper.toml").model_copy(update={"array": array})
    return nullpose.apply_overrides(scenario, [f"jammers.M.power_w={ratio}"])


@pytest.mark.parametrize("ratio", [0.1, 100.0])
def test_numbers_are_those_of_the_program(ratio: float) -> None:
    """Each value of a row is found again to its last digit, with a proof."""
    for elements, printed in zip((1, 2, 4, 8), ROWS[ratio], strict=True):
        solution = solve(_paper(ratio, Array(elements=elements, layout="linear", spacing_wavelengths=0.5)))
        assert solution.objective.value == pytest.approx(printed, abs=6e-5)
        assert solution.status is Status.CERTIFIED


def test_the_example_is_what_the_page_shows() -> None:
    """The table in the page is the example's, and the example solves."""
    shown = re.search(r"```toml\n(.*?)```", PAGE, flags=re.DOTALL)
    assert shown is not None
    scenario = nullpose.load(EXAMPLE)
    assert scenario.array == Array(**tomllib.loads(shown[1])["array"])
    assert solve(scenario).objective.value == pytest.approx(ROWS[10.0][2], abs=6e-5)


SECTION = (ROOT / "docs" / "antennas.md").read_text(encoding="utf-8").split("## Reading a pattern file")[1]


def test_the_console_block_is_what_is_printed() -> None:
    """Line by line."""
    file, shown = re.findall(r"\$ nullpose antenna (\S+)\n(.*?)\n```", SECTION, flags=re.DOTALL)[0]
    console = Console(file=io.StringIO(), width=80, highlight=False)
    console.print(pattern_view(summary_of(read_pattern(ROOT / file))))
    printed = [line.rstrip() for line in console.file.getvalue().rstrip().splitlines()]
    assert shown.splitlines() == printed
