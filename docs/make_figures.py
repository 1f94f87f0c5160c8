"""Bring the pictures and the page of the paper's claims up to date: `make figures`.

They are what `nullpose reproduce` and `nullpose solve --figure` write: pages show what the program says.
"""

import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

import nullpose
from nullpose.paper.reproduce import reproduce
from nullpose.report.figures.poses import draw_array, draw_robust
from nullpose.report.figures.style import write_figure_file
from nullpose.solve import solve_array
from nullpose.solve.robust import solve_robust

DOCS = Path(__file__).parent
IMAGES = DOCS / "images"
EXAMPLES = DOCS.parent / "examples"


def draw_examples() -> None:
    """Draw what the examples with errors and with an array come to."""
    robust = solve_robust(nullpose.load(EXAMPLES / "robust.toml"))
    write_figure_file(draw_robust(robust), IMAGES / "robust.png")
    array = solve_array(nullpose.load(EXAMPLES / "array.toml"), "digital")
    write_figure_file(draw_array(array), IMAGES / "array.png")


def main() -> None:
    """Run the reproduction and copy its figures and its claims, and draw the examples."""
    draw_examples()
    with TemporaryDirectory() as folder:
        reproduce(Path(folder))
        for name in ("figure2.png", "poses.png"):
            shutil.copyfile(Path(folder) / name, IMAGES / name)
        shutil.copyfile(Path(folder) / "claims.md", DOCS / "claims.md")


if __name__ == "__main__":
    main()
