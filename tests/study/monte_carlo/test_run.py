"""What a run refuses, and what it keeps when it is ended."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from nullpose import OutputError, ScenarioError, UsageError
from nullpose.study.monte_carlo import StudyProgress, StudySpec, read_study, run_study, study_status
from nullpose.study.monte_carlo.run import MOST_IN_A_PART

Spec = Callable[..., StudySpec]


def test_another_study_in_the_folder_is_refused(quick: Spec, tmp_path: Path) -> None:
    """With the keys that differ; a title alone may change."""
    run_study(quick(), tmp_path, workers=0)
    with pytest.raises(UsageError, match=r"another study is here \(.*scenes, seed\).*--out"):
        run_study(quick(seed=4, scenes=13), tmp_path, workers=0)
    assert run_study(quick(name="a better title"), tmp_path, workers=0).complete


def test_another_version_in_the_folder_is_refused(quick: Spec, tmp_path: Path) -> None:
    """Two versions of nullpose do not write one study."""
    run_study(quick(), tmp_path, workers=0)
    path = tmp_path / "manifest.json"
    manifest = json.loads(path.read_text(encoding="utf-8"))
    manifest["versions"]["nullpose"] = "0.0.1"
    path.write_text(json.dumps(manifest), encoding="utf-8")
    with pytest.raises(UsageError, match=r"begun with nullpose 0\.0\.1"):
        run_study(quick(), tmp_path, workers=0)


def test_the_size_of_parts_is_kept(quick: Spec, tmp_path: Path) -> None:
    """A resumed study goes on in the parts that it was begun with, whatever is asked for."""

    def stop(at: StudyProgress) -> None:
        if at.done >= 8:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_study(quick(), tmp_path, workers=0, chunk=4, on_progress=stop)
    assert (study_status(tmp_path).done, study_status(tmp_path).complete) == (8, False)
    assert len(read_study(tmp_path).frame()) == 8
    found = run_study(quick(), tmp_path, workers=0, chunk=5)
    assert (found.parts, found.chunk, found.complete) == (3, 4, True)


def test_a_part_is_about_a_second(quick: Spec, tmp_path: Path) -> None:
    """Unless it is given the size of parts follows from what scenes take."""
    found = run_study(quick(scenes=30), tmp_path, workers=0)
    assert 1 <= found.chunk <= 30
    assert found.parts == -(-30 // found.chunk)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"workers": -1}, "workers: given -1; allowed: 0"),
        ({"workers": 2, "scheduler": "tcp://127.0.0.1:1"}, "leave out one of the two"),
        ({"chunk": 0}, f"chunk: given 0; allowed: 1 to {MOST_IN_A_PART}"),
        ({"chunk": MOST_IN_A_PART + 1}, "chunk: given"),
    ],
)
def test_bad_options(quick: Spec, tmp_path: Path, options: dict[str, Any], message: str) -> None:
    """They are refused before a folder is made."""
    with pytest.raises(UsageError, match=message):
        run_study(quick(), tmp_path / "out", **options)
    assert not (tmp_path / "out").exists()


def test_a_file_in_the_way(quick: Spec, tmp_path: Path) -> None:
    """A folder that cannot be made is refused at once."""
    (tmp_path / "out").write_text("", encoding="utf-8")
    with pytest.raises(OutputError, match="a file of that name is in the way"):
        run_study(quick(), tmp_path / "out", workers=0)


def test_parts_that_do_not_fit_together(quick: Spec, tmp_path: Path) -> None:
    """A spec built in Python is tried before the first scene, as one from a file."""
    with pytest.raises(ScenarioError, match=r"jammers\.N\.power_w"):
        run_study(quick(sweep={"jammers.N.power_w": [1.0]}), tmp_path / "out", workers=0)


def test_scenes_that_cannot_be_drawn_are_failures(quick: Spec, tmp_path: Path) -> None:
    """They are rows with a reason, and the others are solved; the count of failures is told."""
    study = quick(scenes=40, jammers__count=[0, 1], sweep={"jammers.*.power_w": [1.0, 2.0]})
    told: list[StudyProgress] = []
    bad = study.model_copy(update={"sweep": {"jammers[0].power_w": [1.0, 2.0]}})
    first_with = next(index for index in range(40) if _jammers(bad, index))
    assert first_with < 5
    found = run_study(bad, tmp_path, workers=0, on_progress=told.append)
    frame = read_study(tmp_path).frame()
    without = [index for index in range(40) if not _jammers(bad, index)]
    failed = frame[frame["status"] == "failed"]
    assert sorted(set(failed["scene"])) == without
    assert len(failed) == 2 * len(without) == found.failed == told[-1].failed
    assert failed["reason"].str.contains("jammers").all()
    assert failed[["value", "bound", "x_m"]].isna().all(axis=None)


def _jammers(spec: StudySpec, index: int) -> int:
    from nullpose.study.monte_carlo import draw_scene

    return len(draw_scene(spec, index).jammers)
