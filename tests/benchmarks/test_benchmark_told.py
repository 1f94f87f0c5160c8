"""A page of which a part was measured earlier: that part stands, and says so."""

from pathlib import Path

from benchmarks.metric import EXACT, Direction, Metric
from benchmarks.report import write_report
from benchmarks.run import Run
from benchmarks.told import TOLD, Told, load_told, write_told
from benchmarks.workload import Section


def told(name: str, value: float, remark: str = "") -> Told:
    """Return what is told of a workload with one promise of at most 1."""
    metric = Metric(
        key=f"{name}.size",
        value=value,
        unit="1",
        direction=Direction.LOWER,
        tolerance=EXACT,
        about=f"size of {name}",
        limit=1.0,
    )
    section = Section(
        text=f"Text of {name}.",
        settings=((name, "as it comes"),),
        limitations=(f"{name} is small.",),
        headline=f"So much for {name}.",
    )
    machine = {"date (UTC)": "2026-01-02", "source": "commit abc"}
    return Told(title=name.title(), machine=machine, metrics=(metric,), section=section, remark=remark)


def test_record_comes_back(tmp_path: Path) -> None:
    """What is recorded is read as it was; workloads that did not run stay."""
    file = tmp_path / "told.json"
    write_told({"old": told("old", 0.5, "Much has changed.")}, file)
    write_told({"new": told("new", 2.0)}, file)
    assert load_told(file) == {"old": told("old", 0.5, "Much has changed."), "new": told("new", 2.0)}
    assert load_told(tmp_path / "none.json") == {}


def test_earlier_part_is_labelled(tmp_path: Path) -> None:
    """The page begins with what is missed, and names what was measured earlier wherever it stands."""
    run = Run(quick=False, machine={"processor": "of a test"}, rows={"new": []})
    earlier = {"old": told("old", 0.5, "Much has changed."), "new": told("new", 9.0)}
    page = write_report(run, {"new": told("new", 2.0)}, earlier, {}, tmp_path).read_text(encoding="utf-8")
    assert "**Of 2 promises 1 are met and 1 missed.**" in page
    assert "Missed:\n\n- size of new: 2, promised at most 1\n\nSo much for new." in page
    assert "Met:\n\n- size of old (measured earlier): 0.5, promised at most 1" in page
    assert "What was measured earlier says so: *Old*." in page
    assert "**Measured earlier and not again since: 2026-01-02, commit abc.** Much has changed." in page
    assert "| size of old (measured earlier) | 0.5 | at most 1 | yes |" in page
    assert "`old.size` (measured earlier)" in page
    assert page.count("Text of new.") == 1


def test_committed_record_can_be_read() -> None:
    """The record beside the baseline is of workloads that there are, each with its numbers."""
    assert all(part.metrics and part.section.text for part in load_told(TOLD).values())
