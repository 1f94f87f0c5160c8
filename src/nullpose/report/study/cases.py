"""The cases of a study as its report names them, and the case that each is compared with."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from nullpose.errors import UsageError
from nullpose.problem.schemes import Scheme
from nullpose.report.numbers import unit_of
from nullpose.scenario import Airframe
from nullpose.study.case import AIRFRAME_CASES, OMNIDIRECTIONAL, array_phrase, mounted_phrase
from nullpose.study.monte_carlo import StudyCase, StudySpec

LEVEL = AIRFRAME_CASES[0]  # the others are compared with it
MOST_SHOWN = 6  # combinations that have a panel and rows; the tables on disk have all

_ANY = Airframe(tilt_max_deg=180.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportCase:
    """A case of a study in its report; the places are those in the spec.

    Args:
        place: of the case.
        name: as in the spec, for tables and figures.
        phrase: in a sentence, as in "a 10 degree tilt with a horizontal dipole".
        role: name of its vehicle among ``AIRFRAME_CASES``; empty if it is none, or not its best pose.
        is_level: whether it is the best pose of a vehicle that does not tilt.
        robust: whether its values are guaranteed under errors.
        reference: place of the case that it is compared with: a robust one only with robust ones.
        whole: place of the omnidirectional case among those that it is compared with; None without one.
    """

    place: int
    name: str
    phrase: str
    role: str = ""
    is_level: bool = False
    robust: bool = False
    reference: int = 0
    whole: int | None = None


def report_cases(spec: StudySpec, against: str | None = None) -> tuple[ReportCase, ...]:
    """Name the cases of a study, in order.

    The reference is the level vehicle with a vertical dipole; without one, the first that is level; without
    any, the first case.

    Args:
        spec: the study.
        against: name of another reference.

    Raises:
        UsageError: there is no case of that name.
    """
    if against is not None and against not in spec.case_names:
        raise UsageError(f"against: given {against!r}; allowed: {', '.join(spec.case_names)}")
    scenes_airframe = _scenes_airframe(spec)
    cases = [_described(place, case, scenes_airframe) for place, case in enumerate(spec.cases)]
    times = Counter(case.phrase for case in cases)
    return tuple(
        replace(
            _compared(case, [other for other in cases if other.robust is case.robust], against),
            phrase=f"{case.phrase} ({case.name})" if times[case.phrase] > 1 else case.phrase,
        )
        for case in cases
    )


def _compared(case: ReportCase, group: Sequence[ReportCase], against: str | None) -> ReportCase:
    """Choose the reference and the omnidirectional case among those of a group; the first of equals."""
    reference = max(
        group, key=lambda other: (other.name == against, other.role == LEVEL.name, other.is_level)
    )
    whole = next((other.place for other in group if other.role == OMNIDIRECTIONAL), None)
    return replace(case, reference=reference.place, whole=whole)


def _scenes_airframe(spec: StudySpec) -> Airframe | None:
    """Read the vehicle of all scenes; None if they differ, or if it is swept."""
    if any(path.split(".", 1)[0] in ("airframe", "scene") for path in spec.swept):
        return None
    scenes = spec.scene.scenarios or (spec.scene,)
    airframes = {scene.airframe or _ANY for scene in scenes}
    is_same = len(airframes) == 1 and all(scene.array is None for scene in scenes)
    return airframes.pop() if is_same else None


def _described(place: int, case: StudyCase, scenes_airframe: Airframe | None) -> ReportCase:
    airframe = scenes_airframe if case.airframe is None else case.airframe
    plain = ReportCase(place=place, name=case.name, phrase=f"the case {case.name}", robust=bool(case.robust))
    if case.pose is not None:
        return replace(plain, phrase=f"the given pose {case.name}")
    if case.array is not None:
        return replace(plain, phrase=array_phrase(case.array.elements))
    if case.scheme is Scheme.VERTICAL:
        return replace(plain, phrase=LEVEL.phrase, role=LEVEL.name, is_level=True)
    if case.scheme not in (None, Scheme.OPTIMUM):
        return replace(plain, phrase=f"the {case.scheme.label.lower()} pose")
    if airframe is None:
        return plain
    same = (usual for usual in AIRFRAME_CASES if usual.airframe_or_any.axis_band == airframe.axis_band)
    usual = next(same, None)  # two vehicles that reach the same axes are one
    phrase = mounted_phrase(airframe) if usual is None else usual.phrase
    chosen = f" (the best mount tried, on up to {case.mount_scenes} scenes)" if case.mount_scenes else ""
    return replace(
        plain,
        phrase=f"{phrase}{chosen}{' in its robust pose' if case.robust else ''}",
        role="" if usual is None else usual.name,
        is_level=airframe.tilt_max_rad == 0.0,
    )


def shown_points(spec: StudySpec) -> list[int]:
    """Choose the combinations of swept values that are shown: all, or a few from the first to the last."""
    last = len(spec.points) - 1
    steps = min(last, MOST_SHOWN - 1)
    return sorted({round(step * last / max(1, steps)) for step in range(steps + 1)})


def point_words(spec: StudySpec, point: int) -> str:
    """Write a combination of swept values, as in "jammers.M.power_w = 100 W"; empty if nothing is swept."""
    values = spec.points[point].items()
    return ", ".join(f"{path} = {value:.6g} {unit_of(path)}".rstrip() for path, value in values)
