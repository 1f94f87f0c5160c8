"""What is wrong between a spec's scenes, its swept values and its cases, tried on a scene that is drawn."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from nullpose.errors import Fault, ScenarioError, UsageError
from nullpose.scenario import Scenario
from nullpose.scenario.faults import path_of
from nullpose.schemes import Scheme
from nullpose.study.monte_carlo.case import StudyCase
from nullpose.study.monte_carlo.draw import Draws, draw_scene
from nullpose.study.monte_carlo.spec import StudySpec

__all__ = ["require_sound", "spec_faults"]

_TRIED_SCENES = 5  # one that cannot be drawn may be bad luck, so many cannot
_TRIED_VALUES = 50  # of each swept path, both ends among them


def require_sound(spec: StudySpec) -> None:
    """Raise a ScenarioError with what is wrong between the parts of a spec, if anything is.

    Args:
        spec: the study.

    Raises:
        ScenarioError: with every fault.
    """
    faults = spec_faults(spec)
    if faults:
        raise ScenarioError(faults, "study")


def spec_faults(spec: StudySpec) -> list[Fault]:
    """Return what is wrong between the parts of a spec, each of which is sound by itself.

    Args:
        spec: the study.
    """
    index, faults = _drawable(spec)
    if faults:
        return faults
    found = [fault for path, values in spec.sweep for fault in _sweep_faults(spec, index, path, values)]
    if found:
        return found
    ends = [_at(spec, index, point) for point in {0, len(spec.points) - 1}]
    return [
        Fault(path_of(("cases", place)), message)
        for place, case in enumerate(spec.cases)
        for message in _case_faults(case, ends)
    ]


def _drawable(spec: StudySpec) -> tuple[int, list[Fault]]:
    """Return a scene that can be drawn, or why the first cannot."""
    faults: list[Fault] = []
    for index in range(min(_TRIED_SCENES, spec.n_scenes)):
        try:
            draw_scene(spec, index)
        except ScenarioError as error:
            faults = faults or [Fault(f"scene {index}: {each.path}", each.message) for each in error.faults]
        else:
            return index, []
    return 0, faults


def _sweep_faults(spec: StudySpec, index: int, path: str, values: tuple[float, ...]) -> Iterator[Fault]:
    """Yield the faults that the values of one path lead to, each once."""
    told: set[str] = set()
    step = max(1, len(values) // _TRIED_VALUES)
    for value in (*values[::step], values[-1]):
        one = spec.model_copy(update={"sweep": ((path, (value,)),)})
        for fault in _faults_of(lambda one=one: _at(one, index, 0)):  # type: ignore[misc]
            if fault.path not in told:
                told.add(fault.path)
                yield Fault(path_of(("sweep", path)), f"{fault.message} (at {value:g})")


def _faults_of(attempt: Callable[[], object]) -> tuple[Fault, ...]:
    try:
        attempt()
    except ScenarioError as error:
        return error.faults
    return ()


def _at(spec: StudySpec, index: int, point: int) -> Scenario:
    return Draws(spec).at(index, point)


def _case_faults(case: StudyCase, ends: list[Scenario]) -> Iterator[str]:
    """Yield why a case has no meaning in the scenes at the ends of the sweep."""
    for scene in ends:
        try:
            reason = _meaningless(case, case.on(scene))
        except (ScenarioError, UsageError) as error:
            reason = str(error)
        if reason:
            yield reason
            return


def _meaningless(case: StudyCase, scene: Scenario) -> str:
    if case.robust:
        if not scene.is_uncertain:
            return (
                "robust, but the scenes state no errors; add uncertainty_m to jammers or eavesdroppers, or "
                "receiver.attitude_error_deg or receiver.position_error_m to the scene"
            )
        return ""
    if case.array is not None:
        return "" if scene.objective == "min-sinr" else "an array is for hearing nodes (min-sinr) only"
    scheme = case.scheme or Scheme.OPTIMUM
    reason = None if case.pose is not None else scheme.not_applicable(scene)
    return f"scheme {scheme.value}: {reason}; try another scheme" if reason else ""
