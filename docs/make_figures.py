"""Update the pictures and the page of the paper's claims: `make figures`.

`nullpose reproduce` and `nullpose solve --figure` write the same files.
"""

import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

import nullpose
from nullpose.paper.reproduce import reproduce
from nullpose.report.figures.poses import draw_result
from nullpose.report.figures.style import write_figure_file
from nullpose.solve import solve_array
from nullpose.solve.robust import solve_robust

DOCS = Path(__file__).parent
IMAGES = DOCS / "images"
EXAMPLES = DOCS.parent / "examples"


def draw_examples() -> None:
    """Draw the poses of the examples that pages show, as ``nullpose solve --figure`` does."""
    plain = ("eavesdropper", "geodetic", "no-fly")
    results = {name: nullpose.solve(nullpose.load(EXAMPLES / f"{name}.toml")) for name in plain}
    results["robust"] = solve_robust(nullpose.load(EXAMPLES / "robust.toml"))
    results["array"] = solve_array(nullpose.load(EXAMPLES / "array.toml"))
    for name, result in results.items():
        write_figure_file(draw_result(result), IMAGES / f"{name}.png")


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
