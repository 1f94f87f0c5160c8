"""A best mount is one mount for all scenes, and no other that was tried has a higher median."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nullpose import ScenarioError
from nullpose.physics import to_db
from nullpose.study.monte_carlo import StudySpec, read_study, run_study

Spec = Callable[..., StudySpec]

LEVEL = {"tilt_max_deg": 0.0, "mount_deg": "best"}
CASES = [{"name": "best", "airframe": LEVEL, "certify": False}]
POWERS = {"jammers.M.power_w": [1.0, 100.0]}


def _levels_db(out: Path) -> dict[str, float]:
    """The median of each case, averaged over the swept powers."""
    frame = read_study(out).frame()
    frame["value_db"] = to_db(frame["value"].to_numpy())
    medians = frame.groupby(["case", "point"], observed=True)["value_db"].median()
    return dict(medians.groupby("case", observed=True).mean())


def test_no_other_mount_is_better(spec: Spec, tmp_path: Path) -> None:
    """The number is chosen before the parts, is kept with the study, and is found again when it goes on."""
    study = spec(scenes=8, cases=CASES, sweep=POWERS)
    notes: list[str] = []
    run_study(
        study, tmp_path / "best", workers=0, chunk=8, on_progress=lambda progress: notes.append(progress.note)
    )
    case = read_study(tmp_path / "best").spec.cases[0]
    assert case.airframe is not None
    assert any("best" in note for note in notes)
    found_db = _levels_db(tmp_path / "best")
    sorted((tmp_path / "best" / "parts").iterdir())[-1].unlink()
    run_study(study, tmp_path / "best", workers=0)
    assert _levels_db(tmp_path / "best") == found_db
    others = sorted({*range(0, 91, 30), case.airframe.mount_deg - 1.0, case.airframe.mount_deg + 1.0})
    fixed = [
        {"name": str(mount), "airframe": {"tilt_max_deg": 0.0, "mount_deg": mount}, "certify": False}
        for mount in others
        if 0.0 <= mount <= 90.0
    ]
    run_study(spec(scenes=8, cases=fixed, sweep=POWERS), tmp_path / "fixed", workers=0)
    best_db = _levels_db(tmp_path / "best")["best"]
    assert best_db >= max(_levels_db(tmp_path / "fixed").values()) - 1e-9


def test_few_scenes_choose_for_all(spec: Spec, tmp_path: Path) -> None:
    """Scenes beyond the number that choose do not change the mount; a pose may have a best mount, too."""
    mounts = []
    for scenes in (4, 9):
        cases = [
            {"airframe": {"tilt_max_deg": 5.0, "mount_deg": "best"}, "mount_scenes": 4, "pose": "centroid"}
        ]
        out = tmp_path / str(scenes)
        run_study(spec(scenes=scenes, cases=cases), out, workers=0)
        (case,) = read_study(out).spec.cases
        assert case.airframe is not None
        mounts.append(case.airframe.mount_deg)
    assert mounts[0] == mounts[1]
    assert np.all(read_study(tmp_path / "9").frame()["status"] == "given")


@pytest.mark.parametrize(
    "case",
    [{"mount_scenes": 4}, {"airframe": {"tilt_max_deg": 5.0, "mount_deg": "bset"}}],
)
def test_a_mount_that_cannot_be_chosen(spec: Spec, case: dict[str, Any]) -> None:
    """There is no mount without a vehicle, and no other word for it."""
    with pytest.raises(ScenarioError, match="mount"):
        spec(cases=[case])
