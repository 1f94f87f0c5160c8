"""Tables in LaTeX: the numbers of the table on the screen, with what LaTeX gives a meaning escaped."""

from nullpose import Scenario, sweep
from nullpose.report.comparison import compare_all, comparison_latex
from nullpose.report.document import latex_table
from nullpose.report.sweep import sweep_latex


def test_cells_and_rules() -> None:
    """Rules of booktabs, numbers with a minus sign, and no letter that LaTeX would read as its own."""
    rows = [{"": "a_b", "50 %": "-1.50"}, {}, {"": "c & d", "50 %": "2"}, {}]
    assert latex_table(rows).splitlines() == [
        r"\begin{tabular}{lr}",
        r"\toprule",
        r" & 50 \% \\",
        r"\midrule",
        r"a\_b & $-1.50$ \\",
        r"\midrule",
        r"c \& d & 2 \\",
        r"\bottomrule",
        r"\end{tabular}",
    ]


def test_a_comparison_and_a_sweep(paper: Scenario) -> None:
    """Every case has a column, and every value a row."""
    table = comparison_latex(compare_all(paper, certify=False))
    assert "Optimum & Zero interference & Maximum gain & Vertical" in table
    assert "smallest SINR (dB) & 0.9836997 & 0.81" in table
    swept = sweep_latex(sweep(paper, "jammers.M.power_w", [1.0, 10.0], certify=False)).splitlines()
    assert swept[2].startswith("Power of jammer M (W) & optimum pose")
    assert [line.split(" & ")[0] for line in swept[4:6]] == ["1", "10"]
