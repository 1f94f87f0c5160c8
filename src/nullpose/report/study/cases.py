"""The cases of a study as its report names them, and which of them is measured against which."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from nullpose.errors import UsageError
from nullpose.problem.schemes import Scheme
from nullpose.scenario import Airframe
from nullpose.study.airframe_cases import AIRFRAME_CASES, OMNIDIRECTIONAL, array_phrase, mounted_phrase
from nullpose.study.monte_carlo import StudyCase, StudySpec

LEVEL = AIRFRAME_CASES[0]  # what the others are measured against
_ANY = Airframe(tilt_max_deg=180.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportCase:
    """A case of a study as its report sees it; the places are those in the spec.

    Args:
        place: its own.
        name: as in the spec, for tables and figures.
        phrase: in a sentence, as in "a 10 degree tilt with a horizontal dipole".
        role: which of ``AIRFRAME_CASES`` its vehicle is; empty if none, or something else than its best pose.
        tilt_deg: how far its vehicle tilts; None where that is not known or it is not a vehicle's best pose.
        robust: whether its values are what is guaranteed under errors.
        reference: place of the case that it is measured against: a robust one only against robust ones.
        whole: place of the omnidirectional case among those that it is compared with; None if there is none.
        nominal: of a robust case, place of the one that differs only in trusting the scene; None without.
    """

    place: int
    name: str
    phrase: str
    role: str = ""
    tilt_deg: float | None = None
    robust: bool = False
    reference: int = 0
    whole: int | None = None
    nominal: int | None = None


def report_cases(spec: StudySpec, against: str | None = None) -> tuple[ReportCase, ...]:
    """Return the cases of a study in order, each with its own phrase.

    What others are measured against is the level vehicle with a vertical dipole; without one, the first that
    is level; without any, the first case.

    Args:
        spec: the study.
        against: name of another case to measure against.

    Raises:
        UsageError: there is no case of that name.
    """
    if against is not None and against not in spec.case_names:
        raise UsageError(f"against: given {against!r}; allowed: {', '.join(spec.case_names)}")
    own = _scenes_airframe(spec)
    cases = [_described(place, case, own) for place, case in enumerate(spec.cases)]
    times = Counter(case.phrase for case in cases)
    told = []
    for case in cases:
        group = [other for other in cases if other.robust is case.robust]
        reference = max(
            group, key=lambda case: (case.name == against, case.role == LEVEL.name, case.tilt_deg == 0.0)
        )  # the first of equals
        told.append(
            replace(
                case,
                phrase=f"{case.phrase} ({case.name})" if times[case.phrase] > 1 else case.phrase,
                reference=reference.place,
                whole=next((other.place for other in group if other.role == OMNIDIRECTIONAL), None),
                nominal=_nominal(spec, case, cases),
            )
        )
    return tuple(told)


def _nominal(spec: StudySpec, case: ReportCase, cases: Sequence[ReportCase]) -> int | None:
    """Return the place of the best pose of a robust case's vehicle if everything is as stated."""
    airframe = spec.cases[case.place].airframe
    places = (
        other.place
        for other in cases
        if not other.robust
        and spec.cases[other.place].is_best_pose
        and spec.cases[other.place].airframe == airframe
    )
    return next(places, None) if case.robust else None


def _scenes_airframe(spec: StudySpec) -> Airframe | None:
    """Return the vehicle of all scenes; None if they differ, or if it is swept."""
    if any(path.split(".", 1)[0] in ("airframe", "scene") for path in spec.swept):
        return None
    scenes = spec.scene.scenarios or (spec.scene,)
    airframes = {scene.airframe or _ANY for scene in scenes}
    known = len(airframes) == 1 and all(scene.array is None for scene in scenes)
    return airframes.pop() if known else None


def _described(place: int, case: StudyCase, own: Airframe | None) -> ReportCase:
    airframe = own if case.airframe is None else case.airframe
    plain = ReportCase(place=place, name=case.name, phrase=f"the case {case.name}", robust=bool(case.robust))
    if case.pose is not None:
        return replace(plain, phrase=f"the given pose {case.name}")
    if case.array is not None:
        return replace(plain, phrase=array_phrase(case.array.elements))
    if case.scheme is Scheme.VERTICAL:
        return replace(plain, phrase=LEVEL.phrase, role=LEVEL.name, tilt_deg=0.0)
    if case.scheme not in (None, Scheme.OPTIMUM):
        return replace(plain, phrase=f"the {case.scheme.label.lower()} pose")
    if airframe is None:
        return plain
    same = (each for each in AIRFRAME_CASES if each.airframe.axis_band == airframe.axis_band)
    usual = next(same, None)  # two vehicles that reach the same axes are one
    phrase = mounted_phrase(airframe) if usual is None else usual.phrase
    chosen = f" (the best mount tried, on up to {case.mount_scenes} scenes)" if case.mount_scenes else ""
    return replace(
        plain,
        phrase=f"{phrase}{chosen} in its robust pose" if case.robust else f"{phrase}{chosen}",
        role="" if usual is None else usual.name,
        tilt_deg=round(math.degrees(airframe.tilt_max_rad), 9),
    )
