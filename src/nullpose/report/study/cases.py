"""The cases of a study as its report names them, and which of them is measured against which."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from nullpose.errors import UsageError
from nullpose.scenario import Airframe
from nullpose.schemes import Scheme
from nullpose.study import AIRFRAME_CASES
from nullpose.study.airframe_cases import OMNIDIRECTIONAL
from nullpose.study.monte_carlo import StudyCase, StudySpec

__all__ = ["ReportCase", "nominal_of", "reference_of", "report_cases", "whole_of"]

_ANY = Airframe(tilt_max_deg=180.0)
_LEVEL = AIRFRAME_CASES[0]


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportCase:
    """A case of a study as its report sees it.

    Args:
        place: its place in the spec.
        name: as in the spec, for tables and figures.
        phrase: in a sentence, as in "a 10 degree tilt with a horizontal dipole".
        role: which of ``AIRFRAME_CASES`` its vehicle is; empty if none, or something else than its best pose.
        tilt_deg: how far its vehicle tilts; None where that is not known or it is not a vehicle's best pose.
        robust: whether its values are what is guaranteed under errors.
    """

    place: int
    name: str
    phrase: str
    role: str = ""
    tilt_deg: float | None = None
    robust: bool = False


def report_cases(spec: StudySpec) -> tuple[ReportCase, ...]:
    """Return the cases of a study in order, each with its own phrase.

    Args:
        spec: the study.
    """
    own = _scenes_airframe(spec)
    cases = [_case(place, case, own) for place, case in enumerate(spec.cases)]
    times = Counter(case.phrase for case in cases)
    return tuple(
        replace(case, phrase=f"{case.phrase} ({case.name})") if times[case.phrase] > 1 else case
        for case in cases
    )


def reference_of(
    cases: Sequence[ReportCase], *, robust: bool = False, against: str | None = None
) -> ReportCase | None:
    """Return the case that the others are measured against, among what is guaranteed or what is nominal.

    That is the level vehicle with a vertical dipole; without one, another level vehicle, the one that tilts
    least first in the spec; without any, the first case.

    Args:
        cases: of the study.
        robust: among robust cases, or among the others: the two are never set against each other.
        against: name of another case to measure against.

    Raises:
        UsageError: there is no case of that name.
    """
    if against is not None and against not in [case.name for case in cases]:
        raise UsageError(f"against: given {against!r}; allowed: {', '.join(case.name for case in cases)}")
    group = [case for case in cases if case.robust is robust]
    return max(
        group,
        key=lambda case: (case.name == against, case.role == _LEVEL.name, case.tilt_deg == 0.0),
        default=None,
    )  # the first of equals


def whole_of(cases: Sequence[ReportCase], *, robust: bool = False) -> ReportCase | None:
    """Return the omnidirectional case, if there is one.

    Args:
        cases: of the study.
        robust: among robust cases, or among the others.
    """
    return next((case for case in cases if case.role == OMNIDIRECTIONAL and case.robust is robust), None)


def nominal_of(spec: StudySpec, cases: Sequence[ReportCase], case: ReportCase) -> ReportCase | None:
    """Return the case that differs from a robust one only in trusting the scene as stated, if there is one.

    Args:
        spec: the study.
        cases: of the study.
        case: one of them.
    """

    def is_nominal(other: ReportCase) -> bool:
        stated = spec.cases[other.place]
        plain = stated.pose is None and stated.array is None and stated.scheme in (None, Scheme.OPTIMUM)
        return plain and not other.robust and stated.airframe == spec.cases[case.place].airframe

    return next(filter(is_nominal, cases), None) if case.robust else None


def _scenes_airframe(spec: StudySpec) -> Airframe | None:
    """Return the vehicle of all scenes; None if they differ, or if it is swept."""
    if any(path.split(".", 1)[0] in ("airframe", "scene") for path in spec.swept):
        return None
    found = [spec.scene.tables(index) for index in range(spec.scene.size)]
    if any("array" in tables for tables in found):
        return None
    airframes = [tables.get("airframe") for tables in found]
    if any(airframe != airframes[0] for airframe in airframes):
        return None
    return _ANY if airframes[0] is None else Airframe.from_dict(dict(airframes[0]))


def _case(place: int, case: StudyCase, own: Airframe | None) -> ReportCase:
    plain = ReportCase(place=place, name=case.name, phrase=f"the case {case.name}")
    if case.pose is not None:
        return replace(plain, phrase=f"the fixed pose {case.name}")
    if case.array is not None:
        how = "digital combining" if case.array.combining == "digital" else "one analogue beam"
        return replace(
            plain, phrase=f"a level vehicle with an array of {case.array.elements} with {how}", tilt_deg=None
        )
    airframe = own if case.airframe is None else case.airframe
    if case.scheme is Scheme.VERTICAL:
        return replace(plain, phrase=_LEVEL.phrase, role=_LEVEL.name, tilt_deg=0.0)
    if case.scheme not in (None, Scheme.OPTIMUM):
        return replace(plain, phrase=f"the {Scheme(case.scheme).label.lower()} pose")
    if airframe is None:
        return replace(plain, robust=bool(case.robust))
    role, phrase = _vehicle(airframe)
    return replace(
        plain,
        phrase=f"{phrase} in its robust pose" if case.robust else phrase,
        role=role,
        tilt_deg=round(math.degrees(airframe.tilt_max_rad), 9),
        robust=bool(case.robust),
    )


def _vehicle(airframe: Airframe) -> tuple[str, str]:
    """Return role and phrase of a vehicle: two that reach the same axes are the same."""
    for each in AIRFRAME_CASES:
        if each.airframe.axis_band == airframe.axis_band:
            return each.name, each.phrase
    tilt, mount = (
        f"{round(math.degrees(angle), 6):g}" for angle in (airframe.tilt_max_rad, airframe.mount_rad)
    )
    return "", f"a {tilt} degree tilt with the dipole mounted at {mount} degrees"
