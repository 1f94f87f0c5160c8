"""Update the pictures and the page of the paper's claims: `make figures`.

`nullpose reproduce` and `nullpose solve --figure` write the same pictures.
"""

import shutil
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from claims.page import check_claims, claims_page

import nullpose
from nullpose.antenna.files import read_pattern
from nullpose.paper import reproduce
from nullpose.report.figures.pattern import draw_pattern
from nullpose.report.figures.poses import draw_result
from nullpose.report.figures.trajectory import draw_flight
from nullpose.solver import solve
from nullpose.study.between_instants import sample_between

DOCS = Path(__file__).parent
sys.path.append(str(DOCS / "figures"))

from twins import darken, write  # noqa: E402

IMAGES = DOCS / "images"
EXAMPLES = DOCS.parent / "examples"
PATTERN = DOCS.parent / "tests" / "antenna" / "data" / "hex35_above_10_half_off20mm_5deg.out.gz"


def draw_examples() -> None:
    """Draw the poses and the pattern that pages show, as ``--figure`` does."""
    plain = ("eavesdropper", "geodetic", "no-fly")
    results = {name: nullpose.solve(nullpose.load(EXAMPLES / f"{name}.toml")) for name in plain}
    results["robust"] = solve(nullpose.load(EXAMPLES / "robust.toml"), robust=True)
    results["array"] = solve(nullpose.load(EXAMPLES / "array.toml"))
    for name, result in results.items():
        write(draw_result(result), name)
    write(draw_pattern(read_pattern(PATTERN, estimate=True)), "pattern-file")


def draw_trajectory() -> None:
    """Draw the flight of the page on trajectories, as ``trajectory --out`` does."""
    example = nullpose.load(EXAMPLES / "moving_jammer.toml")
    flight = nullpose.solve_trajectory(nullpose.apply_overrides(example, ["jammers.M.power_w=100"]))
    figures = draw_flight(flight, sample_between(flight))
    write(figures["plan"], "trajectory")
    write(figures["values"], "trajectory-values")


def main() -> None:
    """Draw the examples, run the reproduction, copy its figures and check the claims on its data."""
    draw_examples()
    draw_trajectory()
    with TemporaryDirectory() as folder:
        reproduction = reproduce(Path(folder))
        for name in ("figure2.png", "figure2-printed.png", "poses.png"):
            darken(Path(shutil.copyfile(Path(folder) / name, IMAGES / name)))
    page = claims_page(reproduction, check_claims(reproduction))
    (DOCS / "claims.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
