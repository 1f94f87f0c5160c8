"""What a report writes: for every kind of study, whole, and the same each time."""

import json
import math
import re
import sys
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from nullpose import OutputError, UsageError
from nullpose.files import json_text
from nullpose.report.study import report_study
from nullpose.study.monte_carlo import StudySpec, folder as folder_module, read_study, run_study

Make = Callable[..., Path]
Ladder = Callable[..., Any]
SWEEP = {"jammers.M.power_w": [0.2, 200.0]}
ALL = ("distribution", "gain")


class _Page(HTMLParser):
    """What a page holds: its tags, and where its addresses lead."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.addresses: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.addresses += [value or "" for key, value in attrs if key in ("src", "href", "srcset", "action")]


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Puts empty pictures in the place of figures, for what is not about them."""

    def write(figure: object, *paths: Path) -> tuple[Path, ...]:
        for path in paths:
            path.write_text("<svg/>", encoding="utf-8")
        return paths

    monkeypatch.setattr("nullpose.report.study.writing.write_figure", write)


def test_files_of_a_report(make: Make, ladder: Ladder) -> None:
    """Markdown, a page that asks for nothing, two tables, each figure twice; what the text names is there."""
    folder = make(ladder(40, 1.0, 2.0, points=2), sweep=SWEEP)
    report = report_study(folder, requirement_db=-20.0)
    there = {
        str(path.relative_to(folder / "report")) for path in (folder / "report").rglob("*") if path.is_file()
    }
    figures = {f"figures/{name}{suffix}" for name in ALL for suffix in (".png", ".svg", ".pdf")}
    assert there == figures | {"report.md", "report.html", "summary.csv", "study.csv"}
    assert {str(path.relative_to(folder / "report")) for path in report.files} == there
    text = (folder / "report" / "report.md").read_text(encoding="utf-8")
    assert text.splitlines()[0] == "# made up"
    assert text.splitlines()[2].startswith("| **\N{MINUS SIGN}21.00 dB**")
    assert text.splitlines()[6] == report.answer
    assert {f"figures/{name}.png" for name in ALL} == set(re.findall(r"\]\((figures/[a-z]+\.png)\)", text))
    page = _Page((folder / "report" / "report.html").read_text(encoding="utf-8"))
    assert len(page.addresses) == page.tags.count("img") == len(ALL)
    assert all(address.startswith("data:image/svg+xml;base64,") for address in page.addresses)
    assert not {"script", "link"} & set(page.tags)


@pytest.mark.usefixtures("undrawn")
def test_tables_on_disk_are_the_rows(make: Make, ladder: Ladder) -> None:
    """A row for each scene, combination and case, in dB beside the ratio; the answer is of the last one."""
    cells = ladder(9, 1.0, 2.0, points=2)
    cells[2][1][0], cells[8][0][2], cells[8][1][2] = "no room", (3.0, "best-found"), (3.0, "given")
    folder = make(cells, sweep=SWEEP)
    report = report_study(folder)
    tidy = pd.read_csv(folder / "report" / "study.csv")
    frame = read_study(folder).frame()
    assert len(tidy) == len(frame) == 9 * 2 * 3
    np.testing.assert_allclose(tidy["value_db"], 10.0 * np.log10(frame["value"]))
    np.testing.assert_allclose(report.summary.value.ravel(), tidy["value_db"])
    for column in ("status", "jammers.M.power_w"):
        assert list(tidy[column]) == list(frame[column])
    summary = pd.read_csv(folder / "report" / "summary.csv")
    pd.testing.assert_frame_equal(summary, report.summary.table(), check_dtype=False, rtol=1e-12)
    assert report.notes[0].startswith(
        "Of 54 rows: 51 certified, 1 best found, 1 given, 1 failed. Uncertified "
    )
    gain = report.summary.row(1, "omnidirectional")["gain_median"]
    assert f"an omnidirectional vehicle gains {gain:.2f}" in report.answer
    data = json.loads(json_text(report.to_dict()))
    assert {"study", "complete", "scenes_done", "answer", "notes", "summary", "files"} == set(data)
    assert data["summary"][2]["gain_median_db"] == pytest.approx(summary["gain_median_db"][2])
    assert data["summary"][2]["shift_worst_tenth_low_db"] is None


def test_the_same_each_time(make: Make, ladder: Ladder, tmp_path: Path) -> None:
    """Two reports of a study do not differ by a byte, wherever they go; the study is not touched."""
    folder = make(ladder(12, 1.0, 2.0))
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    for name in ("a", "b"):
        report_study(folder, out=tmp_path / name)
    files = [path.relative_to(tmp_path / "a") for path in (tmp_path / "a").rglob("*") if path.is_file()]
    assert len(files) == 4 + 3 * len(ALL)
    for name in files:
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes(), name
    assert {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()} == before


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize(
    ("cells", "given", "figures"),
    [
        ([[[1.0]]], {"cases": [{"name": "only"}]}, {"distribution"}),
        ([[[0.0, 1.0, 2.0]]], {}, set(ALL)),
        ([[["no room"] * 3]] * 2, {}, set()),
        ([[[-math.inf, -math.inf, -math.inf]]] * 3, {}, set(ALL)),
        ([], {"scenes": 5}, set()),
    ],
    ids=["one case", "one scene", "failures only", "no signal", "not begun"],
)
def test_studies_with_little_in_them(make: Make, cells: Any, given: Any, figures: set[str]) -> None:
    """A report is written of any study, with the figures that there is something for."""
    folder = make(cells, **given)
    report_study(folder)
    assert {path.stem for path in (folder / "report" / "figures").iterdir()} == figures
    text = (folder / "report" / "report.md").read_text(encoding="utf-8")
    assert not re.search(r"\bnan\b", text)


def test_no_text_of_a_study_is_markup(make: Make, ladder: Ladder) -> None:
    """A title and names with signs of Markdown, HTML and TeX stand in the report as they are."""
    cases = [{"name": "<b>|x|</b>"}, {"name": "$\\alpha$ [a](b)", "airframe": "tilt-10-horizontal"}]
    folder = make(ladder(40, 1.0), cases=cases, name="<script>alert(1)</script> & *x* {{ 1 }}")
    report_study(folder)
    text = (folder / "report" / "report.md").read_text(encoding="utf-8")
    assert text.startswith("# \\<script\\>alert(1)\\</script\\> & \\*x\\* {{ 1 }}\n")
    assert "| \\<b\\>\\|x\\|\\</b\\> |" in text
    page = (folder / "report" / "report.html").read_text(encoding="utf-8")
    assert "<title>&lt;script&gt;alert(1)&lt;/script&gt; &amp; *x* {{ 1 }}</title>" in page
    assert not {"script", "b", "a"} & set(_Page(page).tags)
    svg = (folder / "report" / "figures" / "gain.svg").read_text(encoding="utf-8")
    assert "<b>" not in svg


@pytest.mark.usefixtures("undrawn")
def test_a_study_that_is_not_finished_says_so_on_top(make: Make, ladder: Ladder) -> None:
    """Before anything else but the title."""
    folder = make(ladder(4, 1.0, 2.0), scenes=9)
    report_study(folder)
    lines = (folder / "report" / "report.md").read_text(encoding="utf-8").splitlines()
    assert lines[2].startswith("> **This study is not finished: 4 of 9 scenes")


@pytest.mark.usefixtures("undrawn")
def test_figures_that_are_no_more_there(make: Make, ladder: Ladder, tmp_path: Path) -> None:
    """What an earlier report drew and this one does not is taken away; other files stay."""
    out = tmp_path / "out"
    (out / "figures").mkdir(parents=True)
    for name in ("sweep.png", "mine.png"):
        (out / "figures" / name).write_bytes(b"old")
    report_study(make(ladder(4, 1.0, 2.0)), out=out)
    assert not (out / "figures" / "sweep.png").exists()
    assert (out / "figures" / "mine.png").read_bytes() == b"old"


@pytest.mark.usefixtures("undrawn")
def test_margins_are_required_to_be_met(make: Make, ladder: Ladder) -> None:
    """Of margins the requirement is 0 dB unless another is given, and they are called so."""
    nodes = {"layout": "disc", "count": 2, "centre_m": [0, 0], "radius_m": 50, "power_w": 1, "weight": 2}
    report = report_study(make(ladder(6, 2.5, 5.5), nodes=nodes))
    assert report.summary.requirement == 0.0
    assert "below 0 dB" in (report.files[0]).read_text(encoding="utf-8")


def test_a_requirement_in_the_wrong_unit(make: Make, ladder: Ladder) -> None:
    """It is refused before anything is written."""
    folder = make(ladder(2, 1.0, 2.0))
    with pytest.raises(UsageError, match="are in dB; give --requirement-db"):
        report_study(folder, requirement_bps_hz=1.0)
    with pytest.raises(UsageError, match=r"requirement: given nan"):
        report_study(folder, requirement_db=math.nan)
    with pytest.raises(UsageError, match=r"against: given 'x'"):
        report_study(folder, against="x")
    assert not (folder / "report").exists()


def test_solved_studies(undrawn: None, tmp_path: Path) -> None:
    """A robust case, and a study of secrecy, from the solver to the report."""
    space = {"airspace": {"altitude_m": [8.0, 30.0]}, "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0}}
    disc = {"layout": "disc", "count": 1, "centre_m": [0.0, 25.0], "radius_m": 40.0}
    nodes = [{"position_m": [0.0, 0.0, 0.0], "power_w": 1.0}]
    robust = {
        "scenes": 2,
        "scene": {**space, "nodes": nodes},
        "jammers": {**disc, "name": "M", "power_w": 1.0, "uncertainty_m": 2.0},
        "cases": [{"name": "free", "gap": 1e-2}, {"name": "sure", "robust": True, "certify": False}],
    }
    secret = {
        "scenes": 3,
        "scene": {
            **space,
            "objective": "secrecy-rate",
            "transmitter": {"power_w": 1.0},
            "nodes": [{"position_m": [0.0, 0.0, 0.0]}],
        },
        "eavesdroppers": {**disc},
        "gap": 1e-1,
    }
    for name, tables in (("robust", robust), ("secret", secret)):
        run_study(StudySpec.from_dict(tables), tmp_path / name, workers=0, chunk=3)
    sure = report_study(tmp_path / "robust")
    assert any("2 best found" in note for note in sure.notes)
    rate = report_study(tmp_path / "secret", requirement_bps_hz=0.5)
    assert "bits/s/Hz" in rate.answer
    assert "value_db" not in pd.read_csv(tmp_path / "secret" / "report" / "study.csv").columns
    with pytest.raises(UsageError, match="are rates; give --requirement-bps-hz"):
        report_study(tmp_path / "secret", requirement_db=1.0)


def test_faults(make: Make, ladder: Ladder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """No study, a file in the way, a damaged part, an extra that is missing: each in one message."""
    with pytest.raises(UsageError, match="no study is here"):
        report_study(tmp_path / "nothing")
    folder = make(ladder(4, 1.0, 2.0))
    (tmp_path / "file").write_text("in the way", encoding="utf-8")
    with pytest.raises(OutputError, match="a file of that name is in the way"):
        report_study(folder, out=tmp_path / "file")
    (part,) = (folder / "parts").iterdir()
    part.write_bytes(part.read_bytes()[:-1])
    with pytest.raises(UsageError, match="damaged"):
        report_study(folder)
    assert not list((folder / "report").glob("*.csv"))
    monkeypatch.setattr(folder_module, "find_spec", lambda name: None if name == "pyarrow" else sys)
    with pytest.raises(
        UsageError, match=r"^a study needs pyarrow, not installed here; in a clone .*python.* -m pip install"
    ):
        report_study(folder)
