"""The cases of a study as its report names them, and the case that each is compared with."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nullpose.errors import require_usage
from nullpose.report.numbers import unit_of
from nullpose.scenario import Airframe
from nullpose.study.case import LEVEL, OMNIDIRECTIONAL
from nullpose.study.monte_carlo import StudySpec

if TYPE_CHECKING:
    import pandas as pd

MOST_SHOWN = 6  # combinations that have a panel and rows; the tables on disk have all

_ANY = Airframe(tilt_max_deg=180.0)


def report_cases(spec: StudySpec, against: str | None = None) -> pd.DataFrame:
    """Describe the cases of a study, by name.

    The columns are ``phrase`` (in a sentence), ``usual`` (the name of its vehicle among ``AIRFRAME_CASES``),
    ``robust``, ``against`` (the case that it is compared with) and ``whole`` (the omnidirectional one); empty
    where there is none. Cases are compared with the level vehicle that has a vertical dipole; without one,
    with the first that is level; without any, with the first; robust ones among themselves.

    Args:
        spec: the study.
        against: name of another case to compare with.

    Raises:
        UsageError: there is no case of that name.
    """
    import pandas as pd

    require_usage(
        against in (None, *spec.case_names),
        f"against: given {against!r}; allowed: {', '.join(spec.case_names)}",
    )
    scenes_airframe = _scenes_airframe(spec)
    placed = {  # a case that states no vehicle has that of the scenes
        case.name: case
        if case.airframe or case.array
        else case.model_copy(update={"airframe": scenes_airframe})
        for case in spec.cases
    }
    cases = pd.DataFrame(
        {
            "phrase": {name: case.phrase for name, case in placed.items()},
            "usual": {name: case.usual for name, case in placed.items()},
            "robust": {name: bool(case.robust) for name, case in placed.items()},
        }
    )
    twice = cases["phrase"].duplicated(keep=False)
    cases.loc[twice, "phrase"] += " (" + cases.index[twice] + ")"
    for _, group in cases.groupby("robust"):
        members = [placed[name] for name in group.index]
        first = max(members, key=lambda case: (case.name == against, case.usual == LEVEL, case.is_level))
        cases.loc[group.index, ["against", "whole"]] = (
            first.name,
            next((case.name for case in members if case.usual == OMNIDIRECTIONAL), ""),
        )
    return cases


def _scenes_airframe(spec: StudySpec) -> Airframe | None:
    """Read the vehicle of all scenes; None if they differ, or if it is swept."""
    if any(path.split(".", 1)[0] in ("airframe", "scene") for path in spec.swept):
        return None
    scenes = spec.scene.scenarios or (spec.scene,)
    airframes = {scene.airframe or _ANY for scene in scenes}
    return airframes.pop() if len(airframes) == 1 and all(scene.array is None for scene in scenes) else None


def shown_points(spec: StudySpec) -> list[int]:
    """Choose the combinations of swept values that are shown: all, or a few from the first to the last."""
    last = len(spec.points) - 1
    steps = min(last, MOST_SHOWN - 1)
    return sorted({round(step * last / max(1, steps)) for step in range(steps + 1)})


def point_words(spec: StudySpec, point: int) -> str:
    """Write a combination of swept values, as in "jammers.M.power_w = 100 W"; empty if nothing is swept."""
    return ", ".join(
        f"{path} = {value:.6g} {unit_of(path)}".rstrip() for path, value in spec.points[point].items()
    )
