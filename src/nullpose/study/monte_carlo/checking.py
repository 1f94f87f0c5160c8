"""What is wrong between a spec's scenes, its swept values and its cases, tried on a scene that is drawn."""

from __future__ import annotations

from collections.abc import Mapping

from nullpose.errors import Fault, ScenarioError, UsageError
from nullpose.scenario import Scenario
from nullpose.scenario.faults import path_of
from nullpose.schemes import Scheme
from nullpose.study.monte_carlo.case import StudyCase
from nullpose.study.monte_carlo.draw import Draws
from nullpose.study.monte_carlo.spec import StudySpec

__all__ = ["require_sound"]

_TRIED_SCENES = 5  # one that cannot be drawn may be bad luck, so many cannot
_TRIED_VALUES = 50  # of each swept path, both ends among them


def require_sound(spec: StudySpec, source: str = "study") -> None:
    """Raise a ScenarioError with what is wrong between the parts of a spec, each of which is sound by itself.

    Args:
        spec: the study.
        source: what to call it in messages.

    Raises:
        ScenarioError: with every fault.
    """
    draws = Draws(spec)
    unsound = {index: _faults_at(draws, index, {}) for index in range(min(_TRIED_SCENES, spec.n_scenes))}
    sound = [index for index, found in unsound.items() if not found]
    if sound:
        faults = _sweep_faults(draws, spec, sound[0])
        faults = faults or _cases_faults(spec, [draws.at(sound[0], 0), draws.at(sound[0], -1)])
    else:
        faults = [Fault(f"scene 0: {each.path}", each.message) for each in unsound[0]]
    if faults:
        raise ScenarioError(faults, source)


def _faults_at(draws: Draws, index: int, values: Mapping[str, float]) -> tuple[Fault, ...]:
    try:
        draws.base(index, values)
    except ScenarioError as error:
        return error.faults
    return ()


def _sweep_faults(draws: Draws, spec: StudySpec, index: int) -> list[Fault]:
    """Return the faults that the values of each path lead to, each once."""
    told: dict[tuple[str, str], Fault] = {}
    for path, values in spec.sweep:
        step = max(1, len(values) // _TRIED_VALUES)
        for value in dict.fromkeys((*values[::step], values[-1])):
            for fault in _faults_at(draws, index, {path: value}):
                message = f"{fault.message} (at {value:g})"
                told.setdefault((path, fault.path), Fault(path_of(("sweep", path)), message))
    return list(told.values())


def _cases_faults(spec: StudySpec, scenes: list[Scenario]) -> list[Fault]:
    """Return why cases have no meaning in some scenes."""
    reasons = {
        place: next(filter(None, (_meaningless(case, scene) for scene in scenes)), "")
        for place, case in enumerate(spec.cases)
    }
    return [Fault(path_of(("cases", place)), reason) for place, reason in reasons.items() if reason]


def _meaningless(case: StudyCase, scene: Scenario) -> str:
    """Return why a case has no meaning in a scene; empty if it has."""
    try:
        vehicle = case.on(scene)
        if case.robust and not vehicle.is_uncertain:
            raise UsageError(
                "robust, but the scenes state no errors; add uncertainty_m to jammers or eavesdroppers, or "
                "receiver.attitude_error_deg or receiver.position_error_m to the scene"
            )
        if case.array is not None and vehicle.objective_record.transmits:
            raise UsageError("an array is for a drone that receives, not for this objective")
        if not (case.robust or case.array or case.pose):
            (case.scheme or Scheme.OPTIMUM).require_applicable(vehicle)
    except (ScenarioError, UsageError) as error:
        return str(error)
    return ""
